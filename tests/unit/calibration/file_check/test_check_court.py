"""The step that checks a calibration file by painted lines: from files to files."""

import json
import runpy
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd

from courtside.geometry import camera as cameras
from courtside.records.cameras import click_proposals
from fixtures.cameras.court_cameras import COURT, right_cameras, views

ROOT = Path(__file__).parents[4]
COURT_YAML = ROOT / "config" / "courts" / "badminton.yaml"

CROP = (60, 40, 1700, 1000)


def checked(tmp_path, file, shown, seen):
    """Return what the step says of cameras of a file whose videos show so many points."""
    paths = SimpleNamespace(
        calibration_path=tmp_path / "file.toml",
        cameras_toml=tmp_path / "cameras.toml",
        court_yaml=COURT_YAML,
        proposals_csv=tmp_path / "proposals.csv",
    )
    cameras.write_toml(paths.calibration_path, file, source="test")
    cameras.write_toml(paths.cameras_toml, shown, source="test")
    n = len(COURT.points)
    reasons = tuple(click_proposals.EITHER for _ in range(n))
    proposed = {
        camera.name: SimpleNamespace(
            xy=view, sigma_px=np.full(n, 0.5), confidence=np.ones(n), reason=reasons
        )
        for camera, view in zip(shown, seen, strict=True)
    }
    click_proposals.write(paths.proposals_csv, proposed, COURT.points)
    script = runpy.run_path(str(ROOT / "workflow" / "scripts" / "check_court.py"))
    told, table = tmp_path / "court.json", tmp_path / "court.csv"
    names = {camera.name: camera.name for camera in shown}
    script["main"](paths, told, table, names=names, override={})
    return json.loads(told.read_text()), pd.read_csv(table)


def test_a_turned_camera_of_a_file_is_named_though_its_video_is_cropped(tmp_path):
    true = right_cameras()
    file = [true[0], cameras.turned(true[1], (0, 0, 0.027)), *true[2:]]
    shown = [cameras.crop(file[0], CROP), *file[1:]]
    seen = views(true)
    seen[0] -= CROP[:2]
    told, table = checked(tmp_path, file, shown, seen)
    assert [fault["what"] for fault in told["faults"]] == [
        "the direction or principal point of camera c1 is wrong"
    ]
    assert list(told["cameras"]) == ["c1"] and len(told["warnings"]) == 1
    assert told["warnings"][0] == f"camera c1 of the file {told['cameras']['c1']}"
    assert told["n_agreeing"] == 3
    assert table.camera.tolist() == ["c0", "c1", "c2", "c3"]
    assert table.off_px.idxmax() == 1


def test_without_a_court_in_two_pictures_nothing_is_said(tmp_path):
    true = right_cameras()
    seen = views(true)
    seen[1:] = np.nan
    told, table = checked(tmp_path, true, true, seen)
    assert told == {"warnings": [], "cameras": {}, "shared": [], "faults": [], "n_agreeing": 0}
    assert table.empty
