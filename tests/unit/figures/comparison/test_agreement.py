"""The figure of agreement: measures from best to worst, limits in detectable changes."""

import numpy as np
import pandas as pd

from courtside.figures.comparison import agreement
from courtside.statistics import agreement as exchange

NETWORKS = ("old", "new")
NOISE = {"a": 0.1, "b": 0.4, "c": 0.9, "d": 2.0, "e": 5.0}


def made():
    rng = np.random.default_rng(0)
    rows = []
    for name, noise in NOISE.items():
        for subject in ("p1", "p2", "p3", "p4"):
            for repeat in range(5):
                first = rng.normal(10, 1)
                second = first + rng.normal(0, noise)
                rows.append((subject, "s", f"{subject}-{repeat}", name, "m", "", first, second))
    pairs = pd.DataFrame(rows, columns=exchange.PAIRS)
    return pairs, exchange.compare(pairs, NETWORKS)


def test_measures_shown_run_from_the_best_to_the_worst():
    _, table = made()
    shuffled = table.sample(frac=1, random_state=1)
    assert agreement.choose(shuffled, 3) == ["a", "c", "e"]
    assert agreement.choose(shuffled, 9) == list("abcde")


def test_written_tables_are_read_back(tmp_path):
    pairs, table = made()
    pairs.to_csv(tmp_path / "p.csv", index=False)
    table.to_csv(tmp_path / "t.csv", index=False)
    again = agreement.read(tmp_path / "p.csv", tmp_path / "t.csv")
    pd.testing.assert_frame_equal(again[0], pairs, check_dtype=False)
    pd.testing.assert_frame_equal(again[1], table, check_dtype=False)


def test_points_and_limits_are_drawn_at_the_tables_values():
    pairs, table = made()
    drawing = agreement.draw(pairs, table, NETWORKS)
    shown = agreement.choose(table)
    *panels, summary = drawing.axes
    assert len(panels) == len(shown)
    panel = panels[shown.index("b")]
    own = pairs[(pairs["measure"] == "b") & (pairs["subject"] == "p1")]
    np.testing.assert_allclose(panel.lines[0].get_ydata(), own["second"] - own["first"])
    np.testing.assert_allclose(panel.lines[0].get_xdata(), (own["second"] + own["first"]) / 2)
    row = table.set_index("measure").loc["b"]
    flat = {float(line.get_ydata()[0]) for line in panel.lines if len(set(line.get_ydata())) == 1}
    assert {row["bias"], row["lower"], row["upper"]} <= flat
    labels = [text.get_text() for text in summary.get_yticklabels()]
    assert labels == list("abcde")
    segments = [s for c in summary.collections for s in getattr(c, "get_segments", list)()]
    wide = row["upper"] / row["detectable"]
    assert any(np.isclose(s[:, 0].max(), wide) and s[0, 1] == 1 for s in segments)


def panel_of(pairs, measure):
    table = exchange.compare(pairs, NETWORKS)
    axes = agreement.draw(pairs, table, NETWORKS).axes
    return axes[agreement.choose(table).index(measure)]


def points_of(panel):
    return [line for line in panel.lines if line.get_marker() in agreement.MARKERS]


def test_every_difference_lies_in_its_panel():
    pairs, _ = made()
    at = pairs.index[pairs["measure"] == "a"][7]
    pairs.loc[at, "second"] += 30
    for measure in ("a", "e"):
        panel = panel_of(pairs, measure)
        low, high = panel.get_ylim()
        drawn = np.concatenate([line.get_ydata() for line in points_of(panel)])
        assert len(drawn) == 20
        assert low < drawn.min() and drawn.max() < high


def test_subjects_with_too_few_repeats_are_hollow():
    pairs, _ = made()
    few = pairs[(pairs["subject"] == "p2") & pairs["take"].isin(["p2-0", "p2-1"])]
    panel = panel_of(pd.concat([pairs, few.assign(subject="p0")]), "a")
    faces = [line.get_markerfacecolor() for line in points_of(panel)]
    assert faces == ["white", *["#444444"] * 4]


def test_a_session_with_too_few_repeats_is_hollow_beside_another_of_the_subject():
    pairs, _ = made()
    few = pairs[(pairs["subject"] == "p2") & pairs["take"].isin(["p2-0", "p2-1"])]
    panel = panel_of(pd.concat([pairs, few.assign(session="later")]), "a")
    faces = {(line.get_marker(), line.get_markerfacecolor()) for line in points_of(panel)}
    assert {(agreement.MARKERS[1], "white"), (agreement.MARKERS[1], "#444444")} <= faces
    assert sum(face == "white" for _, face in faces) == 1


def test_limits_beyond_the_axis_have_arrows():
    pairs, table = made()
    for name, reach in (("lower", 8.5), ("upper", 9), ("upper_to", 10)):
        table.loc[table["measure"] == "e", name] = reach * table["detectable"]
    summary = agreement.draw(pairs, table, NETWORKS).axes[-1]
    ends = [c.get_offsets().tolist() for c in summary.collections if hasattr(c, "get_sizes")]
    assert [tuple(at) for points in ends for at in points] == [(agreement.FURTHEST, 4)]
