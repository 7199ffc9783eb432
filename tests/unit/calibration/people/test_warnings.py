"""Warnings about cameras from people, and none about good ones."""

import numpy as np
import pytest

from courtside.calibration.people import warnings, world_frame
from courtside.calibration.people.held_out import Score
from courtside.calibration.people.views import Limits, Seen
from courtside.geometry import camera as camera_models
from courtside.geometry import rotations
from courtside.geometry.similarity import Sim3
from fixtures.cameras import corner_cameras
from fixtures.people import tracks_made

TRUE = corner_cameras.four_cameras()[:3]
WALK = np.concatenate(tracks_made.persons(100))
LIMITS = Limits(score=0.05, limit=0.05, fade=0.067)
GOOD = Score(accepted=[np.ones((3, 5))])


def found(cameras=TRUE, joints=WALK, shown=None, score=GOOD, per_s=10):
    """Return the warnings about cameras that see two persons without errors."""
    xy = np.stack([camera_models.project(camera, joints) for camera in cameras])
    seen_score = np.full(xy.shape[:3], 0.9)
    if shown is not None:
        seen_score[~shown] = np.nan
        xy[~shown] = np.nan
    track = np.repeat([0, 1], 100)
    time_s = np.tile(np.arange(100) / per_s, 2)
    seen = Seen(xy, seen_score, np.full(xy.shape[:2], 400.0), track, time_s)
    half, nothing = seen.blocks(2) % 2 == 1, np.empty((0, 3))
    apart = world_frame.halves_apart(joints, cameras, half, nothing)
    return warnings.find(cameras, seen, joints, score, LIMITS, apart)


def test_good_cameras_have_no_warning():
    assert found() == []


def test_a_short_time_has_a_warning():
    (line,) = found(per_s=20)
    assert line.startswith("people: expected 15 s or more in the views of two cameras, all persons")
    assert "found 10 s; add longer takes" in line


def test_a_camera_beside_another_and_no_third_is_named():
    away = [corner_cameras.camera(f"c{at}", np.array([30, at, 2.0]), (960, 540)) for at in range(3)]
    lines = found(away)
    assert len(lines) == 3
    assert lines[0].startswith("camera c0: expected rays that meet those of another camera at 10 d")
    assert "found 4 at most" in lines[0]


def test_a_camera_that_sees_people_for_a_moment_is_named():
    shown = np.ones((3, 200), dtype=bool)
    shown[2, 30:] = False
    (line,) = found(shown=shown)
    assert line.startswith("camera c2: it shares only 360 joints with the others, the median camer")


def test_a_camera_with_many_views_left_out_is_named():
    accepted = np.array([[1.0, 1, 1, 1], [1, 1, 1, 1], [1, 1, 0, np.nan]])
    (line,) = found(score=Score(accepted=[accepted]))
    assert line.startswith("camera c2: expected 75 % or more of its views of held-out joints to ag")
    assert "found 67 %; check its clock" in line


def test_a_floor_that_changes_over_time_has_a_warning():
    second = np.tile(np.arange(100) >= 50, 2)
    tilted = Sim3(1.0, rotations.rotation_from_rodrigues([0.04, 0, 0]), np.zeros(3))
    joints = np.where(second[:, None, None], tilted.points(WALK), WALK)
    (line,) = found(joints=joints)
    assert line.startswith("floor: the first half of each track and the second half give floors th")
    degrees = float(line.split(" differ by ")[1].split()[0])
    assert degrees == pytest.approx(2.3, abs=0.4)


def test_a_floor_of_few_whole_bodies_has_a_warning():
    joints = WALK.copy()
    joints[::2, 0] = np.nan
    joints[1:100:2, 1] = np.nan
    joints[103::2, 1] = np.nan
    assert found(joints=joints)[-1].startswith("floor: it is defined by few frames")
