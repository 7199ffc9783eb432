"""Cameras adjusted with people: recovered within the stated error, the frame kept, k3 kept."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration import point_covariance
from courtside.calibration.bundle import conversion
from courtside.calibration.court.court import read
from courtside.calibration.people import adjustment, prior
from courtside.calibration.people.adjustment import Clicks
from courtside.calibration.people.views import Limits, joined
from courtside.geometry import camera as cameras
from courtside.geometry.similarity import umeyama
from courtside.geometry.triangulation import triangulate_all
from fixtures import remembered_calls
from fixtures.cameras import corner_cameras, walkers

TRUE = corner_cameras.four_cameras()
LIMITS = Limits(score=0.05, limit=0.05, fade=0.067)
KNOWN = prior.stated(
    TRUE, rotation_deg=0.3, position_m=0.03, focal_percent=0.5, principal_point_percent=0.3, k1=0.01
)
WALK = walkers.joints(48)


@pytest.fixture(scope="module", autouse=True)
def adjusted_once():
    """Adjust the same cameras with the same views only once."""
    with remembered_calls.of((adjustment, "refine")):
        yield


def refined(seed, clicks=None, **how):
    """Return disturbed cameras, and the same refined by a walk."""
    base = walkers.disturbed(TRUE, KNOWN, seed)
    seen = walkers.seen(TRUE, WALK, seed=seed, **how)
    return base, adjustment.refine(base, seen, prior.knowledge(base, KNOWN), LIMITS, clicks)


def off(found):
    """Return how far joints are off, m: as they are, and after the best similarity."""
    exact = np.stack([cameras.project(one, WALK.reshape(-1, 3)) for one in TRUE])
    xyz, true = triangulate_all(found, exact), WALK.reshape(-1, 3)
    return tuple(
        float(np.sqrt(((placed - true) ** 2).sum(axis=1).mean()))
        for placed in (xyz, umeyama(xyz, true).points(xyz))
    )


def spread(found):
    """Return the stated variance, m2, of a point in the middle of the room."""
    network = conversion.network_of(found.cameras)
    middle = np.array([[0, 0, 1.0]])
    return np.trace(point_covariance.point_covariance(network, found.covariance, middle)[0])


def test_disturbed_cameras_agree_again_and_their_errors_are_as_stated():
    free = np.diag(prior.knowledge(TRUE, KNOWN).information) > 0
    ratios, gains = [], []
    for seed in range(4):
        base, found = refined(seed)
        step = conversion.network_of(found.cameras).difference(conversion.network_of(TRUE))[free]
        covariance = found.covariance[np.ix_(free, free)]
        ratios.append(step @ np.linalg.solve(covariance, step) / free.sum())
        gains.append(off(found.cameras)[1] / off(base)[1])
        assert found.sigma_share == pytest.approx(np.full(10, 0.004), rel=0.25)
        assert found.alike < 1.6
    # The mean of a chi-squared of 160 degrees of freedom, over these: 1 +- 0.11.
    assert 0.7 < np.mean(ratios) < 1.35
    assert np.mean(gains) < 0.25


def test_people_leave_position_direction_and_scale_to_the_given_calibration():
    base, found = refined(3)
    before = np.stack([camera.centre_in_world for camera in base])
    after = np.stack([camera.centre_in_world for camera in found.cameras])
    # The mean place of all cameras is not seen by people: it stays, though each moves.
    assert np.linalg.norm(after.mean(axis=0) - before.mean(axis=0)) < 0.015
    assert np.linalg.norm(after - before, axis=1).max() > 0.015


def test_wild_views_do_not_matter():
    _, found = refined(1, wild=0.1)
    _, clean = refined(1)
    assert off(found.cameras)[1] < 1.6 * off(clean.cameras)[1] + 1e-3


def test_court_points_place_the_frame():
    rng = np.random.default_rng(0)
    xyz = np.array([[x, y, 0.0] for x in (-2, 0, 2) for y in (-2, 0, 2)])
    xy = np.stack([cameras.project(one, xyz) for one in TRUE])
    xy += rng.normal(0, 1.0, xy.shape)
    clicks = Clicks(xyz, np.full(9, 1e-3), xy, np.ones((4, 1, 1)), np.zeros(4), 4.0)
    _, without = refined(2)
    _, found = refined(2, clicks)
    assert off(found.cameras)[0] < 0.004 < off(without.cameras)[0]
    stated = replace(clicks, sigma_px=np.full((4, 1, 1), 3.0))  # three times what they scatter
    _, wide = refined(2, stated)
    assert spread(wide) == pytest.approx(spread(found), rel=0.5)
    _, biased = refined(2, replace(clicks, bias_px=np.full(4, 1.0)))
    assert spread(biased) > 2 * spread(found)
    assert np.isnan(clicks.of(np.arange(9) < 4).xy[:, 4:]).all()


def test_clicks_of_a_court_are_as_certain_as_their_pictures_are_wide():
    court = read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
    marked = {camera.name: np.full((len(court.points), 2), 7.0) for camera in TRUE}
    weights = {"click_sigma_px": 2.5, "click_bias_px": 1.25, "click_loss": 4.0}
    found = adjustment.court_clicks(court, marked, TRUE, **weights)
    raised = court.xyz[:, 2] > 0  # no edges of lines cross there
    assert (found.sigma_px[:, raised] == 1.25).all()
    assert found.sigma_px.shape == (4, len(court.points), 2)
    assert found.bias_px.tolist() == [0.625] * 4
    assert found.xy.shape == (4, len(court.points), 2) and found.loss_scale == 4.0


def test_views_that_err_alike_count_less():
    base = walkers.disturbed(TRUE, KNOWN, 0)
    seen = walkers.seen(TRUE, WALK, seed=0)
    shift = np.random.default_rng(5).normal(size=(4, 1, 10, 2))
    shifted = replace(seen, xy=seen.xy + 0.01 * seen.height_px[:, :, None, None] * shift)
    found = adjustment.refine(base, shifted, prior.knowledge(base, KNOWN), LIMITS)
    assert found.alike > 8


def test_more_persons_whose_joints_err_alike_make_no_joint_more_certain():
    """A network errs alike of all persons: their errors do not average out."""
    base, shift = walkers.disturbed(TRUE, KNOWN, 0), np.random.default_rng(5)
    shift = 0.01 * shift.normal(size=(4, 1, 10, 2))
    parts = [walkers.seen(TRUE, WALK[at : at + 24], seed=at) for at in (0, 24)]
    parts = [replace(part, xy=part.xy + part.height_px[..., None, None] * shift) for part in parts]
    one, two = (
        adjustment.refine(base, seen, prior.knowledge(base, KNOWN), LIMITS)
        for seen in (parts[0], joined(parts))
    )
    assert two.alike > 1.5 * one.alike
    assert spread(two) > 0.8 * spread(one)


def test_k3_of_a_lens_is_kept_and_heeded():
    bent = [replace(one, dist=np.array([-0.05, 0.1, 0, 0, 0.4])) for one in TRUE]
    seen = walkers.seen(bent, WALK)
    found = adjustment.refine(bent, seen, prior.knowledge(bent, KNOWN), LIMITS)
    assert [camera.dist[4] for camera in found.cameras] == [0.4] * 4
    assert np.mean([abs(c.dist[0] + 0.05) for c in found.cameras]) < 0.01
    exact = np.stack([cameras.project(one, WALK.reshape(-1, 3)) for one in bent])
    xyz = triangulate_all(found.cameras, exact)
    assert np.linalg.norm(xyz - WALK.reshape(-1, 3), axis=1).mean() < 0.004
