"""Soft shadows: how dark they are, where they fall, and that pixels see them there."""

import numpy as np
import pytest

from fixtures.cameras import balls
from virtualgym.rendering import shadows

LEFT = 1 - shadows.LAMPS[:, 2].sum()  # the light that no lamp gives
VERTICES, TRIANGLES = balls.sphere(70)


def disc(height_m, radius_m=0.8, place=(2.0, 3.0)):
    """Return the vertices of a thin, level, closed disc."""
    return VERTICES * [radius_m, radius_m, 0.01] + [*place, height_m]


def at(shadow, x, y):
    column, row = np.rint((np.array([x, y]) - shadow.corner_m) / shadows.CELL_M).astype(int)
    return shadow.light[row, column]


def test_a_lid_on_the_floor_takes_away_the_lamps_and_nothing_far_off():
    shadow = shadows.cast(disc(0.02), TRIANGLES)
    assert at(shadow, 2.0, 3.0) == pytest.approx(LEFT, abs=0.02)
    assert at(shadow, 2.5, 3.0) == pytest.approx(LEFT, abs=0.03)
    assert shadow.light[0].min() == shadow.light[:, 0].min() == pytest.approx(1.0, abs=1e-4)
    lost_m2 = (1 - shadow.light.astype(float)).sum() * shadows.CELL_M**2
    assert lost_m2 == pytest.approx((1 - LEFT) * np.pi * 0.8**2, rel=0.04)


def test_a_higher_thing_casts_a_softer_shadow_beside_itself():
    low, high = (shadows.cast(disc(z, 0.5), TRIANGLES) for z in (0.02, 1.4))
    steep = [np.abs(np.diff(shadow.light, axis=0)).max() for shadow in (low, high)]
    assert steep[1] < 0.4 * steep[0]
    for shadow, height_m in ((low, 0.02), (high, 1.4)):
        lost = 1 - shadow.light.astype(float)
        rows, columns = np.indices(lost.shape)
        middle = np.array([(columns * lost).sum(), (rows * lost).sum()]) / lost.sum()
        found = shadow.corner_m + middle * shadows.CELL_M
        share = shadows.LAMPS[:, 2] / shadows.LAMPS[:, 2].sum()
        expected = np.array([2.0, 3.0]) - height_m * share @ shadows.LAMPS[:, :2]
        np.testing.assert_allclose(found, expected, atol=0.02)


def test_rays_see_the_light_where_they_meet_the_floor():
    shadow = shadows.cast(disc(0.02, 0.6), TRIANGLES)
    eye = np.array([0.0, -4.0, 2.0])
    floor = np.array([[2.0, 3.0, 0.0], [2.3, 2.8, 0.0], [2.0, 3.6, 0.0], [9.0, 9.0, 0.0]])
    direction = (floor - eye).T.reshape(3, 1, 4).astype(np.float32) * 0.37
    upward = np.float32([0, 1, 0.2]).reshape(3, 1, 1)
    seen = shadow.seen(eye, np.concatenate([direction, upward], axis=2))[0]
    assert seen[:2] == pytest.approx(LEFT, abs=0.02)
    assert seen[2] == pytest.approx((1 + LEFT) / 2, abs=0.06), "half of it at the edge"
    assert seen[3:].tolist() == [1.0, 1.0]


def test_the_outline_holds_the_whole_shadow():
    shadow = shadows.cast(disc(1.9, 0.4), TRIANGLES)
    rows, columns = shadow.light.shape
    low, high = shadow.outline().min(axis=0), shadow.outline().max(axis=0)
    np.testing.assert_allclose(low[:2], shadow.corner_m)
    np.testing.assert_allclose((high - low)[:2] / shadows.CELL_M, [columns, rows])
    border = np.concatenate(
        [shadow.light[0], shadow.light[-1], shadow.light[:, 0], shadow.light[:, -1]]
    )
    assert border.min() > 0.995, "it does not end suddenly"
