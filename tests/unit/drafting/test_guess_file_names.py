"""Words of file names, and names made of anything."""

import pytest

from courtside.drafting import guess
from courtside.study.configuration import configuration


@pytest.mark.parametrize(
    ("parts", "expected"),
    [
        (["smash1_left"], ("smash1", "left")),
        (["Cam 01-takeTwo"], ("cam01", "take", "two")),
        (["left", "GX010034"], ("left", "gx010034")),
        (["2026-05-01 smash (2)"], ("2026", "05", "01", "smash2")),
        (["Schläger_Übung"], ("schlager", "ubung")),
        (["コート"], ()),
        (["take", "1"], ("take", "1")),  # a folder's name and a file's are not one word
    ],
)
def test_words(parts, expected):
    assert guess.words_of(parts) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("North Gym", "north_gym"),
        ("  --A.b--  ", "a_b"),
        ("Größe", "grosse"),
        ("コート", "session1"),
        ("", "session1"),
    ],
)
def test_names_are_such_as_a_configuration_accepts(text, expected):
    found = guess.name(text, "session1")
    assert found == expected
    assert configuration.NAME.fullmatch(found)


def test_distinct_counts_on():
    assert guess.distinct("walk", {}) == "walk"
    assert guess.distinct("walk", {"walk": 0, "walk_2": 0}) == "walk_3"


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("cam1", "cam01", True),
        ("cam10", "cam1", False),
        ("cam001", "cam01", True),
        ("cam0", "cam", False),
        ("a0", "a00", True),
        ("left", "left", True),
    ],
)
def test_zeros_before_a_number_do_not_count(one, other, same):
    assert guess.alike(one, other) is same
