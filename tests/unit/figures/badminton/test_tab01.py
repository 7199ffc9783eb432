"""Table 1 beside the published values: order, means, what each panel shows."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from courtside.figures.badminton import tab01

PUBLISHED = pd.read_csv(Path(__file__).parents[4] / "config" / "published" / "badminton_tab01.csv")


def rows(truth=50.0, left_out=9.0):
    values = {
        "exact": ("mm", 1e-12),
        "rounded": ("mm", 2.5),
        "rounded_published": ("mm", 1.2),
        "reprojection": ("px", 6.0),
        "left_out": ("px", left_out),
        "truth": ("mm", truth),
    }
    made = [
        (person, count, cameras, row, joint, unit, value + at, 0.3, 17, "17 frames")
        for person in ("p1", "p2")
        for count, cameras in ((3, "a+b+c"), (2, "a+b"))
        for row, (unit, value) in values.items()
        for at, joint in enumerate(("left_wrist", "nose", "all"))
    ]
    names = ["person", "n_cameras", "cameras", "row", "joint", "unit", "mean", "sd", "n", "over"]
    return pd.DataFrame(made, columns=names)


def test_published_values_stand_beside_in_their_order():
    table = tab01.table(rows(), PUBLISHED)
    assert list(dict.fromkeys(table["joint"])) == [*PUBLISHED["joint"], "nose", "all"]
    theirs = table[table["row"] == "published"].set_index("joint")
    assert len(theirs) == 15
    assert theirs.loc["left_wrist", ["mean", "sd", "n"]].tolist() == [3.0, 0.85, 17]
    assert theirs.loc["all", "mean"] == pytest.approx(2.72, abs=0.005)
    assert theirs.loc["all", "sd"] == pytest.approx(0.81, abs=0.005)
    assert set(table["person"]) == {"p1", ""}


def test_panels_hold_their_rows():
    drawing = tab01.draw(tab01.table(rows(), PUBLISHED), "take")
    rounding, pixels, true = drawing.axes
    at = 7  # the left wrist
    lines = [line.get_xdata() for line in rounding.lines if len(line.get_xdata()) == 16]
    drawn = [places[at] for places in lines]
    assert sorted(x for x in drawn if np.isfinite(x)) == [1.2, 1.2, 2.5, 2.5, 3.0]
    assert {line.get_xdata()[at] for line in true.lines if len(line.get_xdata()) == 16} == {50.0}
    assert pixels.get_title().endswith("(px)")
    assert rounding.get_xlim()[1] > 3.19
    assert "identity" in drawing.get_suptitle()
    words = [text.get_text() for text in drawing.legends[0].get_texts()]
    assert words == ["2 cameras: a, b", "3 cameras: a, b, c", "published, 2 cameras"]


def test_a_real_session_is_marked_as_without_truth():
    drawing = tab01.draw(tab01.table(rows(truth=np.nan), PUBLISHED))
    assert [text.get_text() for text in drawing.axes[-1].texts] == ["no truth:\na real session"]


def test_errors_of_very_different_size_are_drawn_logarithmically():
    drawing = tab01.draw(tab01.table(rows(left_out=400.0), PUBLISHED))
    assert [axis.get_xscale() for axis in drawing.axes] == ["linear", "log", "linear"]
