"""Proposed court points in drawn pictures, from cameras some pixels off, against exact places."""

import cv2
import numpy as np
import pytest

from courtside.calibration.click_proposals import proposals, refine_pose
from courtside.geometry import camera as cameras
from fixtures.cameras import court_pictures

SIZE, F = (1280, 720), 1150.0


@pytest.fixture(scope="module")
def court():
    return court_pictures.badminton()


@pytest.fixture(scope="module")
def views():
    return court_pictures.pair(SIZE, F)


@pytest.fixture(scope="module")
def pictures(views, court):
    return [court_pictures.draw(view, court, noise=4, seed=1) for view in views]


def off(camera, court, wanted_px, seed):
    """Return a camera turned, moved and zoomed so that the court is about `wanted_px` off in it."""
    change = np.random.default_rng(seed).normal(0, 1, 8) * refine_pose.PRIOR_SIGMA
    exact = cameras.project(camera, court.xyz)

    def shift(scale):
        moved = refine_pose.moved(camera, scale * change)
        return np.nanmedian(np.linalg.norm(cameras.project(moved, court.xyz) - exact, axis=1))

    return refine_pose.moved(camera, wanted_px / shift(1e-3) * 1e-3 * change)


def inside(xy, margin=3):
    return ((xy > margin) & (xy < np.array(SIZE) - margin)).all(axis=1)


@pytest.mark.parametrize(("view", "seed"), [(0, 0), (1, 1)])
def test_points_are_proposed_to_half_a_pixel(views, pictures, court, view, seed):
    camera = off(views[view], court, 3.0, seed)
    found = proposals.propose(camera, pictures[view], court, search_px=9.0)
    exact = cameras.project(views[view], court.xyz)
    error = np.linalg.norm(found.xy - exact, axis=1)
    given = np.isfinite(error)
    assert given.sum() >= inside(exact, 12).sum() - 2
    assert np.median(error[given]) < 0.3
    assert error[given].max() < 1.2
    assert np.sqrt(np.mean((error[given] / found.sigma_px[given]) ** 2) / 2) < 2
    assert (found.confidence[given] > 0.3).all() and (found.confidence[~given] == 0).all()
    assert [bool(reason) for reason in found.reason] == (~given).tolist()
    assert not given[~inside(exact, 0)].any()


def test_a_hidden_point_is_not_proposed(views, court):
    mats = [(-0.8, 4.0, 0.8, 5.3), (2.6, -0.4, 3.5, 0.4)]  # on p04 and p12
    picture = court_pictures.draw(views[0], court, noise=2, hidden=mats)
    found = proposals.propose(off(views[0], court, 1.5, 0), picture, court, search_px=6.0)
    hidden = court.indices(["p04", "p12"])
    assert np.isnan(found.xy[hidden]).all()
    assert all("not seen" in found.reason[at] for at in hidden)
    assert np.isfinite(found.xy[court.indices(["p01", "p05", "p08", "p16"])]).all()


def test_without_lines_nothing_is_proposed(views, court):
    rng = np.random.default_rng(0)
    picture = rng.normal(120, 8, (*SIZE[::-1], 3)).astype(np.uint8)
    found = proposals.propose(views[0], picture, court, search_px=8.0)
    assert np.isnan(found.xy).all()
    assert set(found.reason) == {"too few painted lines are seen where they are expected"}


def test_dark_lines_are_asked_for(views, pictures, court):
    found = proposals.propose(views[0], 255 - pictures[0], court, search_px=4.0, lines="dark")
    error = np.linalg.norm(found.xy - cameras.project(views[0], court.xyz), axis=1)
    assert np.isfinite(error).sum() > 12 and np.nanmedian(error) < 0.3


def test_the_picture_must_be_the_camera_s(views, pictures, court):
    with pytest.raises(ValueError, match="expected a picture of"):
        proposals.propose(views[0], pictures[0][:-1], court, search_px=4.0)


def test_a_camera_that_other_lines_fit_by_chance_gives_no_points(views, court):
    """A floor with lines everywhere: near any expected one lies another, half the search away."""
    rng = np.random.default_rng(0)
    picture = np.full((*SIZE[::-1], 3), 120, np.uint8)
    for _ in range(40):
        ends = rng.uniform([-200, 0], [SIZE[0] + 200, SIZE[1]], (2, 2)).astype(int).tolist()
        width = int(rng.integers(2, 6))
        cv2.line(picture, *ends, color=(230, 230, 230), thickness=width, lineType=cv2.LINE_AA)
    picture = np.clip(picture + rng.normal(0, 4, picture.shape), 0, 255).astype(np.uint8)
    found = proposals.propose(views[0], picture, court, search_px=24.0)
    assert np.isnan(found.xy).all()
    (reason,) = set(found.reason)
    assert "from where an adjusted camera expects them" in reason
