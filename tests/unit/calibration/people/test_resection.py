"""A camera that agrees with nobody is found again by the people whom the others place."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.calibration.people import prior, resection
from courtside.calibration.people.views import Limits, joined
from courtside.calibration.records.covariance import PARAMETERS
from fixtures.cameras import corner_cameras, walkers

TRUE = corner_cameras.four_cameras()
LIMITS = Limits(score=0.05, limit=0.05, fade=0.067)
WALK = walkers.joints(40)
SEEN = walkers.seen(TRUE, WALK)


def moved(camera, degrees=3.0, metres=0.5):
    """Return a camera turned about one axis of its own and moved to the side."""
    turn = Rotation.from_rotvec([0, np.radians(degrees), 0]).as_matrix()
    shift = turn @ camera.cam_from_world[:, 3] + [metres, 0, 0]
    pose = np.column_stack([turn @ camera.cam_from_world[:, :3], shift])
    return replace(camera, cam_from_world=pose)


BASE = [*TRUE[:2], moved(TRUE[2]), TRUE[3]]


def test_only_a_camera_that_agrees_with_nobody_is_lost():
    assert resection.lost(BASE, SEEN, LIMITS) == [2]
    assert resection.lost(TRUE, SEEN, LIMITS) == []
    blind = SEEN.score.copy()
    blind[2] = np.nan
    assert resection.lost(BASE, replace(SEEN, score=blind), LIMITS) == [2]


def test_spectators_whom_one_camera_sees_do_not_make_it_lost():
    """It sees the walker in a tenth of its views, and spectators behind the walker in the rest."""
    n_rows = 9 * WALK.shape[0]
    some = {"xy": np.full((4, n_rows, 10, 2), np.nan), "score": np.full((4, n_rows, 10), np.nan)}
    some["xy"][2], some["score"][2] = [300.0, 200.0], 1.0
    alone = replace(
        SEEN, **some, height_px=np.full((4, n_rows), 100.0),
        track=np.zeros(n_rows, dtype=int), time_s=np.arange(n_rows) / 10,
    )  # fmt: skip
    assert resection.lost(TRUE, joined([SEEN, alone]), LIMITS) == []
    assert resection.lost(BASE, joined([SEEN, alone]), LIMITS) == [2]


def test_agreement_with_one_camera_does_not_hide_that_two_others_contradict():
    """Nobody has its views of the walker; with one other camera it places somebody else."""
    blind = SEEN.score.copy()
    blind[2] = np.nan
    walker = replace(SEEN, score=blind)
    other = walkers.seen(BASE, walkers.joints(40, way_m=0.7))
    pair = replace(other, score=np.where(np.arange(4)[:, None, None] < 2, np.nan, other.score))
    assert resection.lost(BASE, pair, LIMITS) == [0, 1]
    assert resection.lost(BASE, joined([walker, pair]), LIMITS) == [2]


def test_a_camera_before_which_people_are_often_hidden_is_not_lost():
    score = SEEN.score.copy()
    score[2, : int(0.6 * score.shape[1])] = np.nan
    assert resection.lost(TRUE, replace(SEEN, score=score), LIMITS) == []


def test_people_are_expected_where_the_camera_looks():
    assert resection.expected(TRUE[2], WALK)
    assert not resection.expected(moved(TRUE[2], degrees=90.0, metres=0.0), WALK)
    assert not resection.expected(TRUE[2], WALK[:5])
    assert not resection.expected(TRUE[2], np.full_like(WALK, np.nan))


def test_its_pose_is_found_by_the_person_who_moves_as_its_tracklet_does():
    other = walkers.joints(40, way_m=0.7)[::-1]
    rows = np.stack([np.full_like(SEEN.xy[2], np.nan), SEEN.xy[2]])
    found, count = resection.find(BASE[2], np.stack([other, WALK]), rows, LIMITS)
    assert np.linalg.norm(found.centre_in_world - TRUE[2].centre_in_world) < 0.05
    assert count > 0.95 * WALK.shape[0] * WALK.shape[1]
    assert resection.find(BASE[2], other[None], rows, LIMITS) is None
    assert resection.find(BASE[2], WALK[None, :5], rows[:, :5], LIMITS) is None


def test_next_to_nothing_is_known_of_a_camera_found_again():
    stated = {"rotation_deg": 0.3, "position_m": 0.03, "focal_percent": 0.5}
    known = prior.stated(TRUE, **stated, principal_point_percent=0.3, k1=0.01)
    sigma = np.sqrt(np.diag(resection.widened(known, TRUE, [2]).covariance)).reshape(4, -1)
    before = np.sqrt(np.diag(known.covariance)).reshape(4, -1)
    np.testing.assert_allclose(sigma[[0, 1, 3]], before[[0, 1, 3]])
    assert np.degrees(sigma[2, 0]) == pytest.approx(5) and sigma[2, 3] == 1.0
    f_px = PARAMETERS.index("f_px")
    assert sigma[2, f_px] == pytest.approx(0.1 * TRUE[2].K[1, 1])


def test_the_line_says_how_far_off_it_was():
    said = resection.line(BASE[2], TRUE[2])
    assert said.startswith("camera c2: expected people in its pictures")
    assert "turned by 3.0 degrees" in said and "50 cm away" in said
