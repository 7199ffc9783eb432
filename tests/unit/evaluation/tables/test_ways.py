"""Ways to calibrate side by side: errors of moved cameras, shares of views, predicted errors."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import court
from courtside.evaluation.tables import ways
from courtside.geometry.camera import Camera
from courtside.geometry.similarity import Sim3
from fixtures.cameras.scene import look_at
from fixtures.people import walker

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
K = np.array([[1100.0, 0, 640], [0, 1100, 360], [0, 0, 1]])


def cameras():
    places = {"side": (-18, 6.7, 1.9), "back": (3, -14, 2.1), "front": (3, 27, 2.0)}
    aim = (3.05, 6.7, 1.3)
    return [
        Camera(name, (1280, 720), K, np.zeros(5), look_at(at, aim)) for name, at in places.items()
    ]


def test_a_moved_world_is_an_error_of_place_but_not_of_shape():
    moved = Sim3(1.0, np.eye(3), np.array([0.03, 0.0, 0.04]))
    found = ways.against_truth([moved.camera(c) for c in cameras()], cameras(), COURT)
    assert found["volume_rms_cm"] == pytest.approx(5.0, rel=1e-6)
    assert found["shape_cm"] == pytest.approx(0.0, abs=1e-6)


def test_one_moved_camera_is_an_error_of_shape_too():
    side, *others = cameras()
    pose = side.cam_from_world.copy()
    pose[0, 3] += 0.1
    found = ways.against_truth([*others, replace(side, cam_from_world=pose)], cameras(), COURT)
    assert 0.5 < found["shape_cm"] < found["volume_rms_cm"] < 10


def test_cameras_that_are_not_those_of_the_truth_have_no_error():
    assert ways.against_truth(cameras()[:2], cameras(), COURT) == {}


def test_accepted_views_are_counted_over_takes():
    points = walker.points(8)
    half = points.accepted.copy()
    half[:, :4] = False
    takes = [replace(points, accepted=np.ones_like(half)), replace(points, accepted=half)]
    found = ways.accepted(takes)
    assert found["n_views"] > 0
    assert 70 < found["accepted_percent"] < 80
    assert ways.accepted([]) == {"accepted_percent": None, "n_views": 0}


def test_a_calibration_says_what_it_knows_of_itself():
    nothing = {"taken": None, "expected_before_cm": None, "expected_cm": None}
    assert ways.from_quality({"warnings": []}) == nothing
    refined = {"taken": "refined", "expected_before_cm": 2.0, "expected_volume_rms_cm": 1.5}
    assert ways.from_quality(refined)["expected_cm"] == 1.5
