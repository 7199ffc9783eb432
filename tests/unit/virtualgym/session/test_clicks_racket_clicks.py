"""Clicked ends of rackets, against exact projection at the time of their row."""

import csv
from dataclasses import replace

import numpy as np

from fixtures.cameras import scene
from virtualgym import presets
from virtualgym.session import clicks as racket_clicks

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


def clicks(preset, athletes=HOLDERS, n_frames=5, seed=0):
    times_s = 0.2 + np.arange(n_frames) / 30 / n_frames
    rng = np.random.default_rng(seed)
    return times_s, racket_clicks.of_camera(athletes, [CAMERA] * n_frames, times_s, preset, rng)


def test_sure_clicks_are_where_the_rolling_shutter_shows_the_ends():
    times_s, found = clicks(SURE)
    assert [each[:3] for each in found[:3]] == [
        ("c0", 0, "top"),
        ("c0", 0, "butt"),
        ("c0", 1, "top"),
    ]
    for _, index, end, xy in found:
        part = racket_clicks.ENDS.index(end)
        own_s = times_s[index] + ((xy[1] + 0.5) / 1080 - 0.5) * SURE.readout_s
        expected = scene.opencv_projection(CAMERA, Holder().racket(own_s)[[part]])[0]
        np.testing.assert_allclose(xy, expected, atol=0.02)
        still = scene.opencv_projection(CAMERA, Holder().racket(times_s[index])[[part]])[0]
        assert np.abs(xy - still).max() > 0.5


def test_clicks_scatter_as_stated_about_one_habit():
    sigma, bias = 4.0, 3.0
    preset = replace(SURE, click_sigma_px_at_3840=sigma, click_bias_px_at_3840=bias)
    truth = np.array([each[3] for each in clicks(SURE, n_frames=300)[1]])
    means = []
    for seed in range(6):
        noisy = np.array([each[3] for each in clicks(preset, n_frames=300, seed=seed)[1]])
        error = (noisy - truth) * 3840 / 1920
        np.testing.assert_allclose(error.std(axis=0), sigma, rtol=0.08)
        means.append(error.mean(axis=0))
    assert 0.5 * bias < np.std(means) < 1.7 * bias


def test_who_has_no_racket_and_what_is_out_of_sight_is_not_clicked():
    assert clicks(SURE, athletes=[Empty()])[1] == []
    far = np.array([10.0])
    assert racket_clicks.of_camera([Holder()], [CAMERA], far, SURE, np.random.default_rng(0)) == []


def test_the_table_has_a_row_for_each_click(tmp_path):
    _, found = clicks(SURE)
    racket_clicks.write(tmp_path / "racket.csv", "shot", found)
    with (tmp_path / "racket.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == len(found) == 10
    assert list(rows[0]) == ["take", "camera", "frame_idx", "end", "x_px", "y_px"]
    assert (rows[3]["take"], rows[3]["frame_idx"], rows[3]["end"]) == ("shot", "1", "butt")
    assert abs(float(rows[3]["x_px"]) - found[3][3][0]) < 1e-3
    racket_clicks.write(tmp_path / "none.csv", "shot", [])
    assert (tmp_path / "none.csv").read_text() == "take,camera,frame_idx,end,x_px,y_px\n"
