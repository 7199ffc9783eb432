"""Common times and interpolation: clocks with offset and drift, gaps, dropped frames."""

import numpy as np
import pytest

from courtside.reconstruction import resampling
from courtside.records.devices.clocks import Clock
from fixtures.cameras import sync_takes

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


def test_common_times_are_what_two_cameras_share():
    views = [view(np.arange(300) / 30), view(np.arange(300) / 30)]
    # The second camera's clock showed 4 s when the first one's showed 0: its frames start at -4 s.
    time_s = resampling.common_times(views, [Clock(), Clock(offset_s=4.0)])
    assert time_s[0] == pytest.approx(0.0)
    assert time_s[-1] == pytest.approx(299 / 30 - 4.0)
    np.testing.assert_allclose(np.diff(time_s), 1 / 30)


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
