"""A camera in which nobody is associated is found again, and sees everybody afterwards."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.people.views import Limits
from courtside.reconstruction import lost_cameras
from courtside.records.cameras.footage import Footage
from courtside.records.devices.clocks import Clock
from fixtures.cameras import scene
from fixtures.people import found as people_found
from fixtures.people import walker

TRUE = scene.ring(4)
LIMITS = Limits(score=0.05, limit=0.05, fade=0.067)
SKELETON = walker.SKELETON


def wrong(camera):
    shift = camera.cam_from_world + np.array([[0, 0, 0, 0.8], [0, 0, 0, 0.1], [0, 0, 0, 0.3]])
    return replace(camera, cam_from_world=shift)


def take(cameras, shown, lost=(), shift_m=(0, 0, 0)):
    """Return the footage of a take whose pictures `shown` saw; nobody is associated in `lost`."""
    record = walker.points(n_frames=60)
    record = replace(record, xyz=record.xyz + np.array(shift_m))
    views = walker.views(record, shown)
    index = {c.name: np.full((1, 60), -1 if c.name in lost else 0) for c in cameras}
    people = people_found.people(index, ("p1",), model=record.model)
    return [Footage(c, v, Clock(), None, people) for c, v in zip(cameras, views, strict=True)]


def test_a_lost_camera_is_found_again_and_its_people_are_associated():
    base = [*TRUE[:3], wrong(TRUE[3])]
    found = lost_cameras.recover(base, {"a": take(base, TRUE, ["c3"])}, LIMITS, SKELETON, None)
    assert found.which == [3] and found.lines == [] and found.cameras[:3] == base[:3]
    off_m = np.linalg.norm(found.cameras[3].centre_in_world - TRUE[3].centre_in_world)
    assert off_m < 0.02
    assert np.isfinite(found.parts["a"].score[3]).mean() > 0.9


def test_good_cameras_are_left_alone():
    found = lost_cameras.recover(TRUE, {"a": take(TRUE, TRUE)}, LIMITS, SKELETON, None)
    assert found.cameras is None and found.which == [] and found.lines == []


def test_a_camera_moved_between_takes_is_named_with_them():
    takes = {"a": take(TRUE, TRUE), "b": take(TRUE, [*TRUE[:3], wrong(TRUE[3])], ["c3"])}
    found = lost_cameras.recover(TRUE, takes, LIMITS, SKELETON, None)
    (line,) = found.lines
    assert line.startswith("camera c3: ") and "none in b, others in a: was it moved?" in line
    assert found.cameras is None


def test_a_camera_whose_picture_people_stay_out_of_in_a_take_is_not_accused():
    *others, last = take(TRUE, TRUE, ["c3"])
    empty = replace(last.tracklets, score=np.zeros_like(last.tracklets.score))
    takes = {"a": take(TRUE, TRUE), "b": [*others, replace(last, tracklets=empty)]}
    found = lost_cameras.recover(TRUE, takes, LIMITS, SKELETON, None)
    assert found.lines == [] and found.which == []


def away(camera):
    """Return a camera turned by 90 degrees about the vertical: it faces the spectators."""
    turn = np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]])
    return replace(camera, cam_from_world=turn @ camera.cam_from_world)


def facing_spectators(cameras, shift_m=(0, 0, 0)):
    """Return a take whose last camera sees somebody who sits, and nobody of the others' people."""
    *others, last = take(cameras, TRUE, ["c3"], shift_m)
    seated = np.repeat(last.tracklets.xy[:, :1], last.tracklets.xy.shape[1], axis=1)
    noise = np.random.default_rng(0).normal(size=seated.shape)
    return [*others, replace(last, tracklets=replace(last.tracklets, xy=seated + noise))]


def test_a_camera_that_sees_only_spectators_is_not_accused():
    """It faces away from the players: its joints are of others, and its calibration is right."""
    cameras = [*TRUE[:3], away(TRUE[3])]
    found = lost_cameras.recover(cameras, {"a": facing_spectators(cameras)}, LIMITS, SKELETON, None)
    assert found.cameras is None and found.which == [] and found.lines == []


def test_a_camera_that_sees_only_spectators_in_one_take_is_not_accused():
    """In the second take, the players are beside its picture."""
    aside = 5 * TRUE[3].cam_from_world[0, :3]
    takes = {"a": take(TRUE, TRUE), "b": facing_spectators(TRUE, aside)}
    found = lost_cameras.recover(TRUE, takes, LIMITS, SKELETON, None)
    assert found.lines == [] and found.which == []


def test_a_camera_turned_away_between_takes_is_named_although_its_pose_expects_nobody():
    """In the second take it sees players where its old pose expects nobody."""
    aside = 5 * TRUE[3].cam_from_world[0, :3]
    shown = [*TRUE[:3], scene.ring(4)[3]]
    turn = np.radians(40)
    matrix = np.array(
        [[np.cos(turn), 0, -np.sin(turn)], [0, 1, 0], [np.sin(turn), 0, np.cos(turn)]]
    )
    shown[3] = replace(shown[3], cam_from_world=matrix @ shown[3].cam_from_world)
    takes = {"a": take(TRUE, TRUE), "b": take(TRUE, shown, ["c3"], aside)}
    (line,) = lost_cameras.recover(TRUE, takes, LIMITS, SKELETON, None).lines
    assert "none in b, others in a: was it moved?" in line


def test_a_camera_that_sees_spectators_where_it_should_see_players_is_accused():
    found = lost_cameras.recover(TRUE, {"a": facing_spectators(TRUE)}, LIMITS, SKELETON, None)
    assert found.cameras is None and "people do not determine its pose" in found.lines[0]


def test_a_camera_that_people_do_not_find_is_named():
    base = [*TRUE[:3], wrong(TRUE[3])]
    seen = take(base, TRUE, ["c3"])
    blind = replace(seen[3].tracklets, xy=np.full_like(seen[3].tracklets.xy, np.nan))
    seen = [*seen[:3], replace(seen[3], tracklets=blind)]
    found = lost_cameras.recover(base, {"a": seen}, LIMITS, SKELETON, None)
    assert found.cameras is None and "people do not determine its pose" in found.lines[0]


@pytest.fixture(autouse=True)
def _quiet():
    with np.errstate(all="ignore"):
        yield
