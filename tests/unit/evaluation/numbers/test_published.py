"""Published numbers stand beside a re-enactment, never instead of it."""

from pathlib import Path

from courtside.evaluation.numbers import published, register
from courtside.evaluation.numbers.register import PUBLISHED, STUDY


def test_a_walk_is_compared_at_the_nearest_number_of_images(source, value):
    found = published.walk(source)
    theirs = value(found, "`plain-a`: walk of 40 images; theirs: 300", "published")
    assert (theirs.printed, theirs.origin) == ("4.3", PUBLISHED)
    again = value(found, "`plain-a`: walk of 40 images", "again_volume")
    assert (again.printed, again.origin, again.n) == ("7.00", STUDY, 2)
    assert value(found, "`plain-a`: 18 points, no walk", "again_xy").printed == "3.00"
    assert {number.row[:9] for number in found} == {"`plain-a`"}


def test_a_racket_has_absolute_errors_beside_the_ratio(source, value):
    found = published.racket(source)
    assert value(found, "`plain-a`", "sfm18").printed == "4.2"
    assert value(found, "`plain-a`", "sfm18_ratio").printed == "1.05"
    assert value(found, "`plain-a`", "their8").origin == PUBLISHED
    assert [value(found, "`plain-a`", p).printed for p in ("their8", "their_walk")] == [
        "12.7",
        "11.9",
    ]


def test_table_1_is_of_all_joints_together(source, value):
    found = published.round_trip(source)
    assert len(found) == 4
    assert value(found, "`players-b/shot`, 4 cameras: distance to the truth", "mean").value == 50.8


def test_the_authors_table_1_is_the_mean_over_their_joints(value):
    documents = register.Source(Path(__file__).parents[4])
    found = published.table_1(documents)
    assert [(n.printed, n.n, n.origin) for n in found] == [
        ("2.72", 14, PUBLISHED),
        ("0.81", 14, PUBLISHED),
    ]
