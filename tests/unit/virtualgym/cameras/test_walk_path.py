"""The walked camera: its path against the fixed cameras, its twist against the motion of points."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import court
from courtside.geometry import rotations
from fixtures.cameras import scene
from virtualgym import presets
from virtualgym.cameras import layouts, walk_path

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
CENTRE = np.array([3.05, 6.7, 0.0])
PLAIN = presets.PRESETS["plain"]
SIZE = (1280, 720)


def fixed(layout="a", **options):
    return layouts.fixed_cameras(layout, COURT, SIZE, PLAIN, np.random.default_rng(0), **options)


def plan(layout="a", seed=1, preset=PLAIN, size=SIZE, **options):
    return walk_path.plan(
        fixed(layout), COURT, size, preset, np.random.default_rng(seed), **options
    )


def centres(path, n=400):
    return np.array([path.camera(time_s).centre_in_world for time_s in path.grid(n)])


@pytest.mark.parametrize("layout", layouts.LAYOUTS)
def test_the_walk_begins_and_ends_beside_the_fixed_cameras_and_passes_the_others(layout):
    places = np.array([camera.centre_in_world[:2] for camera in fixed(layout)])
    way = walk_path.way(list(places), CENTRE[:2])
    away = np.linalg.norm(way[:, None] - places, axis=2)
    assert away[0, 0] == pytest.approx(0.8, abs=0.02)
    assert away[-1, -1] == pytest.approx(0.8, abs=0.02)
    assert (np.diff(away.argmin(axis=0)) > 0).all(), "in their order"
    assert away.min() > 0.7 and away.min(axis=0).max() < 1.5
    steps = np.linalg.norm(np.diff(way, axis=0), axis=1)
    assert steps.max() < 0.06
    turns = np.diff(np.unwrap(np.arctan2(*np.diff(way, axis=0).T)))
    assert np.abs(turns).max() < 0.08, "no corner sharper than about 0.6 m radius"


def test_layout_a_is_an_arc_and_layout_b_a_straight_line():
    arc = walk_path.way([c.centre_in_world[:2] for c in fixed("a")], CENTRE[:2]) - CENTRE[:2]
    np.testing.assert_allclose(np.linalg.norm(arc, axis=1), 21, atol=0.1)
    line = walk_path.way([c.centre_in_world[:2] for c in fixed("b")], CENTRE[:2]) - CENTRE[:2]
    np.testing.assert_allclose(line[:, 1], -18, atol=1e-6)


def test_nobody_walks_over_the_court():
    way = walk_path.way([c.centre_in_world[:2] for c in fixed("b-mirror-front")], CENTRE[:2])
    assert np.linalg.norm(way - CENTRE[:2], axis=1).min() > 15


@pytest.mark.parametrize("speed_kmh", [1, 2, 4, 6])
def test_the_walk_lasts_as_long_as_its_speed_says(speed_kmh):
    path = plan(speed_kmh=speed_kmh)
    expected_m = 21 * np.pi / 2 - 1.6
    assert path.duration_s == pytest.approx(expected_m / (speed_kmh / 3.6), rel=0.01)
    moved = np.linalg.norm(np.diff(path.route(path.grid(2000)), axis=0), axis=1).sum()
    assert moved == pytest.approx(expected_m, rel=0.01)


def test_the_camera_keeps_its_height_and_the_court_in_the_picture():
    path = plan()
    heights = centres(path)[:, 2]
    assert heights.min() > 1.5 and heights.max() < 1.75
    for time_s in path.grid(30):
        xy = scene.opencv_projection(path.camera(time_s), COURT.xyz)
        assert ((xy > 0) & (xy < np.array(SIZE))).all()


@pytest.mark.parametrize("stabiliser", [True, False])
def test_the_twist_says_how_points_move(stabiliser):
    path = plan(stabiliser=stabiliser)
    points = COURT.xyz
    for time_s in path.grid(7)[1:-1]:
        angular, velocity = path.twist(time_s)
        pose, dt = path.pose(time_s), 1e-3
        in_cam = points @ pose[:, :3].T + pose[:, 3]
        # d/dt of x_in_cam = cam_from_world (x - centre): the camera's turn and its centre's motion.
        expected = -np.cross(angular, in_cam) - velocity @ pose[:, :3].T
        later, earlier = path.pose(time_s + dt), path.pose(time_s - dt)
        moved = points @ (later - earlier)[:, :3].T + (later - earlier)[:, 3]
        np.testing.assert_allclose(moved / (2 * dt), expected, atol=2e-3)
        assert np.abs(expected).max() > 0.1


def angular_rms(path):
    return np.sqrt(np.mean([np.square(path.twist(t)[0]) for t in path.grid(300)]))


def test_a_stabiliser_damps_the_hands_rotations_to_a_fifth():
    still = plan(preset=replace(PLAIN, jitter_scale=0.0))
    damped, shaken = plan(stabiliser=True), plan(stabiliser=False)

    def shake_rad(path):
        pairs = [(path.pose(t), still.pose(t)) for t in path.grid(300)]
        turns = [rotations.rodrigues_from_rotation(a[:, :3] @ b[:, :3].T) for a, b in pairs]
        return np.sqrt(np.mean(np.square(turns)))

    assert shake_rad(shaken) / shake_rad(damped) == pytest.approx(5, rel=1e-6)
    assert np.degrees(shake_rad(shaken)) == pytest.approx(0.5, abs=0.2)
    np.testing.assert_allclose(centres(damped, 20), centres(shaken, 20), atol=1e-9)


def test_a_faster_walk_shakes_more():
    slow, usual, fast = (
        angular_rms(plan(speed_kmh=speed, stabiliser=False)) for speed in (1, 2, 6)
    )
    assert 1.5 < usual / slow < 2.2 and 2.5 < fast / usual < 3.2


def test_only_a_stabiliser_moves_the_principal_point():
    path = plan(size=(2560, 1440))
    points = np.array([path.camera(time_s).K[:2, 2] for time_s in np.arange(0, 2000, 0.5)])
    np.testing.assert_allclose(points.mean(0), path.K[:2, 2], atol=0.2)
    np.testing.assert_allclose(points.std(0), 2 * PLAIN.stabiliser_px, rtol=0.1)
    speed_px_s = np.abs(np.diff(points, axis=0)).max() / 0.5
    assert speed_px_s < 3 * 2 * PLAIN.stabiliser_px, "slowly"
    bare = plan(stabiliser=False)
    assert (bare.camera(0.0).K == bare.K).all() and (bare.camera(17.0).K == bare.K).all()


def test_the_walked_camera_has_a_lens_of_its_own():
    path = plan()
    assert not any((path.K == camera.K).all() for camera in fixed())
    np.testing.assert_array_equal(path.grid(5), path.duration_s * np.array([0, 0.25, 0.5, 0.75, 1]))


def test_the_same_seed_gives_the_same_walk_and_another_seed_another():
    one, same, other = plan(seed=1), plan(seed=1), plan(seed=2)
    assert (one.pose(3.3) == same.pose(3.3)).all()
    assert np.abs(one.pose(3.3) - other.pose(3.3)).max() > 1e-3


def test_an_impossible_walk_is_refused():
    with pytest.raises(ValueError, match="two cameras and a speed"):
        plan(speed_kmh=0)
    with pytest.raises(ValueError, match="two cameras"):
        walk_path.plan(fixed()[:1], COURT, SIZE, PLAIN, np.random.default_rng(0))
