"""Body motions survive the file; other files are refused."""

import numpy as np
import pytest

from courtside.records.keypoints import body_motion
from courtside.study.errors import InputError
from fixtures.people.bodies_made import body


def test_a_body_motion_survives_the_file(tmp_path):
    rng = np.random.default_rng(0)
    xyz = rng.normal(size=(5, 2, 3))
    xyz[2, 1] = np.nan
    made = body(np.arange(5) / 30, xyz, ["left_wrist", "head"], source="mocopi", unit_m=0.76)
    body_motion.write(tmp_path / "body.npz", made)
    found = body_motion.read(tmp_path / "body.npz")
    assert (found.source, found.kind, found.unit_m) == ("mocopi", "rgb", 0.76)
    for key in ("joints", "time_s", "fixed", "following", "reason", "tpose_s", "clap_s"):
        np.testing.assert_array_equal(getattr(found, key), getattr(made, key))
    np.testing.assert_array_equal(found.joint("head"), xyz[:, 1])


def test_another_file_is_refused(tmp_path):
    path = tmp_path / "other.npz"
    np.savez(path, format="courtside device motion 1")
    with pytest.raises(InputError, match=r"other\.npz: expected format"):
        body_motion.read(path)
