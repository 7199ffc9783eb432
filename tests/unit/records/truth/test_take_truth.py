"""The truth of a take: written and read again, and what may not be written."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.records.truth import take_truth
from courtside.study.errors import InputError

RNG = np.random.default_rng(0)
TRUTH = take_truth.TakeTruth(
    time_s=np.arange(5) / 30,
    joints=np.array(["left_wrist", "rig_pelvis"]),
    person_id=np.array(["p1", "p2"]),
    xyz=RNG.normal(size=(2, 5, 2, 3)),
    racket=np.where(RNG.random((2, 5, 2, 3)) < 0.5, np.nan, 1.0),
    offset_s={"back": 0.0, "side": 0.413},
    drift_ppm={"back": 0.0, "side": -35.0},
    events={"p1": {"hit": 1.25, "hit_stop": 1.5}, "p2": {}},
    shaken={"side": RNG.normal(size=(7, 3, 4))},
    devices={
        "d415": take_truth.DeviceTruth("rgbd", "p1", 0.0, 0.0, 0.0, RNG.normal(size=(3, 4))),
        "mocopi": take_truth.DeviceTruth(
            "inertial", "p2", 0.25, -30.0, 0.05, RNG.normal(size=(3, 4))
        ),
    },
)


@pytest.mark.parametrize("truth", [TRUTH, replace(TRUTH, events={}, shaken={}, devices={})])
def test_what_was_written_is_read(tmp_path, truth):
    take_truth.write(tmp_path / "truth.npz", truth)
    found = take_truth.read(tmp_path / "truth.npz")
    for key in ("time_s", "joints", "person_id", "xyz", "racket"):
        np.testing.assert_array_equal(getattr(found, key), getattr(truth, key))
    assert (found.offset_s, found.drift_ppm) == (truth.offset_s, truth.drift_ppm)
    assert next(iter(found.offset_s)) == "back", "the reference comes first"
    assert found.events == {"p1": {}, "p2": {}} | truth.events
    assert found.shaken.keys() == truth.shaken.keys()
    for name, poses in truth.shaken.items():
        np.testing.assert_array_equal(found.shaken[name], poses)
    assert list(found.devices) == list(truth.devices)
    for name, device in truth.devices.items():
        read, written = vars(found.devices[name]), dict(vars(device))
        np.testing.assert_array_equal(read.pop("from_world"), written.pop("from_world"))
        assert read == written


def test_a_take_may_have_devices_only(tmp_path):
    truth = replace(TRUTH, offset_s={}, drift_ppm={}, shaken={})
    take_truth.write(tmp_path / "truth.npz", truth)
    found = take_truth.read(tmp_path / "truth.npz")
    assert (found.offset_s, list(found.devices)) == ({}, ["d415", "mocopi"])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"drift_ppm": {"back": 0.0}}, "clocks of the same cameras"),
        ({"events": {"p9": {"hit": 1.0}}}, "events of people"),
        (
            {"devices": {"d": take_truth.DeviceTruth("rgbd", "p9", 0, 0, 0, np.eye(3, 4))}},
            "p9",
        ),
        ({"time_s": np.arange(4) / 30}, "expected shape"),
        ({"racket": np.zeros((2, 5, 3, 3))}, "expected shape"),
    ],
)
def test_what_does_not_fit_together_is_refused(tmp_path, change, message):
    with pytest.raises(ValueError, match=message):
        take_truth.write(tmp_path / "truth.npz", replace(TRUTH, **change))
    assert list(tmp_path.iterdir()) == []


def test_another_file_is_refused(tmp_path):
    np.savez(tmp_path / "other.npz", format=np.array("courtside truth 1"), time_s=np.zeros(3))
    with pytest.raises(InputError, match="courtside take truth 2"):
        take_truth.read(tmp_path / "other.npz")
