"""Measures of footwork from stances."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import court
from courtside.footwork import hops, kinds, measures
from courtside.footwork.hops import Hop
from courtside.footwork.stances import Stance
from fixtures.study import data_dictionary

CONFIG = Path(__file__).parents[3] / "config"
NAN = float("nan")


def run(n=5, stride_m=1.2, x=3.0, y=1.0, late_s=0.0):
    """Return both feet of a straight run whose stances last 0.25 s and whose swings 0.35 s."""
    feet = {}
    for side, phase in (("left", 0.0), ("right", 0.5)):
        places = [np.array([x, y + stride_m * (k + phase)]) for k in range(n + 1)]
        onsets = [NAN, *(late_s + 0.85 + 0.6 * (k + phase) for k in range(n))]
        ends = [late_s + 0.5 + 0.6 * (k + phase) for k in range(n)] + [NAN]
        feet[side] = [
            Stance(a, 0.01, b, 0.01, place, 0.02, 0.95, (late_s, late_s + 5.0))
            for a, b, place in zip(onsets, ends, places, strict=True)
        ]
    return feet


def values(feet, lines=None):
    return measures.summary(*kinds.tables({"p1": (feet, 0.9, None)}), lines).set_index("measure")


def test_counts_and_times_of_a_run():
    found = values(run())
    assert found.loc["steps", "value"] == 10
    assert found.loc["lunges", "value"] == 0
    assert found.loc["stance_time", "value"] == pytest.approx(0.25)
    assert found.loc["stance_time", "n"] == 8
    assert found.loc["stance_time", "sigma"] == pytest.approx(0.01 * np.sqrt(2))
    assert found.loc["swing_time_left", "value"] == pytest.approx(0.35)
    assert found.loc["flight_time", "value"] == pytest.approx(0.05)


def test_every_measure_is_described():
    found = values(run(), court.read(CONFIG / "courts" / "badminton.yaml")).index
    assert {"jumps", "swing_time_right", "steps_rear_left", "rally_1_step_rate"} <= set(found)
    text = (CONFIG.parent / "docs" / "results.md").read_text(encoding="utf-8")
    dictionary = data_dictionary.Dictionary(text)
    assert dictionary.undescribed([*found, "hops"], data_dictionary.OF_FOOTWORK) == ["hops"]


def test_times_in_which_a_foot_is_not_seen_are_neither_swings_nor_flights():
    first, second = run(), run(late_s=8.0)
    # Both feet swing as they get out of sight, and as they come into it again.
    both = {side: first[side][:-1] + second[side][1:] for side in first}
    found = values(both)
    assert found.loc["swing_time", ["value", "n"]].tolist() == pytest.approx([0.35, 16])
    assert found.loc["flight_time", "value"] == pytest.approx(0.05)


def test_a_hop_is_one_flight():
    """A split step of 0.2 s, in which both feet land at one time, before the flights of a run."""
    hop = Hop(0.2, 0.01, 0.4, 0.01)
    feet = {side: hops.cut(stances, [hop]) for side, stances in run().items()}
    steps, events = kinds.tables({"p1": (feet, 0.9, [hop])})
    found = measures.summary(steps, events, None).set_index("measure").loc["flight_time"]
    alone = values(run()).loc["flight_time"]
    assert found["n"] == alone["n"] + 1
    assert found["n"] * found["value"] == pytest.approx(alone["n"] * alone["value"] + 0.2)


def test_a_foot_that_gets_out_of_sight_does_not_stand_for_ever():
    first, second = run(), run(late_s=8.0)
    first["left"][-1] = replace(first["left"][-1], end_s=NAN)
    alone = values(second).loc["flight_time"]
    found = values({side: first[side] + second[side] for side in first}).loc["flight_time"]
    assert found["n"] == alone["n"] + values(first).loc["flight_time", "n"]


def test_a_rally_has_time_distance_and_rate():
    found = values(run())
    assert found.loc["rally_1_time", "value"] == pytest.approx(0.3 * 9)
    assert found.loc["rally_1_distance", "value"] == pytest.approx(0.6 * 8)
    # Only the places at both ends count: those of the first two and the last two landings.
    assert found.loc["rally_1_distance", "sigma"] == pytest.approx(0.02)
    assert found.loc["rally_1_step_rate", "value"] == pytest.approx(1 / 0.3)
    assert "rally_2_time" not in found.index
    first, second = run(), run(late_s=20.0)
    both = {side: first[side][:-1] + second[side][1:] for side in first}
    assert values(both).loc["rally_2_time", "value"] == pytest.approx(0.3 * 9)


@pytest.mark.parametrize("hidden", [("left", "right"), ("right",)])
def test_the_step_rate_does_not_count_the_time_in_which_a_foot_is_not_seen(hidden):
    """A run of 3.3 landings a second in which both feet, or one, are hidden for 1.2 s."""
    feet = {side: [replace(s, seen_s=(0.0, 20.0)) for s in own] for side, own in run(20).items()}
    whole = values(feet)
    for side in hidden:
        before = [replace(s, seen_s=(0.0, 4.0)) for s in feet[side] if not s.onset_s > 4.0]
        after = [replace(s, seen_s=(5.2, 20.0)) for s in feet[side] if s.onset_s > 5.2]
        feet[side] = before + after
    found = values(feet)
    rate = found.loc["rally_1_step_rate"]
    assert found.loc["rally_1_time", "value"] == whole.loc["rally_1_time", "value"]
    assert rate["value"] == pytest.approx(1 / 0.3)
    assert 20 < rate["n"] < whole.loc["rally_1_step_rate", "n"]
    assert rate["sigma"] > whole.loc["rally_1_step_rate", "sigma"]


def test_steps_of_one_foot_have_no_step_rate():
    found = values({"left": [], "right": run(8)["right"]})
    assert found.loc["steps", "value"] == 8
    assert np.isnan(found.loc["rally_1_step_rate", ["value", "sigma"]].astype(float)).all()


def out_of_sight(since_s, until_s, n=40):
    """Return the feet of a run of 24 s, without what neither foot shows in between."""
    feet = {}
    for side, stances in run(n).items():
        known = [replace(s, seen_s=(0.0, 30.0)) for s in stances]
        before = [replace(s, seen_s=(0.0, since_s)) for s in known if s.until_s < since_s]
        after = [replace(s, seen_s=(until_s, 30.0)) for s in known if s.since_s > until_s]
        feet[side] = before + after
    return feet


@pytest.mark.parametrize("unseen_s", [1.0, 3.0, 4.5])
def test_a_rally_goes_on_while_the_player_is_out_of_sight_for_a_short_time(unseen_s):
    whole, found = values(out_of_sight(40.0, 40.0)), values(out_of_sight(10.0, 10.0 + unseen_s))
    assert "rally_2_time" not in found.index
    for name in ("time", "distance", "step_rate"):  # the run is straight, also while unseen
        of_run = whole.loc[f"rally_1_{name}", "value"]
        assert found.loc[f"rally_1_{name}", "value"] == pytest.approx(of_run), name
    assert found.loc["rally_1_unseen", "value"] == pytest.approx(unseen_s)
    assert whole.loc["rally_1_unseen", "value"] == 0


def test_a_rally_ends_where_the_player_stands_or_is_out_of_sight_for_long():
    long = values(out_of_sight(10.0, 16.0))
    times = long.loc[["rally_1_time", "rally_2_time"], "value"]
    assert times.tolist() == pytest.approx([8.7, 8.4], abs=0.6)
    assert long.loc[["rally_1_unseen", "rally_2_unseen"], "value"].tolist() == [0, 0]
    # Out of sight for 1 s, but standing for 3.1 s besides: neither foot lands.
    feet = out_of_sight(10.0, 11.0)
    stood = {side: [s for s in own if not 7.9 < s.onset_s < 12.0] for side, own in feet.items()}
    assert {"rally_1_time", "rally_2_time"} <= set(values(stood).index)


def test_corners_are_sixths_of_the_own_half_as_seen_facing_the_net():
    lines = court.read(CONFIG / "courts" / "badminton.yaml")
    net, width = lines.net["y_m"], lines.size_m[0]
    xy = np.array([[0.2, net - 0.5], [width - 0.2, 0.1], [0.2, net + 0.5], [width - 0.2, net - 3]])
    expected = ["front_left", "rear_right", "front_right", "mid_right"]
    assert measures.corner(xy, lines).tolist() == expected
    found = values(run(x=width - 1), lines)
    assert found.filter(regex="^steps_", axis=0)["value"].sum() == 10
    assert found.loc["steps_rear_right", "value"] == 1  # y = 2.2 m
    assert found.loc["steps_mid_right", "value"] == 3


def test_one_landing_and_no_landing_have_measures():
    feet = {"left": [Stance(NAN, NAN, NAN, NAN, np.zeros(2), 0.01, 1.0, (0, 5))], "right": []}
    found = values(feet)
    assert found.loc["steps", "value"] == 0
    assert np.isnan(found.loc["stance_time", "value"])


def test_one_or_two_landings_are_no_rally():
    single = {"left": run(1)["left"], "right": []}
    assert values(single).loc["steps", "value"] == 1
    assert not values(single).index.str.startswith("rally").any()
    later = run(late_s=20.0)
    both = {"left": single["left"] + later["left"], "right": later["right"]}
    assert values(both).loc["rally_1_time", "value"] == pytest.approx(0.3 * 9)
