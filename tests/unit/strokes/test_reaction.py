"""Reactions: the opponent's split step and first step after a stroke, with their sigmas."""

import numpy as np
import pandas as pd
import pytest

from courtside.footwork import feet
from courtside.records import strokes, tables
from courtside.strokes import reaction
from fixtures.people import walker, walking_feet

COLUMNS = ["person", "event", "start_s", "start_sigma_s", "stop_s", "stop_sigma_s"]


def hits(*rows):
    return pd.DataFrame(rows, columns=["person", "time_s", "sigma_s"])


def events(*rows):
    made = [(who, what, start, 0.01, stop, 0.02) for who, what, start, stop in rows]
    return pd.DataFrame(made, columns=COLUMNS)


def test_intervals_run_from_the_hit_to_the_landing_and_to_the_first_step_after_it():
    feet = events(
        ("b", "step", 0.5, 0.7), ("b", "split_step", 1.05, 1.2), ("b", "step", 1.45, 1.7),
        ("b", "lunge", 1.8, 2.0), ("a", "step", 1.1, 1.3),
    )  # fmt: skip
    (row,) = reaction.join(hits(("a", 1.0, 0.03)), feet).to_dict("records")
    assert (row["person"], row["opponent"]) == ("b", "a")
    assert row["to_split_s"] == pytest.approx(0.2)
    assert row["to_split_sigma_s"] == pytest.approx(np.hypot(0.03, 0.02))
    assert row["to_step_s"] == pytest.approx(0.45)
    assert row["split_to_step_s"] == pytest.approx(0.25)
    assert row["split_to_step_sigma_s"] == pytest.approx(np.hypot(0.02, 0.01))


def test_without_a_split_step_the_first_step_counts_from_the_hit():
    (row,) = reaction.join(hits(("a", 1.0, 0.03)), events(("b", "step", 1.3, 1.5))).to_dict(
        "records"
    )
    assert row["to_step_s"] == pytest.approx(0.3)
    assert np.isnan([row["to_split_s"], row["split_to_step_s"]]).all()


def test_a_split_step_may_land_just_before_the_stroke():
    feet = events(("b", "split_step", 0.8, 0.95), ("b", "step", 1.2, 1.5))
    (row,) = reaction.join(hits(("a", 1.0, 0.03)), feet).to_dict("records")
    assert row["to_split_s"] == pytest.approx(-0.05)
    assert row["split_to_step_s"] == pytest.approx(0.25)
    early = events(("b", "split_step", 0.7, 0.85), ("b", "step", 1.2, 1.5))
    assert np.isnan(reaction.join(hits(("a", 1.0, 0.03)), early).to_split_s[0])


def test_a_written_table_is_read_again(tmp_path):
    feet = events(("b", "split_step", 1.05, 1.2), ("b", "step", 1.45, 1.7))
    rows = reaction.join(hits(("a", 1.0, 0.03)), feet)
    tables.write(tmp_path / "reactions.csv", rows)
    again = strokes.read_reactions(tmp_path / "reactions.csv")
    pd.testing.assert_frame_equal(again, rows, rtol=1e-5, check_dtype=False)


def test_what_comes_after_the_next_stroke_or_too_late_is_no_reaction():
    feet = events(("b", "step", 1.8, 2.0), ("b", "split_step", 3.5, 3.7))
    rows = reaction.join(hits(("a", 1.0, 0.03), ("b", 1.6, 0.03), ("a", 2.2, 0.03)), feet)
    assert rows.opponent.tolist() == ["a", "a"]
    assert rows.to_step_s.isna().all()
    assert rows.to_split_s.isna().all()


def test_the_interval_from_a_simulated_hop_to_the_first_step_is_in_its_90_percent_interval():
    points, _ = walking_feet.record(walking_feet.hop(), 3.0, seed=8)
    found = feet.find(points, walking_feet.CUTOFFS)[2]
    row = reaction.join(hits(("opponent", 0.7, 0.02)), found).iloc[0]
    error_s = row.split_to_step_s - (1.6 - 1.0)
    assert abs(error_s) < 0.04
    assert abs(error_s) < 1.645 * row.split_to_step_sigma_s
    assert row.to_step_s == pytest.approx(0.9, abs=0.03)


def test_in_doubles_only_who_is_beyond_the_net_reacts():
    four = walker.points(n_frames=60, n_persons=4)
    y_m = np.array([2.0, 5.5, 9.0, 11.0])[:, None, None]
    four.xyz[..., 1] = y_m
    four.xyz[3] = np.nan  # of whom nobody knows the half
    names = four.person_id.tolist()
    feet = events(*((name, "split_step", 1.05, 1.2) for name in names))
    for hitter, reacts in ((0, [2]), (1, [2]), (2, [0, 1]), (3, [])):
        rows = reaction.join(hits((names[hitter], 1.0, 0.03)), feet, four, 6.7)
        assert rows.person.tolist() == [names[at] for at in reacts]
    unnetted = reaction.join(hits((names[0], 1.0, 0.03)), feet, four, None)
    assert unnetted.person.tolist() == names[1:]


def test_of_two_the_other_reacts_though_nobody_knows_the_half():
    two = walker.points(n_frames=60, n_persons=2)
    first, other = two.person_id.tolist()
    feet = events((first, "split_step", 1.05, 1.2), (other, "split_step", 1.05, 1.2))
    for y_m, reacts in ((9.0, [other]), (np.nan, [other]), (3.0, [])):
        two.xyz[..., 1] = np.array([2.0, y_m])[:, None, None]
        rows = reaction.join(hits((first, 1.0, 0.03)), feet, two, 6.7)
        assert rows.person.tolist() == reacts


def test_alone_nobody_reacts():
    feet = events(("a", "step", 1.3, 1.5))
    rows = reaction.join(hits(("a", 1.0, 0.03)), feet)
    assert not len(rows)
    assert list(rows.columns) == strokes.REACTION_COLUMNS
