"""Errors of a stereo depth camera: noise by its formula, steps, range, shadows, edges."""

from dataclasses import replace

import numpy as np
import pytest

from virtualgym.devices import depth_noise
from virtualgym.devices.depth_noise import DepthErrors

SIZE = (320, 240)
SOME = DepthErrors(
    focal_baseline=600 * 0.055, subpixel_px=0.08, correlation_px=0.0, unit_m=1e-4,
    range_m=(0.3, 20.0), edge_px=1.5, edge_holes=0.0, holes=0.0,
)  # fmt: skip


def wall(depth_m):
    return np.full(SIZE[::-1], depth_m, np.float32)


def measured(depth_m, errors=SOME, seed=0):
    sensor = depth_noise.Sensor(errors, SIZE, np.random.default_rng(seed))
    return sensor.measured(depth_m, np.random.default_rng(seed + 1))


def seen(depth):
    """Return depth without the band that the right imager does not see, float."""
    return depth[:, 140:].astype(float)


@pytest.mark.parametrize("correlation_px", [0.0, 1.5])
@pytest.mark.parametrize("away_m", [1.0, 2.0, 4.0])
def test_noise_grows_with_the_square_of_depth(away_m, correlation_px):
    errors = replace(SOME, correlation_px=correlation_px)
    found = seen(measured(wall(away_m), errors)) * SOME.unit_m
    sigma_m = away_m**2 * 0.08 / (600 * 0.055)
    slack = 0.02 if correlation_px == 0 else 0.08
    assert found.std() == pytest.approx(sigma_m, rel=slack)
    assert found.mean() == pytest.approx(away_m, abs=0.1 * sigma_m + 2 * sigma_m**2 / away_m)


def test_errors_are_alike_in_neighbours_as_block_matching_makes_them():
    for correlation_px, expected in ((0.0, 0.0), (1.5, np.exp(-1 / (4 * 1.5**2)))):
        found = seen(measured(wall(2.0), replace(SOME, correlation_px=correlation_px))) - 2e4
        alike = (found[:, 1:] * found[:, :-1]).mean() / found.var()
        assert alike == pytest.approx(expected, abs=0.05)


def test_noise_differs_between_frames_and_repeats_with_the_generator():
    sensor = depth_noise.Sensor(SOME, SIZE, np.random.default_rng(0))
    one, two, again = (
        seen(sensor.measured(wall(2.0), np.random.default_rng(k))) for k in (1, 2, 1)
    )
    np.testing.assert_array_equal(one, again)
    assert abs(np.corrcoef(one.ravel(), two.ravel())[0, 1]) < 0.02


def test_depth_comes_in_steps_and_only_in_range():
    exact = replace(SOME, subpixel_px=0.0, unit_m=0.001)
    ramp = np.tile(np.linspace(2.0, 2.01, SIZE[0], dtype=np.float32), (SIZE[1], 1))
    found = seen(measured(ramp, exact))
    np.testing.assert_array_equal(found, np.rint(seen(ramp) / np.float32(0.001)))
    for away_m in (0.25, 25.0, np.inf):
        assert not measured(wall(away_m), exact).any()
    assert not measured(wall(19.0), replace(exact, unit_m=1e-4)).any(), "more than 16 bits hold"


def test_what_the_right_imager_cannot_see_has_no_depth():
    scene = wall(6.0)
    scene[60:180, 150:250] = 1.5
    found = measured(scene, replace(SOME, subpixel_px=0.0))
    far_px, near_px = SOME.focal_baseline / 6.0, SOME.focal_baseline / 1.5
    shadow = near_px - far_px  # of the wall, left of the near thing
    row = found[120]
    hole = np.flatnonzero(row[50:150] == 0) + 50
    assert len(hole) == pytest.approx(shadow, abs=1) and hole.max() == 149
    assert (row[150:] > 0).all(), "nothing on its right"
    assert (found[30, round(far_px) + 1 :] > 0).all(), "nothing above it"
    np.testing.assert_array_equal(found[30, : int(far_px) - 1], 0)


def test_hidden_points_are_those_of_a_search_along_the_row():
    rng = np.random.default_rng(4)
    disparity = rng.uniform(0, 30, (5, 60)).astype(np.float32)
    place = np.arange(60) - disparity
    brute = np.array(
        [
            [p < -0.5 or any(q <= p for q in row[k + 1 :]) for k, p in enumerate(row)]
            for row in place
        ]
    )
    np.testing.assert_array_equal(depth_noise.hidden(disparity), brute)


def test_holes_have_their_share_at_edges_and_elsewhere():
    scene = wall(4.0)
    scene[:, 200:] = 1.6
    errors = replace(SOME, edge_px=3.0, edge_holes=0.6, holes=0.02, subpixel_px=0.0)
    sensor = depth_noise.Sensor(errors, SIZE, np.random.default_rng(0))
    none = np.mean(
        [sensor.measured(scene, np.random.default_rng(k)) == 0 for k in range(40)], axis=0
    )
    assert none[:, 201:203].mean() == pytest.approx(0.6, abs=0.04)
    assert none[:, 230:].mean() == pytest.approx(0.02, abs=0.006)
    assert ((none[:, 230:] > 0) & (none[:, 230:] < 1)).mean() > 0.2, "they flicker"


def test_edges_reach_as_far_as_stated():
    disparity = np.zeros((41, 41), np.float32)
    disparity[20, 20] = 5
    found = depth_noise.edges(disparity, 2.0)
    rows, columns = np.indices(found.shape)
    ends = [(20, 20), (19, 20), (21, 20), (20, 19), (20, 21)]
    near = np.min([np.hypot(rows - r, columns - c) for r, c in ends], axis=0) <= 2.0
    np.testing.assert_array_equal(found, near)
    assert not depth_noise.edges(np.tile(np.arange(41) * 0.5, (41, 1)), 2.0).any(), "a slope"
