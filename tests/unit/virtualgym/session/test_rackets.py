"""Rackets: clicks of their ends by frame; swings: their length, their heights, where they go."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import court
from courtside.geometry import camera as cameras
from fixtures.cameras import scene
from virtualgym import presets
from virtualgym.cameras import layouts
from virtualgym.session import rackets

# Clicked ends of rackets, against exact projection at the time of their row.

CAMERA = scene.ring(1)[0]
SURE = replace(presets.PLAIN, click_sigma_px_at_3840=0.0, click_bias_px_at_3840=0.0, readout_s=0.04)


class Holder:
    """Somebody whose racket flies on a straight line."""

    has_racket = True

    def racket(self, time_s):
        top = np.array([0.3, -0.4, 1.9]) + np.array([6.0, -4.0, 1.0]) * time_s
        return np.stack([top, top - [0.2, 0.1, 0.6]])


HOLDERS = (Holder(),)


class Empty(Holder):
    has_racket = False

    def racket(self, time_s):
        return np.full((2, 3), np.nan)


def racket_clicks(preset, athletes=HOLDERS, n_frames=5, seed=0):
    times_s = 0.2 + np.arange(n_frames) / 30 / n_frames
    rng = np.random.default_rng(seed)
    return times_s, rackets.of_camera(athletes, [CAMERA] * n_frames, times_s, preset, rng)


def test_sure_clicks_are_where_the_rolling_shutter_shows_the_ends():
    times_s, found = racket_clicks(SURE)
    assert [each[:3] for each in found[:3]] == [
        ("c0", 0, "top"),
        ("c0", 0, "butt"),
        ("c0", 1, "top"),
    ]
    for _, index, end, xy in found:
        part = rackets.ENDS.index(end)
        own_s = times_s[index] + ((xy[1] + 0.5) / 1080 - 0.5) * SURE.readout_s
        expected = scene.opencv_projection(CAMERA, Holder().racket(own_s)[[part]])[0]
        np.testing.assert_allclose(xy, expected, atol=0.02)
        still = scene.opencv_projection(CAMERA, Holder().racket(times_s[index])[[part]])[0]
        assert np.abs(xy - still).max() > 0.5


def test_clicks_scatter_as_stated_about_one_habit():
    sigma, bias = 4.0, 3.0
    preset = replace(SURE, click_sigma_px_at_3840=sigma, click_bias_px_at_3840=bias)
    truth = np.array([each[3] for each in racket_clicks(SURE, n_frames=300)[1]])
    means = []
    for seed in range(6):
        noisy = np.array([each[3] for each in racket_clicks(preset, n_frames=300, seed=seed)[1]])
        error = (noisy - truth) * 3840 / 1920
        np.testing.assert_allclose(error.std(axis=0), sigma, rtol=0.08)
        means.append(error.mean(axis=0))
    assert 0.5 * bias < np.std(means) < 1.7 * bias


def test_who_has_no_racket_and_what_is_out_of_sight_is_not_clicked():
    assert racket_clicks(SURE, athletes=[Empty()])[1] == []
    far = np.array([10.0])
    assert rackets.of_camera([Holder()], [CAMERA], far, SURE, np.random.default_rng(0)) == []


def test_the_table_has_a_row_for_each_click(tmp_path):
    _, found = racket_clicks(SURE)
    rackets.write(tmp_path / "racket.csv", "shot", found)
    with (tmp_path / "racket.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == len(found) == 10
    assert list(rows[0]) == ["take", "camera", "frame_idx", "end", "x_px", "y_px"]
    assert (rows[3]["take"], rows[3]["frame_idx"], rows[3]["end"]) == ("shot", "1", "butt")
    assert abs(float(rows[3]["x_px"]) - found[3][3][0]) < 1e-3
    rackets.write(tmp_path / "none.csv", "shot", [])
    assert (tmp_path / "none.csv").read_text() == "take,camera,frame_idx,end,x_px,y_px\n"


# Swings of a racket: its length, its heights, where it goes, and clicks that can be paired.

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
LENGTH_M = 0.674
RUNS = range(200)


def swings():
    return np.array([rackets.swing_of_run(COURT, LENGTH_M, seed=3, run=run) for run in RUNS])


def fixed(layout="a", size=(1280, 720)):
    rng = np.random.default_rng(0)
    return layouts.fixed_cameras(layout, COURT, size, presets.PLAIN, rng)


def click_swing(views, ends, *, sigma=0.7, again=False, seed=3, run=0):
    return rackets.click_racket(
        views, ends, sigma_px_at_3840=sigma, again=again, seed=seed, run=run
    )


def test_the_racket_is_as_long_as_asked_in_every_frame():
    ends = swings()
    length = np.linalg.norm(ends[..., 0, :] - ends[..., 1, :], axis=-1)
    np.testing.assert_allclose(length, LENGTH_M, atol=1e-12)


def test_a_swing_passes_the_height_of_the_net_between_frames_10_and_11():
    height = swings().mean(axis=2)[..., 2]
    assert (np.diff(height, axis=1) > 0).all()
    assert (height[:, :10] < 1.524).all() and (height[:, 10:] > 1.524).all()
    assert height.shape == (200, 21)


def test_a_swing_stays_above_the_floor_in_one_half_of_the_court_and_in_every_picture():
    ends = swings()
    assert ends[..., 2].min() > 0.3 and ends[..., 2].max() < 3.0
    middle = ends.mean(axis=2)
    assert (middle[..., 0] > 0).all() and (middle[..., 0] < 6.1).all()
    assert (middle[..., 1] > 0).all() and (middle[..., 1] < 6.7).all()
    for layout in ("a", "b"):
        for camera in fixed(layout):
            xy = cameras.project(camera, ends)
            assert ((xy > 0) & (xy < camera.size)).all()


def test_swings_point_in_all_directions_of_the_compass():
    along = swings()[..., 0, :] - swings()[..., 1, :]
    heading = np.histogram(np.arctan2(along[..., 1], along[..., 0]), bins=8, range=(-np.pi, np.pi))
    assert heading[0].min() > 0.05 * heading[0].sum()


def test_runs_and_seeds_differ_and_the_same_run_is_the_same():
    one = rackets.swing_of_run(COURT, LENGTH_M, seed=3, run=5)
    np.testing.assert_array_equal(one, swings()[5])
    for other in (swings()[6], rackets.swing_of_run(COURT, LENGTH_M, seed=4, run=5)):
        assert np.abs(one - other).max() > 0.05


def test_click_errors_differ_in_size_only_and_are_new_when_clicked_again():
    """At a third of 3840 px, errors are a third as large, for each level in proportion."""
    ends, views = swings()[0], fixed()
    exact = {view.name: cameras.project(view, ends.reshape(-1, 3)) for view in views}
    fine, coarse = click_swing(views, ends), click_swing(views, ends, sigma=1.4)
    anew, other = click_swing(views, ends, again=True), click_swing(views, ends, run=1)
    for name, xy in exact.items():
        assert np.std(fine[name] - xy) == pytest.approx(0.7 / 3, rel=0.25)
        np.testing.assert_allclose(coarse[name] - xy, 2 * (fine[name] - xy), atol=1e-9)
        for changed in (anew, other):
            relation = np.corrcoef((changed[name] - xy).ravel(), (fine[name] - xy).ravel())
            assert abs(relation[0, 1]) < 0.4
