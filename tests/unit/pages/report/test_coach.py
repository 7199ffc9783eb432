"""The page for a coach: numbers as exact as they are, words that come from users stay text."""

import math

import pytest

from courtside.pages import page
from courtside.pages.report import coach
from courtside.pages.report.warnings import DOUBTFUL, FAILED, GOOD, Warned
from fixtures.study.report_made import ROGUE

FACTS = {"persons": {}, "left_out": {}, "seconds": {}, "devices": [], "true_paths": []}
FACTS |= {"footwork": {}, "strokes": {}}


@pytest.mark.parametrize(
    ("value", "half", "unit", "expected"),
    [
        (29.3274, 0.376, "m", "29.33 &plusmn; 0.38 m"),
        (89.7463, 9.38, "degrees", "89.7 &plusmn; 9.4&deg;"),
        (146.305, 27.6, "degrees", "146 &plusmn; 28&deg;"),
        (-15.25, 2.86, "degrees", "&minus;15.2 &plusmn; 2.9&deg;"),
        (1.2254, 0.0156, "m/s", "1.225 &plusmn; 0.016 m/s"),
        (2.65, math.nan, "m/s", "2.6 m/s (error unknown)"),
        (3.432, math.nan, "degrees", "3&deg; (error unknown)"),
        (0.4, math.nan, "degrees", "0&deg; (error unknown)"),
        (0.0, math.nan, "m", "0.000 m (error unknown)"),
        (math.nan, math.nan, "m", "not known"),
    ],
)
def test_numbers_have_the_digits_of_their_error(value, half, unit, expected):
    assert coach.with_error(value, half, unit) == expected


def test_a_mark_has_a_shape_and_a_word_beside_its_colour():
    light = page.macro("report_parts.html", "light")
    shapes = {level: light(level) for level in (GOOD, DOUBTFUL, FAILED)}
    words = {GOOD: "good", DOUBTFUL: "doubtful", FAILED: "failed"}
    assert all(words[level] in html for level, html in shapes.items())
    assert len({html.split('hidden="true">')[1][0] for html in shapes.values()}) == 3


def test_a_take_says_distance_speeds_and_angles():
    measures = {
        "neck_distance": (29.3274, 0.376, "m"),
        "neck_ground_distance": (28.6521, 0.371, "m"),
        "neck_speed_mean": (1.2254, 0.0155, "m/s"),
        "left_knee_flexion_min": (12.8, 9.5, "degrees"),
        "left_knee_flexion_max": (89.7, 9.4, "degrees"),
    }
    facts = FACTS | {
        "persons": {"p1": measures},
        "left_out": {"p1": (6, 100, {}, "")},
        "seconds": {"p1": (24.03, "")},
    }
    take = {"id": "take-x", "name": "smash", "links": [("a/viewer.html", "3D viewer")]}
    html = coach.take(take, facts, [Warned(DOUBTFUL, "Camera left moved.")])
    for words in ("29.33 &plusmn; 0.38 m", "in 24.0 s", "from 94 of 100 frames", "left knee, bend"):
        assert words in html
    assert 'href="a/viewer.html"' in html and "Camera left moved." in html
    space, ground = "29.33 &plusmn; 0.38 m", "28.65 &plusmn; 0.37 m"
    text = " ".join(html.split())
    assert f"{space}</b> in 24.0 s, up and down included, on the ground <b>{ground}" in text
    assert html.index("doubtful") < html.index("29.33")


def test_the_time_of_a_distance_is_that_of_the_path():
    facts = FACTS | {"persons": {"p1": {"neck_distance": (2.37, 0.01, "m")}}}
    facts["seconds"] = {"p1": (3.0, "from 0.0 to 3.0 s of the take")}
    html = coach.take({"id": "t", "name": "t", "links": []}, facts, [])
    words = "</b> in 3.0 s, from 0.0 to 3.0 s of the take, up and down included."
    assert words in " ".join(html.split())


def test_a_take_says_what_the_feet_did():
    feet = {
        "steps": (66.0, math.nan, ""),
        "lunges": (5.0, math.nan, ""),
        "split_steps": (2.0, math.nan, ""),
        "stance_time": (0.4325, 0.0082, "s"),
        "swing_time": (math.nan, math.nan, "s"),
    }
    take = {"id": "take-x", "name": "drill", "links": []}
    facts = FACTS | {"persons": {"p1": {}, "p2": {}}, "footwork": {"p1": feet}}
    html = coach.take(take, facts, [])
    for words in (
        "landings of a foot",
        "<b>66</b> (lunges: 5, split steps: 2)",
        "a foot stands for",
    ):
        assert words in html
    assert "0.432 &plusmn; 0.008 s" in html
    assert "swings" not in html
    assert html.count("landings") == 1


@pytest.mark.parametrize(
    ("stance", "swing", "said"),
    [
        (0.4, 0.25, "a foot stands for <b>0.400 &plusmn; 0.010 s</b> on average, and swings for"),
        (math.nan, 1.056, "split steps: 0), a foot swings for <b>1.056 &plusmn; 0.010 s</b>"),
    ],
)
def test_times_of_a_foot_are_a_sentence_where_one_is_not_known(stance, swing, said):
    feet = dict.fromkeys(("steps", "lunges"), (1.0, math.nan, ""))
    feet |= {"split_steps": (0.0, math.nan, "")}
    feet |= {"stance_time": (stance, 0.01, "s"), "swing_time": (swing, 0.01, "s")}
    facts = FACTS | {"persons": {"p1": {}}, "footwork": {"p1": feet}}
    html = coach.take({"id": "t", "name": "t", "links": []}, facts, [])
    assert said in " ".join(html.split())


def test_joint_angles_say_where_they_are_zero_and_which_way_is_negative():
    angles = {"trunk_lean_forward_min": (-18.0, 16.0, "degrees")}
    angles |= {"trunk_lean_forward_max": (16.0, 13.0, "degrees")}
    take = {"id": "t", "name": "t", "links": []}
    html = coach.take(take, FACTS | {"persons": {"p1": angles}}, [])
    assert "&minus;18 &plusmn; 16&deg;" in html
    assert "Bend: 0° is straight. Arm: 0° hangs along the trunk." in html
    assert "Lean: 0° is upright; forwards, negative is backwards." in html
    assert "0° is" not in coach.take(take, FACTS | {"persons": {"p1": {}}}, [])


def test_strokes_are_counted_with_their_hand_where_there_are_any():
    hits = [{"person": "p1", "hand": "left", "overhead": over} for over in (True, False, True)]
    facts = FACTS | {"persons": {"p1": {}, "p2": {}}, "strokes": {"p1": hits}}
    html = coach.take({"id": "t", "name": "t", "links": []}, facts, [])
    assert "strokes <b>3</b> (left hand; 2 overhead)" in html
    assert html.count("strokes") == 1


def test_a_simulated_take_compares_the_distance_with_the_truth():
    row = {"person": "p1", "point": "neck", "distance_error_percent": -2.3}
    facts = FACTS | {
        "persons": {"p1": {"neck_distance": (1.0, 0.1, "m")}},
        "true_paths": [row],
    }
    html = coach.take({"id": "t", "name": "t", "links": []}, facts, [])
    assert "2.3 % too short" in html


def test_warnings_for_information_only_are_folded_away():
    warnings = page.macro("report_parts.html", "warnings")
    html = warnings([Warned(DOUBTFUL, "one"), Warned(GOOD, "two")])
    assert html.index("one") < html.index("<details>") < html.index("two")
    assert warnings([]) == ""


def test_text_of_users_is_escaped():
    measures = {"neck_distance": (1.0, 0.1, ROGUE)}
    facts = FACTS | {"persons": {ROGUE: measures}, "devices": [{"source": ROGUE}]}
    take = {"id": "t", "name": ROGUE, "links": [(ROGUE, ROGUE)]}
    html = coach.take(take, facts, [Warned(DOUBTFUL, ROGUE)], ROGUE)
    html += coach.take(take, facts | {"persons": {}}, [])
    assert "<img" not in html and "</script>" not in html
