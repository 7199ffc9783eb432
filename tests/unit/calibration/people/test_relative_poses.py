"""Relative poses from tracks: recovered up to a similarity, whoever is whom; bad input refused."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.people import relative_poses
from courtside.calibration.people.relative_poses import Take
from courtside.geometry.similarity import umeyama
from courtside.study.errors import InputError
from fixtures.cameras import corner_cameras
from fixtures.people import remembered, tracks_made

TRUE = corner_cameras.four_cameras()[:3]
WALK = tracks_made.persons()


@pytest.fixture(autouse=True, scope="module")
def _remembered():
    with remembered.essential():
        yield


def posed(cameras, *takes):
    return relative_poses.pose(cameras, takes, relative_poses.pair(cameras, takes))[0]


def test_cameras_are_placed_and_persons_followed_through_tracks_in_any_order():
    found, tracks = posed(TRUE, tracks_made.take(TRUE, WALK))
    ours, true = (np.stack([c.centre_in_world for c in cameras]) for cameras in (found, TRUE))
    world = umeyama(ours, true)
    assert np.linalg.norm(world.points(ours) - true, axis=1).max() < 0.1
    for camera, real in zip(found, TRUE, strict=True):
        turned = world.camera(camera).cam_from_world[:, :3] @ real.cam_from_world[:, :3].T
        assert np.degrees(np.arccos((np.trace(turned) - 1) / 2)) < 1.0
    assert sorted(tracks) == [(0, ((0,), (1,), (0,))), (0, ((1,), (0,), (1,)))]


@pytest.mark.parametrize("camera", range(3))
def test_all_parts_of_a_broken_track_are_one_person(camera):
    xy = tracks_made.take(TRUE, WALK).xy
    cut = np.concatenate([xy[camera], xy[camera][:1]])
    cut[0, 25:], cut[2, :30] = np.nan, np.nan
    _, tracks = posed(TRUE, Take("cut", [*xy[:camera], cut, *xy[camera + 1 :]]))
    assert sorted(rows[camera] for _, rows in tracks) == [(1,), (2, 0)]


def test_two_broken_tracks_are_joined_by_a_third_camera_that_follows_the_person():
    xy = tracks_made.take(TRUE, WALK[:1]).xy
    cut = [np.concatenate([one, one]) for one in xy[:2]]
    for one in cut:
        one[0, 28:], one[1, :32] = np.nan, np.nan
    _, tracks = posed(TRUE, Take("cut", [*cut, xy[2]]))
    assert tracks == [(0, ((0, 1), (0, 1), (0,)))]


def test_rows_of_a_person_fill_each_other_and_the_first_counts():
    values = np.array([[[1.0], [np.nan], [np.nan]], [[5.0], [6.0], [np.nan]]])
    assert relative_poses.of_rows(values, [0, 1])[:2].ravel().tolist() == [1, 6]
    assert np.isnan(relative_poses.of_rows(values, [])).all()


def test_who_is_whom_must_be_certain():
    half_turn = WALK[0] * [-1, -1, 1]  # all that the first does, at the other side of the room
    twins = np.stack([WALK[0], half_turn])
    with pytest.raises(InputError, match="take walk: expected one way to pair the tracks of"):
        posed(TRUE, tracks_made.take(TRUE, twins))
    found, _ = posed(TRUE, tracks_made.take(TRUE, WALK[:1], name="one"))
    assert len(found) == 3


def test_a_mirrored_video_is_refused():
    take = tracks_made.take(TRUE, WALK)
    take.xy[2][..., 0] = 1919 - take.xy[2][..., 0]
    with pytest.raises(InputError, match=r"camera c\d: .* that its video is not mirrored"):
        posed(TRUE, take)


def test_cameras_in_one_place_see_no_depth():
    beside = [replace(TRUE[0], name=name) for name in "abc"]
    with pytest.raises(InputError, match="cameras a, b, c: expected two whose rays"):
        posed(beside, tracks_made.take(beside, WALK))


def test_too_few_joints_are_one_line():
    with pytest.raises(InputError, match="expected 200 joints or more of one person"):
        posed(TRUE, tracks_made.take(TRUE, tracks_made.persons(12)))
