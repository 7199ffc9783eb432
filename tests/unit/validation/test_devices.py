"""Recordings of devices that cannot be imported are told before any job."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from courtside.study.configuration.sessions import Device, Take
from courtside.validation import devices
from courtside.validation.remembered import Remembered
from fixtures.recordings.depth_recordings_made import frames, write_bag
from fixtures.recordings.real_data import REAL, needs_real

MOCOPI = REAL / "mocopi"
MALFORMED = sorted((MOCOPI / "malformed").glob("*.bvh"))


def said(path, kind="inertial", remembered=None, **options):
    take = Take("jump", {}, ("p1",), devices={"d": Device(kind, str(path), "p1", **options)})
    looks = remembered or Remembered(Path(path).parent / "looks.json")
    return [*devices.faults(take, looks, lambda name: Path("config/skeletons") / f"{name}.yaml")]


@needs_real
@pytest.mark.parametrize("bad", MALFORMED, ids=lambda path: path.stem)
def test_malformed_files_of_suits_are_told(tmp_path, bad):
    (line,) = said(shutil.copy(bad, tmp_path / bad.name))
    assert line.startswith(f"{tmp_path / bad.name}: ")
    assert "expected" in line
    assert "found" in line


@needs_real
def test_real_files_of_suits_are_good(tmp_path):
    for name in ("jump", "mocopi-mobile-arm-raise-turn"):
        assert said(shutil.copy(MOCOPI / f"{name}.bvh", tmp_path)) == []


@needs_real
def test_a_suit_s_file_without_a_frame_is_told(tmp_path):
    head, _, _ = (MOCOPI / "jump.bvh").read_text(encoding="utf-8").partition("Frames:")
    path = tmp_path / "zero.bvh"
    path.write_text(f"{head}Frames: 0\nFrame Time: 0.016667\n", encoding="utf-8")
    (line,) = said(path)
    assert "zero.bvh: expected 2 frames of motion or more" in line
    assert "found 0; record again" in line


def test_depth_recordings_are_opened(tmp_path):
    bag = write_bag(tmp_path / "a.bag")
    assert said(bag, "rgbd") == []
    bag.write_bytes(bag.read_bytes()[:200])
    (line,) = said(bag, "rgbd")
    assert line.startswith(f"{bag}: expected")


def test_depth_in_another_unit_is_told(tmp_path):
    in_metres = [(t, colour, np.full_like(depth, 4)) for t, colour, depth in frames()]
    (line,) = said(write_bag(tmp_path / "m.bag", in_metres), "rgbd")
    assert "m.bag: expected depths of 0.1 to 50 m, found a median of 0.001 m" in line


def test_a_file_of_nuitrack_is_read_in_its_unit(tmp_path):
    joints = {
        name: {"real": [100.0 * k, 300.0 * k, 2000.0], "confidence": 1}
        for k, name in enumerate(("waist", "torso", "neck", "head"))
    }
    rows = [{"timestamp": 33_333 * k, "skeletons": [{"user_id": 1, **joints}]} for k in range(5)]
    path = tmp_path / "n.json"
    path.write_text(json.dumps(rows), encoding="utf-8")
    assert said(path, "nuitrack") == []
    (line,) = said(path, "nuitrack", unit="m")
    assert "likely in mm" in line


def test_unchanged_files_are_read_once(tmp_path, monkeypatch):
    bag, kept = write_bag(tmp_path / "a.bag"), tmp_path / "looks.json"
    first = Remembered(kept)
    assert said(bag, "rgbd", first) == []
    first.save()
    monkeypatch.setattr(devices, "_read", lambda *args: pytest.fail("read again"))
    assert said(bag, "rgbd", Remembered(kept)) == []


def test_what_is_not_there_or_a_video_is_left_to_others(tmp_path):
    assert said(tmp_path / "none.bvh") == []
    (tmp_path / "a.mp4").write_bytes(b"no video")
    assert said(tmp_path / "a.mp4", "rgb") == []
