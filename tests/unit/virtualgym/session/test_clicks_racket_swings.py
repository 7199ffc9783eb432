"""Swings of a racket: its length, its heights, where it goes, and clicks that can be paired."""

from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import court
from courtside.geometry import camera as cameras
from virtualgym import presets
from virtualgym.cameras import layouts
from virtualgym.session import clicks

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
LENGTH_M = 0.674
RUNS = range(200)


def swings():
    return np.array([clicks.draw(COURT, LENGTH_M, seed=3, run=run) for run in RUNS])


def fixed(layout="a", size=(1280, 720)):
    rng = np.random.default_rng(0)
    return layouts.fixed_cameras(layout, COURT, size, presets.PLAIN, rng)


def click(views, ends, *, sigma=0.7, again=False, seed=3, run=0):
    return clicks.click(views, ends, sigma_px_at_3840=sigma, again=again, seed=seed, run=run)


def test_the_racket_is_as_long_as_asked_in_every_frame():
    ends = swings()
    length = np.linalg.norm(ends[..., 0, :] - ends[..., 1, :], axis=-1)
    np.testing.assert_allclose(length, LENGTH_M, atol=1e-12)


def test_it_passes_the_height_of_the_net_between_frames_10_and_11():
    height = swings().mean(axis=2)[..., 2]
    assert (np.diff(height, axis=1) > 0).all()
    assert (height[:, :10] < 1.524).all() and (height[:, 10:] > 1.524).all()
    assert height.shape == (200, 21)


def test_it_stays_above_the_floor_in_one_half_of_the_court_and_in_every_picture():
    ends = swings()
    assert ends[..., 2].min() > 0.3 and ends[..., 2].max() < 3.0
    middle = ends.mean(axis=2)
    assert (middle[..., 0] > 0).all() and (middle[..., 0] < 6.1).all()
    assert (middle[..., 1] > 0).all() and (middle[..., 1] < 6.7).all()
    for layout in ("a", "b"):
        for camera in fixed(layout):
            xy = cameras.project(camera, ends)
            assert ((xy > 0) & (xy < camera.size)).all()


def test_it_points_in_all_directions_of_the_compass():
    along = swings()[..., 0, :] - swings()[..., 1, :]
    heading = np.histogram(np.arctan2(along[..., 1], along[..., 0]), bins=8, range=(-np.pi, np.pi))
    assert heading[0].min() > 0.05 * heading[0].sum()


def test_runs_and_seeds_differ_and_the_same_run_is_the_same():
    one = clicks.draw(COURT, LENGTH_M, seed=3, run=5)
    np.testing.assert_array_equal(one, swings()[5])
    for other in (swings()[6], clicks.draw(COURT, LENGTH_M, seed=4, run=5)):
        assert np.abs(one - other).max() > 0.05


def test_click_errors_differ_in_size_only_and_are_new_when_clicked_again():
    """At a third of 3840 px, errors are a third as large, for each level in proportion."""
    ends, views = swings()[0], fixed()
    exact = {view.name: cameras.project(view, ends.reshape(-1, 3)) for view in views}
    fine, coarse = click(views, ends), click(views, ends, sigma=1.4)
    anew, other = click(views, ends, again=True), click(views, ends, run=1)
    for name, xy in exact.items():
        assert np.std(fine[name] - xy) == pytest.approx(0.7 / 3, rel=0.25)
        np.testing.assert_allclose(coarse[name] - xy, 2 * (fine[name] - xy), atol=1e-9)
        for changed in (anew, other):
            relation = np.corrcoef((changed[name] - xy).ravel(), (fine[name] - xy).ravel())
            assert abs(relation[0, 1]) < 0.4
