"""What is said against cameras: by their calibration, and by the checks of its file."""

import json
import runpy
from pathlib import Path
from types import SimpleNamespace

import pytest

from courtside.calibration.file_check import faults
from courtside.geometry import camera as cameras
from courtside.quality import calibration_doubts
from courtside.records.cameras import clicks
from fixtures.cameras import corner_cameras as hall

SCRIPT = Path(__file__).parents[3] / "workflow" / "scripts" / "check_cameras.py"
TRUE = hall.four_cameras()
MIRRORED = "the principal point of camera c1 is mirrored in x"


def checked(folder, in_file):
    """Write the check of a file by points at rest, as the study does; return its path."""
    cameras.write_toml(folder / "cameras.toml", in_file, source="test")
    names = {camera.name: camera.name for camera in TRUE}
    seen = dict(zip(names, hall.seen_points(TRUE, 8, 0.5, seed=2), strict=True))
    clicks.write(folder / "static.csv", seen, [f"bolt{at}" for at in range(8)])
    paths = SimpleNamespace(
        calibration_path=folder / "cameras.toml",
        cameras_toml=folder / "cameras.toml",
        static_csv=folder / "static.csv",
    )
    main, written = runpy.run_path(str(SCRIPT))["main"], folder / "check.json"
    main(paths, written, folder / "check.csv", names=names, override={}, takes=[])
    return written


@pytest.fixture
def quality(tmp_path):
    (tmp_path / "quality.json").write_text(json.dumps({"source": "cameras.toml"}))
    return tmp_path / "quality.json"


def test_a_fault_that_the_check_of_a_file_names_is_of_its_camera(tmp_path, quality):
    wrong = [TRUE[0], faults.mirrored_point(TRUE[1], 0), *TRUE[2:]]
    found = calibration_doubts.read(quality, checked(tmp_path, wrong))
    assert found == calibration_doubts.Doubts(by_check={"c1": MIRRORED})
    assert found.of("c1") == f"by the check of the calibration file {MIRRORED}"
    assert found.of("c0") == ""


def test_a_fault_that_no_camera_is_named_for_is_of_all(tmp_path, quality):
    turns = [(0.02, 0, 0), (0, 0.03, 0), (0, -0.02, 0.01), (-0.02, 0.02, 0)]
    wrong = [cameras.turned(one, turn) for one, turn in zip(TRUE, turns, strict=True)]
    found = calibration_doubts.read(quality, checked(tmp_path, wrong))
    (line,) = found.shared
    assert not found.by_check and "no single fault of it explains this" in line


def test_nothing_is_said_of_a_good_file(tmp_path, quality):
    assert calibration_doubts.read(quality, checked(tmp_path, TRUE)) == calibration_doubts.Doubts()


def test_both_cameras_that_are_exchanged_and_all_faults_of_one_are_told(tmp_path, quality):
    both = {"what": "cameras c0 and c1 are exchanged", "cameras": ["c0", "c1"]}
    one = {"what": MIRRORED, "cameras": ["c1"]}
    check = tmp_path / "check.json"
    check.write_text(json.dumps({"warnings": ["x"], "faults": [both, one]}))
    found = calibration_doubts.read(quality, check)
    assert found.by_check == {"c0": both["what"], "c1": f"{both['what']} and {MIRRORED}"}
    assert found.shared == ()


def test_painted_lines_and_the_calibration_itself_are_heard(tmp_path):
    quality, court = tmp_path / "quality.json", tmp_path / "court.json"
    quality.write_text(json.dumps({"warnings": ["floor: it tilts"], "remarks": ["one person"]}))
    court.write_text(json.dumps({"warnings": [], "cameras": {"c1": "sees"}, "shared": ["frame"]}))
    found = calibration_doubts.read(quality, court_json=court)
    assert found.shared == ("floor: it tilts", "frame") and found.of("c1") == "it sees"
    both = calibration_doubts.Doubts({"c1": "sees"}, {"c1": "it is odd"})
    assert both.of("c1") == "it sees, and by the check of the calibration file it is odd"


def test_a_world_that_is_not_upright_is_said_beside_a_fault_of_a_camera(tmp_path, quality):
    content = {"warnings": ["fault", "not upright"], "shared": ["not upright"], "faults": []}
    check = tmp_path / "check.json"
    check.write_text(json.dumps(content))
    assert calibration_doubts.read(quality, check).shared == ("fault", "not upright")
    content["faults"] = [{"what": MIRRORED, "cameras": ["c1"]}]
    check.write_text(json.dumps(content))
    assert calibration_doubts.read(quality, check) == calibration_doubts.Doubts(
        by_check={"c1": MIRRORED}, shared=("not upright",)
    )
