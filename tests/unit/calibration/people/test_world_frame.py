"""The world of people: the floor under feet, the covariance of the shape alone."""

import numpy as np
import pytest

from courtside.calibration import point_covariance
from courtside.calibration.bundle import selection
from courtside.calibration.people import prior, world_frame
from courtside.calibration.records import covariance
from courtside.geometry import rotations
from courtside.geometry.similarity import Sim3
from courtside.records.keypoints import skeleton
from courtside.study.errors import InputError
from fixtures.cameras import corner_cameras
from fixtures.people import tracks_made

TRUE = corner_cameras.four_cameras()
WALK = tracks_made.persons()
ELSEWHERE = Sim3(1.0, rotations.rotation_from_rodrigues([0.4, -0.3, 1.2]), np.array([3.0, -2, 5]))


def test_the_floor_is_found_under_feet_from_any_axes():
    elsewhere = [ELSEWHERE.camera(camera) for camera in TRUE]
    joints = ELSEWHERE.points(np.concatenate(WALK))
    world = world_frame.floor(joints, elsewhere)
    placed = world.points(joints) - np.concatenate(WALK)
    # Ankles of the made persons are 0.08 m high; z is the same up to what an ankle's height is.
    assert np.ptp(placed[..., 2]) < 0.03
    assert np.abs(placed[..., 2]).max() < 0.05
    x = [world.camera(camera).centre_in_world for camera in elsewhere]
    assert (x[1] - x[0])[1] == pytest.approx(0, abs=1e-9)
    assert (x[1] - x[0])[0] > 0


@pytest.mark.parametrize(
    "hidden", [["ankle"], ["knee", "ankle"], ["hip", "knee", "elbow"], ["shoulder"]]
)
def test_people_without_legs_or_trunk_tell_no_floor(hidden):
    joints = np.concatenate(WALK).copy()
    at = [k for k, name in enumerate(skeleton.JOINTS) if name.split("_")[1] in hidden]
    joints[:, at] = np.nan
    with pytest.raises(InputError, match=r"hips, knees, ankles and shoulders .* in 20 frames"):
        world_frame.floor(joints, TRUE)


def test_points_on_the_floor_tell_its_height_and_three_of_them_its_tilt():
    elsewhere = [ELSEWHERE.camera(camera) for camera in TRUE]
    joints = ELSEWHERE.points(np.add(np.concatenate(WALK), [0, 0, 0.1]))  # feet never stand
    corners = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    for points, off_m in ((corners, 1e-9), (corners[:2], 0.03)):
        floor = ELSEWHERE.points(points)
        world = world_frame.floor(joints, elsewhere, floor)
        assert np.abs(world.points(floor)[:, 2]).max() < off_m
        assert world.points(elsewhere[0].centre_in_world)[2] == pytest.approx(2.0, abs=0.1)


def test_the_covariance_is_of_the_shape_and_of_the_scale():
    known = prior.stated(
        TRUE, rotation_deg=5, position_m=1, focal_percent=1, principal_point_percent=1, k1=0.01
    )
    places = WALK[:, ::6].reshape(-1, 3)
    network = selection.of_cameras(TRUE)
    whole = known.of_columns()
    by_column = point_covariance.sensitivity(network, places).reshape(places.size, -1)
    shape = world_frame.of_shape(TRUE, whole, places, 0.0)
    about = places - places.mean(axis=0)
    motions = [np.tile(axis, len(places)) for axis in np.eye(3)]
    motions += [np.cross(axis, about).ravel() for axis in np.eye(3)] + [about.ravel()]
    before, after = (
        [float(np.sum((motion @ by_column @ one) * (motion @ by_column))) for motion in motions]
        for one in (whole, shape)
    )
    assert (np.array(after) < 1e-6 * np.array(before)).all()
    scaled = world_frame.of_shape(TRUE, np.zeros_like(whole), places, 0.01)
    spread = by_column @ scaled @ by_column.T
    np.testing.assert_allclose(spread, 1e-4 * np.outer(about, about), atol=1e-7)
    named = covariance.of_network([camera.name for camera in TRUE], scaled)
    assert named.covariance.shape == (56, 56)
