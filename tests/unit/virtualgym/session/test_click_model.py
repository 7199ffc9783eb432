"""How well points are clicked follows from what the picture shows: by hand, from the geometry."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import court
from fixtures.cameras import scene
from virtualgym import presets
from virtualgym.session import click_model

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
PLAIN, RICH = presets.PRESETS["plain"], presets.PRESETS["rich"]


def camera(at, towards=(3, 6.7, 0)):
    made = scene.ring(1)[0]
    return replace(made, dist=np.zeros(5), cam_from_world=scene.look_at(at, towards))


def covariance(seen_by, points, preset=PLAIN, of=COURT):
    return click_model.covariance(seen_by, COURT.xyz[COURT.indices(points)], of, preset)


def test_a_point_seen_from_above_scatters_alike_to_all_sides():
    """Wide lines that cross at a right angle: their edges, their noise and the hand."""
    above = camera((0.5, 0.4, 4), (0.5, 0.5, 0))
    by_noise = click_model.BLUR_PX * PLAIN.noise_sigma / click_model.STEP
    edge = click_model.EDGE_PX**2 + by_noise**2 / click_model.ALONG_PX
    hand = click_model.HAND_PX_AT_3840 * above.size[0] / 3840
    found = covariance(above, ["p01"])[0]
    np.testing.assert_allclose(found, (edge + hand**2) * np.eye(2), rtol=0.02, atol=0.002)


def test_a_line_seen_flat_and_noise_make_clicks_worse():
    near, far = camera((3.05, -6, 6)), camera((3.05, -12, 1.5))
    size = {
        (at, preset.name): np.trace(covariance(seen_by, ["p03"], preset)[0])
        for at, seen_by in (("near", near), ("far", far))
        for preset in (PLAIN, RICH)
    }
    assert size["far", "plain"] > 1.2 * size["near", "plain"]
    assert size["far", "plain"] > 1.05 * size["far", "rich"]


def test_clicks_scatter_along_edges_that_cross_at_a_small_angle():
    """From the court's corner, low: both lines are nearly level in the picture."""
    oblique = camera((-9, -5, 1.5))
    (found,) = covariance(oblique, ["p16"])
    assert found[0, 0] > 4 * found[1, 1]
    longest = click_model.LONGEST * oblique.size[0]
    assert found[0, 0] < 1.1 * longest**2


def test_points_behind_the_net_are_clicked_worse():
    """From 12 m behind the court and 4 m high the net hides floor from y = 11.3 to 18.5 m."""
    low, high = camera((3.05, -12, 2.0)), camera((3.05, -12, 4.0))
    assert not click_model.behind_net(low, COURT.xyz, COURT).any()
    hidden = click_model.behind_net(high, COURT.xyz, COURT)
    assert set(np.array(COURT.points)[hidden]) == {"p03", "p13", "p15", "p16"}
    without = replace(COURT, net=None)
    behind, free = (covariance(high, COURT.points, of=each) for each in (COURT, without))
    ratio = behind[:, 0, 0] / free[:, 0, 0]
    assert ratio[hidden] == pytest.approx(click_model.THROUGH_NET**2)
    assert ratio[~hidden] == pytest.approx(1)
