"""Errors of a body frame: an exact one has none, and known turns, units and shifts are found."""

import json

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.evaluation import sources
from courtside.geometry.similarity import Sim3
from courtside.study.errors import InputError

RNG = np.random.default_rng(0)
TRUE = Sim3(1.3, Rotation.random(rng=RNG).as_matrix(), RNG.normal(size=3))
POSE = np.column_stack([Rotation.random(rng=RNG).as_matrix(), RNG.normal(size=3)])
STRAIGHT = np.eye(3)


def own(turn=STRAIGHT, longer=1.0, shift_m=(0, 0, 0)):
    """Return the frame of a device at `POSE` that is off by a turn and a shift in body axes."""
    world_from_device = Sim3(1.0, POSE[:, :3].T, -POSE[:, :3].T @ POSE[:, 3])
    rotation = turn @ TRUE.rotation @ world_from_device.rotation
    origin = TRUE.inverse().translation + TRUE.rotation.T @ np.array(shift_m)
    origin = POSE[:, :3] @ origin + POSE[:, 3]
    scale = TRUE.scale / longer
    return Sim3(scale, rotation, -scale * rotation @ origin)


def test_an_exact_frame_has_no_error():
    found = sources.against(own(), POSE, TRUE)
    assert found == pytest.approx({"angle_deg": 0, "unit_percent": 0, "origin_mm": 0}, abs=1e-5)


def test_turn_unit_and_shift_are_told_apart():
    turn = Rotation.from_rotvec(np.radians([1.0, -2.0, 2.0])).as_matrix()
    found = sources.against(own(turn, 1.02, (0.003, 0, 0.004)), POSE, TRUE)
    assert found == pytest.approx({"angle_deg": 3.0, "unit_percent": 2.0, "origin_mm": 5.0})


def test_a_frame_is_read_as_it_was_written(tmp_path):
    path = tmp_path / "frame.json"
    stated = {"scale_per_m": 1.25, "rotation": POSE[:, :3].tolist(), "translation": [1, 2, 3]}
    path.write_text(json.dumps(stated))
    found = sources.read(path)
    np.testing.assert_array_equal(found.points([0.0, 0.0, 0.0]), [1, 2, 3])
    np.testing.assert_array_equal(found.rotation, POSE[:, :3])
    for broken in ("{}", json.dumps(stated | {"rotation": [1, 2]}), "x"):
        path.write_text(broken)
        with pytest.raises(InputError, match=r"frame\.json: expected a body frame"):
            sources.read(path)
