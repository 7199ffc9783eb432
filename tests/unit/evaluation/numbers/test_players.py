"""Numbers of virtual players, from summaries worked out by hand."""

from pathlib import Path

import pytest

from courtside.evaluation.numbers import players
from courtside.study.configuration import yaml_files

ROOT = Path(__file__).parents[4]


def test_the_network_of_the_tables_is_the_default_one():
    assert yaml_files.read(ROOT / "config" / "config.yaml")["models"] == [players.NETWORK]


def test_every_take_is_shown_raw_filtered_and_corrected(source, value):
    found = players.takes(source)
    assert {n.row for n in found} == {
        f"`players-b/{take}`: {cameras}"
        for take in ("footwork", "shot")
        for cameras in ("all cameras", "2 cameras")
    }
    row = "`players-b/footwork`: all cameras"
    shown = [value(found, row, f"{stage}_median").printed for stage in players.STAGES]
    assert shown == ["46", "45", "24"]


def test_a_session_has_its_median_take_and_its_worst(source, value):
    found = players.sessions(source)
    assert value(found, "`players-b`, 2 takes", "raw_median").value == 51
    assert value(found, "`players-b`, 2 takes", "raw_median_worst").value == 56
    held = value(found, "`players-b`, 2 takes", "corrected_coverage")
    assert (held.value, held.n) == (pytest.approx(82.5), 400)
    assert value(found, "`players-b`, 2 takes", "corrected_least").value == 80


def test_angles_of_takes_are_weighted_with_their_frames(source, value):
    found = players.angles(source)
    bias = value(found, "knee flexion, `players-b`", "raw_bias")
    assert (bias.value, bias.n) == (pytest.approx(-5.5), 400)
    rmse = value(found, "knee flexion", "corrected_rmse").value
    assert rmse == pytest.approx(((300 * 64 + 100 * 324) / 400) ** 0.5)
    assert value(found, "knee flexion", "raw_coverage").value == pytest.approx(62.5)


def test_measures_are_of_the_furthest_person_and_the_clocks_of_the_take(source, value):
    found, row = players.measures(source), "`players-b/footwork`: all cameras"
    assert value(found, row, "neck_far").printed == "-0.4"
    assert value(found, row, "neck_held").printed == "70"
    assert value(found, row, "clock").printed == "-2.5"
    assert value(found, row, "clocks_within").printed == "2"


def test_clocks_stand_only_beside_the_cameras_that_they_were_found_with(source, value):
    found = players.measures(source)
    fewer = {n.part for n in found if n.row == "`players-b/footwork`: 2 cameras"}
    assert "neck_far" in fewer
    assert not fewer & set(players.CLOCKS)


def test_a_rule_without_words_is_shown_by_its_name():
    assert players.words("all-robust") == "all cameras"
    assert players.words("five-robust") == "`five-robust`"


def test_what_stated_errors_hold_is_told_for_large_errors_too(source, value):
    found = players.held(source)
    assert value(found, "joints, all sessions", "raw").printed == "95.0"
    large = value(found, "joints, all sessions", "raw_large")
    assert (large.printed, large.n) == ("50", 40)  # 60 % of 30 and 20 % of 10
    assert {number.row for number in found if "all" in number.row} == {
        "joints, all sessions", "joint angles, all sessions",
    }  # fmt: skip


def test_each_network_of_a_session_has_its_own_row_of_what_is_held(source, value):
    found = [number for number in players.held(source) if "`repeats`" in number.row]
    assert {number.row: number.printed for number in found if number.part == "raw"} == {
        "joints, `repeats`": "96.0",
        "joints, `repeats` (blazepose-full)": "99.0",
    }
    assert [number.printed for number in found if number.part == "raw_large"] == ["46", "49"]
