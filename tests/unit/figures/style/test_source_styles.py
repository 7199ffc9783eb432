"""Sources of one kind share a colour and differ in line and marker."""

import pytest

from courtside.figures.style import source_styles

DEVICES = {"d415": "rgbd", "imu": "inertial", "kinect": "nuitrack"}


@pytest.mark.parametrize(
    ("source", "kind"),
    [
        ("d415-rgb", "rgb"),
        ("d415-depth", "rgbd"),
        ("imu", "inertial"),
        ("imu-corrected", "corrected"),
        ("kinect", "nuitrack"),
        ("cameras", "cameras"),
        ("truth", "truth"),
        ("mocopi", "inertial"),
        ("unheard-of", "other"),
    ],
)
def test_the_kind_follows_from_name_and_session(source, kind):
    assert source_styles.kind_of(source, DEVICES) == kind


def test_the_session_has_priority_over_a_usual_name():
    assert source_styles.kind_of("mocopi", {"mocopi": "nuitrack"}) == "nuitrack"


def test_two_of_a_kind_differ_and_keep_their_colour():
    found = source_styles.looks(["a-rgb", "cameras", "b-rgb", "a-rgb"])
    assert list(found) == ["a-rgb", "cameras", "b-rgb"]
    a, b = found["a-rgb"], found["b-rgb"]
    assert a.colour == b.colour == source_styles.COLOURS["rgb"]
    assert (a.line, a.marker) != (b.line, b.marker)
    assert found["cameras"].marker == a.marker


def test_kinds_have_colours_of_their_own():
    assert len(set(source_styles.COLOURS.values())) == len(source_styles.COLOURS)
    assert source_styles.OTHER not in source_styles.COLOURS.values()
