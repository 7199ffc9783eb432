"""What windows of a long take show, against lines whose quantiles and rates are known."""

from pathlib import Path

import numpy as np
import pytest

from courtside.figures.style import style, windows

WORKFLOW = Path(__file__).parents[4] / "workflow"
TIMES = -0.5 + np.arange(6000) / 10  # 600 s


@pytest.mark.parametrize(
    ("whole_s", "length_s"), [(0, 0), (120, 0), (121, 5), (600, 10), (601, 15), (3600, 60)]
)
def test_windows_are_as_long_as_the_take_needs(whole_s, length_s):
    assert windows.length_s(np.array([7.3, 7.3 + whole_s])) == length_s
    assert windows.length_s(np.array([])) == 0


def test_a_window_has_its_median_in_the_band_of_its_quantiles():
    axis = style.figure(50).subplots()
    values = np.tile(np.arange(100.0), 60) + 1000 * (TIMES >= 299)
    windows.draw(axis, TIMES, values, 10, colour="black", label="a")
    (line,) = axis.lines
    assert line.get_xdata()[:3].tolist() == [4, 14, 24]  # from -1 s on, the last whole one before
    assert line.get_ydata()[1:-1].tolist() == [49.5] * 29 + [1049.5] * 30
    band = axis.collections[0].get_paths()[0].vertices[:, 1]
    assert (band.min(), band.max()) == pytest.approx(
        (4.7, 1094.05)
    )  # the first window has 95 frames


def test_a_window_of_which_less_than_half_is_known_is_left_out():
    values = np.where((TIMES >= 18) & (TIMES < 24.5), np.nan, 1.0)
    found = windows.known(TIMES, values, 10).mean()
    assert found.loc[14] == 1 and np.isnan(found.loc[24]) and found.loc[34] == 1


def test_events_are_counted_by_the_time_in_which_somebody_is_seen():
    at_s = np.arange(0.25, 599, 0.5)  # 120 a minute
    seen = (TIMES < 199) | (TIMES >= 303)
    there = at_s[(at_s < 199) | (at_s >= 303)]
    found = windows.a_minute(there, TIMES, seen, 10)
    assert found.loc[14:194].tolist() == pytest.approx([120] * 19)
    assert found.loc[204:294].isna().all()
    assert found.loc[304] == pytest.approx(120, rel=0.1)
    assert windows.a_minute(there[:0], TIMES, seen, 10).max() == 0


def test_captions_say_that_long_takes_are_drawn_otherwise():
    figures = (WORKFLOW / "lib" / "courtside" / "figures" / "take").glob("*.py")
    names = {path.stem for path in figures if "windows.length_s" in path.read_text()}
    assert names >= {"kinematics", "footwork", "rally", "visibility"}
    for name in names:
        caption = (WORKFLOW / "report" / f"draw_{name}.rst").read_text()
        assert "of a take of more than two minutes" in " ".join(caption.lower().split()), name
