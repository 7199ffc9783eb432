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


BESIDE = [[0.0, -7, 0], [6, -7, 0], [0, -6, 0], [6, -6, 0]]


def all_over():
    """Return joints of people whose feet are all over a court of 6 m by 12 m."""
    joints = np.concatenate(WALK)
    places = np.random.default_rng(0).uniform([0, -6], [6, 6], (len(joints), 2))
    joints = joints - joints.mean(axis=1, keepdims=True) * [1, 1, 0]
    return joints + np.pad(places, ((0, 0), (0, 1)))[:, None]


def test_short_lengths_on_the_floor_do_not_tilt_it_where_feet_are_all_over_it():
    """The base line and a racket before it, whose ends are seen 1 cm too high."""
    points = np.array([[0, -6, 0], [6, -6, 0], [2.7, -5.3, 0.01], [3.3, -5.3, 0.01]])
    far = np.array([[0.0, 6, 0], [6, 6, 0]])
    alone, with_points = (
        world_frame.floor(all_over(), TRUE, on_floor).points(far)[:, 2]
        for on_floor in (NO_POINTS, points)
    )
    assert np.abs(with_points).max() < np.abs(alone).max() + 0.03


@pytest.mark.parametrize(("points", "depth"), [(BESIDE, 0.1), (BESIDE[:2], 1)])
def test_the_error_of_a_floor_by_points_is_small_at_them_and_larger_under_people(points, depth):
    """Of two points, or where feet tell less than four points, on a strip (`depth`)."""
    rng, points = np.random.default_rng(0), np.array(points)
    joints, sigma = all_over() * [1, depth, 1], world_frame.POINT_M
    exact = world_frame.floor(joints, TRUE, points)
    places = np.array([np.mean(points, axis=0), [3.0, 0, 0], [6.0, 3, 0]])
    heights = [
        world_frame.floor(joints, TRUE, points + rise[:, None] * [0, 0, 1]).points(places)[:, 2]
        for rise in rng.normal(0, sigma, (150, len(points)))
    ]
    true = np.std(heights, axis=0)
    x, y, _ = exact.points(places).T
    rises = np.stack([y, -x, np.ones(len(places))], axis=1)
    frame = world_frame.frame_error(exact.points(joints), np.zeros(3), exact.points(points))
    stated = np.sqrt(np.einsum("ni,ij,nj->n", rises, frame, rises))
    assert stated[0] == pytest.approx(sigma / np.sqrt(len(points)), rel=0.01)
    assert (stated[1:] > 1.5 * stated[0]).all() and (stated > 0.8 * true).all()
    if len(points) > 2:  # the tilt by feet errs more than these draws, which have one set of feet
        np.testing.assert_allclose(stated, true, rtol=0.25)
