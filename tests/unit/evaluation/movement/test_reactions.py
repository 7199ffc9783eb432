"""Errors of split steps and of reactions: found, missed, false, cut, and their sizes."""

from types import SimpleNamespace

import numpy as np
import pandas as pd

from courtside.evaluation.movement import reactions
from courtside.records import footwork
from courtside.strokes import reaction

SPAN = (0.0, 10.0)
TRUTH = SimpleNamespace(
    person_id=np.array(["a", "b"]),
    events={
        "a": {
            "hit_1": 2.0,
            "hit_2": 5.0,
            "split_1_start": 0.9,
            "split_1_stop": 1.0,
            "first_step_1": 1.2,  # a shuttle is fed
            "split_2_start": 3.5,
            "split_2_stop": 3.6,
            "first_step_2": 3.8,
        },
        "b": {
            "hit_1": 3.5,
            "hit_2": 6.5,
            "split_1_start": 2.0,
            "split_1_stop": 2.15,
            "first_step_1": 2.35,
            "first_step_2": 5.4,  # without a split step
        },
    },
)


def events(*rows):
    """Return split steps and steps (person, event, start, stop), each 10 ms uncertain."""
    made = [(who, what, "both", start, 0.01, stop, 0.01) for who, what, start, stop in rows]
    return pd.DataFrame(made, columns=footwork.EVENT_COLUMNS[:7])


def hits(*rows):
    return pd.DataFrame(rows, columns=["person", "time_s"]).assign(sigma_s=0.02)


TRUE_HITS = hits(("a", 2.0), ("b", 3.5), ("a", 5.0), ("b", 6.5))
TRUE_FEET = (
    ("a", "split_step", 0.9, 1.0), ("a", "step", 1.2, 1.5), ("a", "split_step", 3.5, 3.6),
    ("a", "step", 3.8, 4.0), ("b", "split_step", 2.0, 2.15), ("b", "step", 2.35, 2.6),
    ("b", "step", 5.4, 5.6),
)  # fmt: skip


def compared(strokes, feet):
    return reactions.table(reaction.join(strokes, feet), feet, TRUTH, SPAN)


def test_an_answer_belongs_to_the_opponents_last_hit_or_to_nobodys():
    found = reactions.answers(TRUTH, "a")
    np.testing.assert_allclose(found.hit_s, [np.nan, 3.5])
    np.testing.assert_allclose(reactions.answers(TRUTH, "b").split_stop_s, [2.15, np.nan])


def test_what_is_measured_as_it_was_has_no_error():
    rows = compared(TRUE_HITS, events(*TRUE_FEET))
    assert (rows.result == "found").all()
    assert rows.what.value_counts().to_dict() == {
        "split_step": 3,
        "to_step": 3,
        "to_split": 2,
        "split_to_step": 2,
    }
    np.testing.assert_allclose(rows.error_ms, 0, atol=1e-9)
    assert rows.within_90_percent.all()


def test_errors_are_found_less_true_and_judged_by_their_sigma():
    late = [(*row[:3], row[3] + 0.03) if row[1] == "split_step" else row for row in TRUE_FEET]
    rows = compared(TRUE_HITS, events(*late))
    error = rows.set_index("what").error_ms
    np.testing.assert_allclose(error["split_step"], 30)
    np.testing.assert_allclose(error["to_split"], 30)
    np.testing.assert_allclose(error["split_to_step"], -30)
    np.testing.assert_allclose(error["to_step"], 0, atol=1e-9)
    within = rows.set_index("what").within_90_percent
    assert not within["split_step"].any()  # 30 ms of 10 ms
    assert within["to_split"].all()  # of 22 ms


def test_missed_and_false_split_steps_are_told_apart():
    without = [row for row in TRUE_FEET if row[:2] != ("b", "split_step")]
    rows = compared(TRUE_HITS, events(*without, ("b", "split_step", 5.0, 5.15)))
    splits = rows[rows.what == "split_step"]
    assert splits.result.value_counts().to_dict() == {"found": 2, "missed": 1, "false": 1}
    intervals = rows[rows.what == "split_to_step"].set_index("hit_s").result
    assert intervals[2.0] == "missed"
    assert intervals[5.0] == "false"


def test_a_missed_hit_is_not_counted_twice_and_the_ends_are_cut():
    rows = compared(TRUE_HITS[TRUE_HITS.time_s != 3.5], events(*TRUE_FEET))
    assert 3.5 not in rows[rows.what == "to_step"].hit_s.tolist()
    short = reactions.table(
        reaction.join(TRUE_HITS, events(*TRUE_FEET)), events(*TRUE_FEET), TRUTH, (0.9, 5.5)
    )
    cut = short[short.result == "cut"]
    assert set(cut.what) == {"split_step", "to_step"}
    assert cut[cut.what == "to_step"].hit_s.tolist() == [5.0]


def test_a_take_without_rallies_has_only_false_split_steps():
    alone = SimpleNamespace(person_id=np.array(["a"]), events={"a": {"hit_1": 2.0}})
    feet = events(("a", "split_step", 3.0, 3.1))
    rows = reactions.table(reaction.join(TRUE_HITS[:1], feet), feet, alone, SPAN)
    assert rows.result.tolist() == ["false"]
