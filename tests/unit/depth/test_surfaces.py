import numpy as np
import pytest

from courtside.depth.surfaces import Sampler, Sampling, modes_of, plane_at_origin
from courtside.geometry import camera
from fixtures.recordings import depth_scenes

RNG = np.random.default_rng(4)
RIG = depth_scenes.rig()
BALL = np.array([0.3, -0.2, 2.4])


def sampler(radius_m=(0.05,), **changed):
    trunk = np.zeros(len(radius_m), dtype=bool)
    return Sampler(RIG, np.array(radius_m), trunk, 0.055, Sampling(**changed))


def seen(shapes, wall_m=depth_scenes.WALL_M):
    return depth_scenes.depth_of(RIG.depth, shapes, RIG.colour_from_depth, wall_m, n_balls=2)


def ball(centre=BALL, radius=0.05):
    return [(centre, centre, radius, radius)]


def place(xyz):
    return camera.project(RIG.colour, np.atleast_2d(xyz))


def test_noise_grows_with_the_square_of_the_distance():
    focal = RIG.depth.K[0, 0]
    assert sampler().sigma_z(2.0) == pytest.approx(4 * 0.1 / (focal * 0.055))


def test_a_ball_s_skin_is_found():
    found, z_body = sampler().surfaces(place(BALL), depth_scenes.steps(seen(ball())))
    near = BALL[2] - 0.05 * BALL[2] / np.linalg.norm(BALL)
    # Over a window of half width w the ball's skin lies w^2 / (3 r) behind its nearest point.
    half = Sampling().window * 0.05
    assert found[0, 0] == pytest.approx(near + half**2 / (3 * 0.05), abs=0.003)
    assert z_body == pytest.approx(near, abs=0.02)


def test_the_wall_beside_a_limb_comes_second():
    at = place(BALL) + np.array([8.0, 0.0])  # near the ball's rim
    found, _ = sampler(window=1.5).surfaces(at, depth_scenes.steps(seen(ball())))
    assert found[0, 0] == pytest.approx(2.37, abs=0.03)
    assert found[0, 1] == pytest.approx(depth_scenes.WALL_M, abs=0.03)


def test_a_hole_is_filled_from_around_it_within_limits():
    depth_m = seen(ball())
    u, v = np.rint(camera.project(RIG.depth, BALL - RIG.colour_from_depth[:, 3])).astype(int)
    small, large = depth_m.copy(), depth_m.copy()
    small[v - 3 : v + 4, u - 3 : u + 4] = 0
    large[v - 14 : v + 15, u - 14 : u + 15] = 0
    found, _ = sampler((0.04,)).surfaces(place(BALL), depth_scenes.steps(small))
    assert found[0, 0] == pytest.approx(2.352, abs=0.02)
    found, z_body = sampler((0.04,)).surfaces(place(BALL), depth_scenes.steps(large))
    assert np.isnan(found).all()
    assert np.isnan(z_body)


def test_mixed_pixels_at_edges_are_left_out():
    """Flying pixels between limb and wall, as stereo cameras produce them, do not count."""
    depth_m = seen(ball())
    inside = depth_m < 3
    rim = inside & ~(
        np.roll(inside, 1, 0)
        & np.roll(inside, -1, 0)
        & np.roll(inside, 1, 1)
        & np.roll(inside, -1, 1)
    )
    depth_m[rim] = 3.3
    found, _ = sampler(window=1.5).surfaces(place(BALL), depth_scenes.steps(depth_m))
    assert found[0, 0] == pytest.approx(2.352, abs=0.01)
    assert not (np.abs(found - 3.3) < 0.3).any()


def test_no_joint_no_depth():
    found, z_body = sampler().surfaces(np.full((1, 2), np.nan), depth_scenes.steps(seen(ball())))
    assert np.isnan(found).all()
    assert np.isnan(z_body)


def test_a_joint_beside_the_depth_picture_has_none():
    found, _ = sampler().surfaces(np.array([[-4000.0, 10.0]]), depth_scenes.steps(seen(ball())))
    assert np.isnan(found).all()


def test_modes_are_what_most_pixels_share_and_not_the_mean():
    z = np.concatenate([RNG.normal(2.0, 0.005, 60), RNG.normal(3.0, 0.005, 200), [2.5, 2.6]])
    assert modes_of(z, 0.02, Sampling()) == pytest.approx([2.0, 3.0], abs=0.005)
    assert modes_of(z, 0.02, Sampling(min_share=0.3)) == pytest.approx([3.0], abs=0.005)
    tied = np.repeat([2.0, 3.0], 8) + np.tile(np.linspace(0, 0.007, 8), 2)
    assert modes_of(tied, 0.02, Sampling()) == pytest.approx([2.0035, 3.0035])
    assert modes_of(np.zeros(0), 0.02, Sampling()) == []


def test_a_slanting_limb_is_read_at_the_joint():
    x, y = RNG.uniform(-5, 5, (2, 80))
    z = 2.0 + 0.01 * x - 0.004 * y
    z[:9] = 2.4  # something else
    assert plane_at_origin(x, y, z, 1.97, 0.03) == pytest.approx(2.0, abs=0.004)


def test_a_single_row_of_pixels_stays_within_them():
    x = np.linspace(1, 5, 9)
    found = plane_at_origin(x, np.zeros(9), 2 + 0.01 * x, 2.03, 0.02)
    assert 2.01 <= found <= 2.05
