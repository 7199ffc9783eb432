"""The world of people: the floor under feet, the covariance of the shape alone."""

import numpy as np
import pytest

from courtside.calibration import point_covariance
from courtside.calibration.bundle import conversion
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
    network = conversion.network_of(TRUE)
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


NO_POINTS = np.empty((0, 3))


def tilted(joints, slopes):
    """Return joints (T, J, 3) of people whose floor has these slopes along x and y."""
    return joints + [0, 0, 1] * (joints[..., :2] @ np.array(slopes))[..., None]


def test_the_vertical_is_as_uncertain_as_halves_of_the_time_disagree():
    joints = np.concatenate(WALK) * [4, 4, 1]  # feet all over a hall
    half = np.arange(len(joints)) % 2 == 1
    same = world_frame.halves_apart(joints, TRUE, half, NO_POINTS)
    assert np.abs(same).max() < 0.01
    leaning = np.where(half[:, None, None], tilted(joints, [0.04, 0]), joints)
    apart = world_frame.halves_apart(leaning, TRUE, half, NO_POINTS)
    assert abs(apart[0]) == pytest.approx(0.04, rel=0.3) and abs(apart[1]) < 0.02
    sure, unsure = (
        np.sqrt(np.diag(world_frame.frame_error(joints, one, NO_POINTS))) for one in (same, apart)
    )
    assert np.degrees(sure[:2]).max() < 2
    # A half's floor has the standard deviation 0.04 / sqrt(2), the mean of two 0.02; 90 % of such
    # means lie within what is stated, the same along both axes, as in `F` with two and two degrees.
    assert (unsure[:2] > 0.02).all() and (unsure[:2] < 0.04).all()


def test_two_halves_state_an_error_that_holds_nine_in_ten():
    """Slopes of halves drawn with one scatter: the mean's error is inside the stated ellipse."""
    rng, inside = np.random.default_rng(0), []
    for _ in range(20_000):
        halves = rng.normal(0, 1, (2, 2))
        variance = world_frame.OF_TILT * np.sum((halves[0] - halves[1]) ** 2) / 8
        inside.append(np.sum(halves.mean(axis=0) ** 2) <= variance * -2 * np.log(0.1))
    assert np.mean(inside) == pytest.approx(0.9, abs=0.01)


def test_people_on_one_spot_tell_the_vertical_as_well_as_bodies_do():
    spot = np.concatenate(WALK)
    spot = spot - spot.mean(axis=1, keepdims=True) * [1, 1, 0]
    stated = world_frame.frame_error(spot, np.zeros(3), NO_POINTS)
    assert np.degrees(np.sqrt(np.diag(stated)[:2])).max() == pytest.approx(5, abs=1)
    few = world_frame.frame_error(spot, None, NO_POINTS)
    assert (np.diag(few)[:2] > np.diag(stated)[:2]).all()


def test_clicked_points_on_the_floor_state_their_own_error():
    corners = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    found = world_frame.frame_error(np.concatenate(WALK), np.ones(3), corners)
    np.testing.assert_allclose(np.diag(found), world_frame.POINT_M**2 * np.full(3, 0.25))


def test_a_wall_s_slope_along_x_is_a_turn_about_y():
    line = np.concatenate(WALK) * [0.01, 1, 1]  # feet on a line along y say nothing along x
    about_x, about_y = np.diag(world_frame.frame_error(line, np.zeros(3), NO_POINTS))[:2]
    assert about_y > 4 * about_x
