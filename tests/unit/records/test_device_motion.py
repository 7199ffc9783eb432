"""Skeletons of devices between rules."""

import numpy as np
import pytest

from courtside.records import device_motion, reasons
from courtside.study.errors import InputError


def motion():
    xyz = np.arange(24.0).reshape(4, 2, 3)
    xyz[1, 0] = np.nan
    reason = np.zeros((4, 2), dtype=np.uint8)
    reason[1, 0] = reasons.NO_DEPTH
    return device_motion.DeviceMotion(
        source="d415-depth",
        kind="rgbd",
        joints=np.array(["left_wrist", "right_wrist"]),
        time_s=np.array([0.0, 0.1, 0.2, 0.35]),
        xyz=xyz,
        reason=reason,
        performed=np.array([False, True, True, True]),
    )


def test_what_is_written_is_read(tmp_path):
    wanted = motion()
    device_motion.write(tmp_path / "motion.npz", wanted)
    found = device_motion.read(tmp_path / "motion.npz")
    assert (found.source, found.kind) == ("d415-depth", "rgbd")
    for key in ("joints", "time_s", "xyz", "reason", "performed"):
        np.testing.assert_array_equal(getattr(found, key), getattr(wanted, key))


def test_a_joint_is_found_by_its_name():
    np.testing.assert_array_equal(motion().joint("right_wrist")[2], [15.0, 16.0, 17.0])
    with pytest.raises(ValueError, match="nose"):
        motion().joint("nose")


def test_another_file_is_refused(tmp_path):
    np.savez(tmp_path / "other.npz", time_s=np.zeros(3))
    with pytest.raises(InputError, match="other.npz"):
        device_motion.read(tmp_path / "other.npz")
