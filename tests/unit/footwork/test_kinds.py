"""What stances are: steps, lunges, split steps, jumps."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.footwork import kinds
from courtside.footwork.hops import Hop
from courtside.footwork.stances import Stance

NAN = float("nan")


def stance(onset_s, end_s, x=0.0, y=0.0):
    return Stance(onset_s, 0.01, end_s, 0.01, np.array([x, y]), 0.01, 0.95, (0.0, 5.0))


def together(off_s, land_s, ahead=0.0, late=0.0):
    """Return feet that leave and land, the right one `late` seconds after the left."""
    left = [stance(NAN, off_s, -0.2), stance(land_s, NAN, -0.2, ahead)]
    right = [stance(NAN, off_s + late, 0.2), stance(land_s + late, NAN, 0.2, ahead)]
    return {"left": left, "right": right}


@pytest.mark.parametrize(
    ("feet", "event"),
    [
        (together(1.0, 1.2), "split_step"),
        (together(1.0, 1.2, late=0.05), "split_step"),
        (together(1.0, 1.45), "jump"),
        (together(1.0, 1.2, ahead=0.9), "jump"),
    ],
)
def test_both_feet_that_leave_and_land_together(feet, event):
    steps, events = kinds.tables({"p1": (feet, 0.9, None)})
    assert steps.kind.tolist() == ["stand", "stand", event, event]
    assert events.event.tolist() == [event]
    last, first = events.iloc[0].start_s, events.iloc[0].stop_s
    assert last == max(feet["left"][0].end_s, feet["right"][0].end_s)
    assert first == feet["left"][1].onset_s


@pytest.mark.parametrize("looked", [None, []])
def test_feet_that_leave_and_land_together_after_a_roll_have_not_jumped(looked):
    steps, events = kinds.tables({"p1": (together(1.0, 2.0, ahead=2.0), 0.9, looked)})
    assert steps.kind.tolist() == ["stand", "stand", "step", "step"]
    assert events.event.tolist() == ["step", "step"]


def test_a_hop_is_a_split_step_once_even_where_the_stances_show_it():
    feet, hop = together(1.0, 1.2), Hop(1.0, 0.01, 1.2, 0.01)
    steps, events = kinds.tables({"p1": (feet, 0.9, [hop])})
    assert steps.kind.tolist() == ["stand", "stand", "split_step", "split_step"]
    (row,) = events.to_dict("records")
    assert (row["event"], row["start_s"], row["stop_s"]) == ("split_step", 1.0, 1.2)
    assert row["x_m"] == pytest.approx(0.0)


def test_a_split_step_before_the_feet_are_lost_has_no_place_as_the_dictionary_says():
    feet = {side: stances[:1] for side, stances in together(1.0, 1.2).items()}
    _, events = kinds.tables({"p1": (feet, 0.9, [Hop(1.0, 0.01, 1.2, 0.01)])})
    assert events.event.tolist() == ["split_step"]
    assert events[["x_m", "y_m", "quality"]].isna().all(axis=None)
    text = (Path(__file__).parents[3] / "docs" / "results.md").read_text(encoding="utf-8")
    told = text.split("| `.events.csv` | `event`, `foot` |")[1].split("\n")[2]
    assert told.startswith("| | `x_m`, `y_m`, `quality` |")
    assert "a split step after which neither foot is seen" in told


def test_where_hops_were_looked_for_no_other_flight_is_a_split_step():
    _, events = kinds.tables({"p1": (together(1.0, 1.2), 0.9, [])})
    assert "split_step" not in set(events.event)
    assert events.event.tolist() == ["step", "step"]
    _, events = kinds.tables({"p1": (together(1.0, 1.2), 0.9, None)})
    assert events.event.tolist() == ["split_step"]


def test_running_feet_take_steps():
    left = [stance(NAN, 0.5), stance(0.85, 1.1, 0, 1.2), stance(1.45, NAN, 0, 2.4)]
    right = [stance(NAN, 0.8, 0, 0.6), stance(1.15, 1.4, 0, 1.8)]
    steps, events = kinds.tables({"p1": ({"left": left, "right": right}, 0.9, None)})
    assert set(events.event) == {"step"}
    assert events.foot.tolist() == ["left", "right", "left"]
    assert np.isnan(steps.onset_s.iloc[0])


@pytest.mark.parametrize(
    ("apart", "stays", "leg_m", "kind"),
    [(1.1, 0.6, 0.9, "lunge"), (0.7, 0.6, 0.9, "step"), (1.1, 0.1, 0.9, "step"),
     (1.1, 0.6, NAN, "step")],
)  # fmt: skip
def test_a_lunge_lands_far_from_the_other_foot_and_both_stand(apart, stays, leg_m, kind):
    left = [stance(NAN, 1.0 + stays)]
    right = [stance(NAN, 0.7), stance(1.0, 1.0 + stays + 0.1, 0, apart)]
    steps, events = kinds.tables({"p1": ({"left": left, "right": right}, leg_m, None)})
    assert steps[steps.foot == "right"].kind.tolist() == ["stand", kind]
    assert events.event.tolist() == [kind]


def test_a_first_landing_is_a_step_and_stances_that_a_gap_cuts_keep_their_place():
    early = Stance(0.2, 0.01, NAN, NAN, np.zeros(2), 0.01, 0.9, (0.0, 0.8))
    cut = Stance(NAN, NAN, NAN, NAN, np.zeros(2), 0.01, 0.9, (1.0, 1.5))
    late = Stance(2.0, 0.01, 2.5, 0.01, np.zeros(2), 0.01, 0.9, (1.8, 2.7))
    steps, events = kinds.tables({"p1": ({"left": [early, cut, late], "right": []}, 0.9, None)})
    assert steps.kind.tolist() == ["step", "stand", "step"]
    assert steps.onset_s.tolist() == pytest.approx([0.2, NAN, 2.0], nan_ok=True)
    assert events.empty  # of neither is known when the foot left


def test_a_stance_that_a_gap_cuts_is_no_lunge_of_the_other_foot():
    left = [replace(stance(NAN, NAN), seen_s=seen_s) for seen_s in ((0.0, 1.1), (2.0, 2.5))]
    right = [stance(NAN, 0.7), stance(1.0, 2.1, 0, 1.1)]
    steps, _ = kinds.tables({"p1": ({"left": left, "right": right}, 0.9, None)})
    assert "lunge" not in set(steps.kind)
    assert steps.loc[steps.foot == "left", "seen_until_s"].tolist() == [1.1, 2.5]


def test_no_swing_and_no_flight_goes_across_a_gap():
    feet = together(1.0, 1.2)
    feet["left"][1] = replace(feet["left"][1], seen_s=(1.1, 5.0))
    _, events = kinds.tables({"p1": (feet, 0.9, None)})
    assert events[["event", "foot"]].to_numpy().tolist() == [["step", "right"]]


def test_a_split_step_lands_where_the_feet_stand_then():
    feet = together(1.0, 1.2, ahead=0.5)
    unseen = replace(stance(NAN, NAN, 3.0), seen_s=(0.0, 0.2))
    feet["left"] = [unseen, replace(feet["left"][0], seen_s=(0.4, 5.0)), feet["left"][1]]
    _, events = kinds.tables({"p1": (feet, 0.9, [Hop(1.0, 0.01, 1.2, 0.01)])})
    assert events.loc[events.event == "split_step", "y_m"].tolist() == [0.5]


def test_nobody_has_no_steps():
    steps, events = kinds.tables({"p1": ({"left": [], "right": []}, NAN, None)})
    assert steps.empty
    assert events.empty
