"""Common times and interpolation: clocks with offset and drift, gaps, dropped frames."""

import numpy as np
import pytest

from courtside.reconstruction import resampling
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import keypoints as record
from fixtures.cameras import sync_takes
from fixtures.people import performers
from virtualgym.body import stance

CAMERA = sync_takes.rig(1)[0]
PERSON = sync_takes.athlete(np.random.default_rng(0), 20.0)


def view(time_s, clock=None):
    return sync_takes.seen(
        np.random.default_rng(1),
        CAMERA,
        [PERSON],
        time_s,
        clock or Clock(),
        noise_px=0.0,
        bias_px=0.0,
        faults=False,
    )


def test_gaps_in_2d_are_not_bridged():
    keypoints = view(np.arange(10) / 60)
    keypoints.xy[0, 5] = np.nan
    xy, score = resampling.resample(keypoints, np.arange(20) / 120, Clock())
    assert np.isnan(xy[0, 9:12]).all()
    assert np.isnan(score[0, 9:12]).all()
    assert np.isfinite(xy[0, :9]).all()


def test_a_dropped_frame_is_a_gap():
    time_s = np.delete(np.arange(10) / 60, [4, 5])
    xy, _ = resampling.resample(view(time_s), np.arange(10) / 60, Clock())
    assert np.isnan(xy[0, 4:6]).all()
    assert np.isfinite(np.delete(xy[0], [4, 5], axis=0)).all()


@pytest.mark.parametrize(("rate_hz", "whole"), [(60, True), (50, True), (30, False)])
def test_a_dark_stretch_at_half_the_rate_is_bridged_up_to_45_ms(rate_hz, whole):
    """In seconds: what a camera of 30 Hz does all the time is good enough for one of 60 Hz."""
    steps = np.r_[np.ones(20), np.full(10, 2), np.ones(20)] / rate_hz
    time_s = np.concatenate([[0], np.cumsum(steps)])
    own = np.arange(61) / rate_hz
    xy, score = resampling.resample(view(time_s), own, Clock())
    assert np.isfinite(xy[0, 20:41:2]).all()
    assert np.isfinite(xy[0, 21:41:2]).all() == np.isfinite(score[0, 21:41:2]).all() == whole
    assert np.isnan(xy[0, 21:41:2]).all() == (not whole)


def test_wrists_at_a_stroke_in_a_dark_stretch_err_less_than_keypoints():
    """Virtual players: 60 Hz that drops to 30 for a while; keypoints err by some 20 mm."""
    found_mm = []
    for seed in range(3):
        motion = performers.perform("shot", seed)
        hit_s = motion.events["hit"]
        bright_s = hit_s - 0.2 - np.arange(60)[::-1] / 60
        time_s = np.concatenate([bright_s, bright_s[-1] + np.arange(1, 40) / 30])
        at_s = hit_s + np.arange(-0.25, 0.15, 1 / 240)
        wrist = [mm(motion, each) for each in (time_s, at_s)]
        keypoints = view(time_s)
        keypoints.xy[:] = wrist[0][:, np.newaxis]
        xy, _ = resampling.resample(keypoints, at_s, Clock())
        found_mm.append(np.linalg.norm(xy[0, :, 0] - wrist[1], axis=-1))
    found_mm = np.concatenate(found_mm)
    assert np.sqrt((found_mm**2).mean()) < 4 and found_mm.max() < 15


def mm(motion, time_s):
    """Return the wrist of the racket's arm, (T, 2) mm: to the side and up."""
    joints = [stance.joints(motion.stance(each), performers.BODY) for each in time_s]
    return 1000 * np.array([one["right_wrist"][[0, 2]] for one in joints])


def test_a_parabola_is_met_exactly_where_the_rate_changes():
    """And beside a dropped frame: the outer frames are not as far as the inner ones."""
    time_s = np.cumsum(np.r_[0, np.ones(6), 2, 2, 1, 2, np.ones(6)] / 60)
    keypoints = view(time_s)
    keypoints.xy[:] = (500 * time_s**2 - 300 * time_s)[None, :, None, None]
    at_s = np.arange(8, 8 * 19 - 8) / 480
    xy, _ = resampling.resample(keypoints, at_s, Clock())
    true = 500 * at_s**2 - 300 * at_s
    np.testing.assert_allclose(xy[0], np.broadcast_to(true[:, None, None], xy[0].shape), atol=1e-9)


def test_noise_of_frames_close_together_is_no_speed_across_a_gap():
    """At 240 Hz a gap of 42 ms: a cubic through its neighbours would double the noise."""
    keypoints = view(np.r_[np.arange(20), 29 + np.arange(20)] / 240)
    rng, found = np.random.default_rng(0), []
    for _ in range(100):
        keypoints.xy[:] = rng.normal(0, 1, keypoints.xy.shape)
        found.append(resampling.resample(keypoints, np.array([24 / 240]), Clock())[0])
    assert np.std(found) == pytest.approx(np.sqrt(0.5), abs=0.05)  # half-way between two


def test_equal_clocks_pass_through_unchanged():
    keypoints = view(np.arange(30) / 29.97)
    time_s = resampling.common_times([keypoints, keypoints], [Clock(), Clock()])
    np.testing.assert_array_equal(time_s[0], 0.0)
    xy, _ = resampling.resample(keypoints, keypoints.time_s, Clock())
    np.testing.assert_array_equal(xy, keypoints.xy)


def test_a_clock_that_is_ahead_and_fast_is_read_at_its_own_times():
    clock = Clock(offset_s=1.2345, drift_ppm=200.0)
    own_s = np.arange(1200) / 60
    time_s = 2.0 + np.arange(500) / 30
    found, _ = resampling.resample(view(own_s, clock), time_s, clock)
    truth = view(time_s).xy
    assert (
        np.abs(found - truth).max() < 2.0
    )  # the lines between frames; 10 ms off are ten times that
    wrong, _ = resampling.resample(view(own_s, clock), time_s, Clock(offset_s=1.2345 + 0.01))
    assert np.abs(wrong - truth).max() > 3.0


def test_blocks_of_frames_have_no_borders(monkeypatch):
    clock, time_s = Clock(offset_s=1.2345, drift_ppm=200.0), 2.0 + np.arange(50) / 30
    seen = [view(np.arange(200) / 60, clock), view(np.arange(100) / 30)]
    whole = resampling.resample_all(seen, [clock, Clock()], time_s)
    monkeypatch.setattr(record, "BLOCK", 7)
    for part, expected in zip(
        resampling.resample_all(seen, [clock, Clock()], time_s), whole, strict=True
    ):
        np.testing.assert_array_equal(part, expected)


def test_common_times_are_what_two_cameras_share():
    views = [view(np.arange(300) / 30), view(np.arange(300) / 30)]
    # The second camera's clock showed 4 s when the first one's showed 0: its frames start at -4 s.
    time_s = resampling.common_times(views, [Clock(), Clock(offset_s=4.0)])
    assert time_s[0] == pytest.approx(0.0)
    assert time_s[-1] == pytest.approx(299 / 30 - 4.0)
    np.testing.assert_allclose(np.diff(time_s), 1 / 30)


def test_times_that_one_camera_films_alone_are_not_common():
    """The first camera films before and after all others, of which two overlap."""
    views = [view(np.arange(n) / 30) for n in (60, 300, 300)]
    clocks = [Clock(), Clock(offset_s=-20.0), Clock(offset_s=-25.0)]
    time_s = resampling.common_times(views, clocks)
    assert time_s[0] == pytest.approx(25.0)
    assert time_s[-1] == pytest.approx(20.0 + 299 / 30)


def test_cameras_that_never_film_together_have_no_common_times():
    """`association.everybody` refuses them in one line."""
    views = [view(np.arange(300) / 30) for _ in range(3)]
    clocks = [Clock(), Clock(offset_s=-45.0), Clock(offset_s=70.0)]
    assert len(resampling.common_times(views, clocks)) == 0


@pytest.mark.parametrize("rate_hz", [30, 60])
def test_times_of_a_container_that_keeps_milliseconds_have_the_rate_of_the_frames(rate_hz):
    """At 60 Hz most intervals are 17 ms: as a step they would be 58.8 Hz, away from the frames."""
    keypoints = view(np.round(np.arange(300) / rate_hz, 3))
    time_s = resampling.common_times([keypoints, keypoints], [Clock(), Clock()])
    assert len(time_s) == 300
    np.testing.assert_allclose(time_s, np.arange(300) / rate_hz, atol=5e-4)


def test_a_parabola_between_frames_is_met_exactly_and_beside_a_gap_by_a_line():
    """Keypoints that are accelerated: a line between frames is off by a h^2 / 8 in the middle."""
    keypoints = view(np.arange(12) / 30)
    keypoints.xy[:] = (500 * keypoints.time_s**2)[None, :, None, None]
    middle = (np.arange(11) + 0.5) / 30
    xy, _ = resampling.resample(keypoints, middle, Clock())
    error = xy[0, :, 0, 0] - 500 * middle**2
    line = 500 * 2 / 30**2 / 8
    np.testing.assert_allclose(error[1:-1], 0, atol=1e-9)
    np.testing.assert_allclose(error[[0, -1]], line, atol=1e-9)
    keypoints.xy[0, 5] = np.nan
    xy, _ = resampling.resample(keypoints, middle, Clock())
    error = xy[0, :, 0, 0] - 500 * middle**2
    assert np.isnan(error[[4, 5]]).all()
    np.testing.assert_allclose(error[[3, 6]], line, atol=1e-9)


def test_the_nearest_frames_are_taken_by_the_cameras_own_clock():
    keypoints = view(np.arange(30) / 30)
    clock = Clock(offset_s=0.5, drift_ppm=1000.0)
    found = resampling.nearest(keypoints, np.array([0.0, 0.1, 0.21]), clock)
    assert found.tolist() == [15, 18, 21]
