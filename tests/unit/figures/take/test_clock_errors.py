"""Clock errors: intervals with and without the truth, unused clocks, one row or sixty."""

import numpy as np
import pandas as pd
import pytest

from courtside.figures.take import clock_errors


def row(camera="back", error_ms=1.0, sigma_ms=2.0, status="found", take="footwork", **changes):
    return {
        "session": "players-b",
        "take": take,
        "calibration": "sfm-n40",
        "model": "blazepose-full",
        "camera": camera,
        "status": status,
        "worst_error_ms": error_ms,
        "sigma_ms": sigma_ms,
        **changes,
    }


def made():
    return pd.DataFrame(
        [
            row("mirror", 3.3),  # 1.65 standard deviations
            row("back", -3.28),  # 1.64
            row("front", 700.0, np.nan, "ambiguous"),
            row("back", 90.0, take="rally"),
        ]
    )


def test_an_interval_of_90_percent_is_1645_standard_deviations_wide():
    rows = clock_errors.table(made()).set_index(["take", "camera"])
    assert rows["holds"].to_dict() == {
        ("footwork", "back"): "yes",
        ("footwork", "front"): "unused",
        ("footwork", "mirror"): "no",
        ("rally", "back"): "no",
    }
    back = rows.loc[("footwork", "back")]
    assert (back["lower_ms"], back["upper_ms"]) == (pytest.approx(-6.57), pytest.approx(0.01))
    assert back["worst_error_mm"] == pytest.approx(-39.36)  # 12 mm in a millisecond


def test_the_title_counts_used_clocks_only():
    title = clock_errors.draw(clock_errors.table(made())).get_suptitle()
    assert title.startswith("1 of 3 intervals of 90 % hold the truth (33 %)")
    assert "largest error 90.0 ms; 2 of 3 within 8 ms" in title and "1 not determined" in title
    none = clock_errors.draw(clock_errors.table(made().iloc[2:3])).get_suptitle()
    assert none == "none of 1 clocks is determined by its recording"


def test_dots_and_intervals_are_drawn_at_their_errors():
    rows = clock_errors.table(made())
    axis = clock_errors.draw(rows).axes[0]
    dots = [line for line in axis.lines if line.get_marker() == "o"]
    drawn = {(x, y) for line in dots for x, y in line.get_xydata()}
    assert drawn == {(-3.28, 0), (3.3, 2)}
    spans = [s for c in axis.collections for s in getattr(c, "get_segments", list)()]
    assert any(np.allclose(s[:, 0], [-6.57, 0.01]) and s[0, 1] == 0 for s in spans)
    assert {text.get_text() for text in axis.texts} == {"90 ms", "700 ms"}
    names = [text.get_text() for text in axis.get_yticklabels()]
    assert names[0] == "players-b footwork back" and len(names) == 4


def test_millimetres_are_twelve_times_milliseconds():
    drawing = clock_errors.draw(clock_errors.table(made()))
    drawing.draw_without_rendering()
    axis = drawing.axes[0]
    above = axis.child_axes[0]
    assert above.get_xlim() == pytest.approx([12 * x for x in axis.get_xlim()])


@pytest.mark.parametrize("count", [1, 60])
def test_each_clock_has_a_line_for_one_or_sixty_clocks(count):
    rows = clock_errors.table(
        pd.DataFrame([row(f"c{at:02d}", at / 10, model=f"net-{at % 2}") for at in range(count)])
    )
    axis = clock_errors.draw(rows).axes[0]
    names = [text.get_text() for text in axis.get_yticklabels()]
    assert len(set(names)) == count
    assert all("net-" in name for name in names) == (count > 1)
