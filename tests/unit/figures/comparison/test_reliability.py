"""The figure of stated errors: sessions are added up, every stage has its column."""

import numpy as np
import pandas as pd
import pytest

from courtside.evaluation import reliability as counting
from courtside.figures.comparison import reliability


def made():
    rows = []
    for session, n in (("a", 100), ("b", 300)):
        for stage in ("pose3d", "pose3d_corrected"):
            for by, group in (("all", "limbs"), ("joint", "knee"), ("views", "2"), ("error", "0")):
                held = {f"held_{level}": int(n * level / 100) for level in counting.LEVELS}
                held["held_90"] = 50 if session == "a" else 290
                flags = {"n_large": 10, "n_flagged": 5, "n_flagged_large": 4}
                about = {"session": session, "calibration": "file", "model": "first"}
                rows.append(
                    {**about, "stage": stage, "by": by, "group": group, "n": n, **held, **flags}
                )
    return pd.DataFrame(rows)


def test_a_second_network_of_a_session_does_not_count_its_joints_twice():
    again = made().query("session == 'b'").assign(model="another", held_90=0)
    rows = reliability.table(pd.concat([made(), again]))
    whole = rows[rows["by"] == "all"].fillna({"model": ""})
    held = whole.groupby(["session", "model"])["held_90_percent"].first()
    expected = {("a", "first"): 50, ("all", ""): 85, ("b", "another"): 0, ("b", "first"): 290 / 3}
    assert held.to_dict() == pytest.approx(expected)
    left, _, *_ = reliability.draw(rows).axes
    assert sum(line.get_color() == "#cccccc" for line in left.lines) == 3


def test_a_second_calibration_of_a_session_does_not_count_its_joints_twice():
    again = made().query("session == 'b'").assign(calibration="known18", held_90=0)
    rows = reliability.table(pd.concat([made(), again]))
    whole = rows[rows["by"] == "all"].fillna({"calibration": ""})
    held = whole.groupby(["session", "calibration"])["held_90_percent"].first()
    expected = {("a", "file"): 50, ("all", ""): 85, ("b", "file"): 290 / 3, ("b", "known18"): 0}
    assert held.to_dict() == pytest.approx(expected)


def test_all_sessions_together_are_weighted_by_their_joints():
    rows = reliability.table(made())
    whole = rows[(rows["session"] == "all") & (rows["by"] == "all")].set_index("stage")
    assert (whole["n"] == 400).all() and np.allclose(whole["held_90_percent"], 100 * 340 / 400)
    assert np.allclose(whole["precision_percent"], 80) and np.allclose(whole["recall_percent"], 40)
    one = rows[(rows["session"] == "a") & (rows["by"] == "all")]
    assert np.allclose(one["held_90_percent"], 50)


def test_the_figure_draws_what_the_table_says():
    rows = reliability.table(made())
    drawing = reliability.draw(rows)
    assert len(drawing.axes) == 3 * 2
    titles = [axis.get_title() for axis in drawing.axes if axis.get_title()]
    flags = "80 % of flags are right,\n40 % of large errors flagged"
    assert titles == [f"{w}\n90 % ellipsoids hold 85 %\n{flags}" for w in ("raw", "corrected")]
    (line,) = (line for line in drawing.axes[0].lines if line.get_label() == "knee")
    at = counting.LEVELS.index(90)
    assert np.ravel(line.get_ydata())[at] == 85
