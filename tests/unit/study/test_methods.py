"""Names of calibrations, structures from motion, fusions parse as the configuration means them."""

import pytest

from courtside.study import methods
from courtside.study.errors import InputError
from courtside.study.methods import Calibration, Fusion, Variant


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("file", Calibration("file", "file")),
        ("sfm-n40", Calibration("sfm-n40", "sfm", Variant("global", 40, 0))),
        ("sfm-n40-o1", Calibration("sfm-n40-o1", "sfm", Variant("global", 40, 1))),
        (
            "sfm-n40-o1-lines",
            Calibration("sfm-n40-o1-lines", "sfm", Variant("global", 40, 1), lines=True),
        ),
        ("sim3-n12", Calibration("sim3-n12", "sim3", Variant("global", 12, 0))),
        ("paper-n40", Calibration("paper-n40", "paper", Variant("incremental", 40, 0))),
        ("paper-global-n40", Calibration("paper-global-n40", "paper", Variant("global", 40, 0))),
        ("paper-n5-o2", Calibration("paper-n5-o2", "paper", Variant("incremental", 5, 2))),
        ("known", Calibration("known", "known")),
        ("board", Calibration("board", "board")),
        ("wand", Calibration("wand", "wand")),
        ("wand-people", Calibration("wand-people", "people", base="wand")),
        ("people", Calibration("people", "people-alone")),
        ("known18", Calibration("known18", "known", n_points=18)),
        ("known8-board", Calibration("known8-board", "known", n_points=8, board=True)),
        ("dlt18", Calibration("dlt18", "dlt", n_points=18)),
        ("file-people", Calibration("file-people", "people", base="file")),
        (
            "sfm-n40-o1-people",
            Calibration("sfm-n40-o1-people", "people", Variant("global", 40, 1), base="sfm-n40-o1"),
        ),
    ],
)
def test_a_calibration_is_parsed_from_its_name(name, expected):
    assert Calibration.parse(name) == expected


@pytest.mark.parametrize(
    "name",
    [
        "",
        "-people",
        "file-people-people",
        "people-people",
        "sfm",
        "sfm-n",
        "sfm-global-n40",
        "known-n8",
        "sim3-n40-lines",
        "file-lines",
        "n40",
        "file2",
    ],
)
def test_a_name_of_no_calibration_is_an_error_with_examples(name):
    with pytest.raises(InputError, match="such as file, sfm-n40 or known18, found"):
        Calibration.parse(name)


def test_a_file_a_board_and_people_alone_do_not_rest_on_clicks():
    names = ["file", "board", "people", "wand", "known18", "known", "dlt18", "sfm-n40", "paper-n5"]
    found = [name for name in names if Calibration.parse(name).of_clicks]
    assert found == names[3:]


def test_adjusting_all_cameras_together_gives_a_covariance():
    names = [
        "file",
        "file-people",
        "sfm-n40",
        "sim3-n40",
        "paper-n40",
        "paper-global-n40",
        "known18",
        "dlt18",
    ]
    found = [
        name
        for name in [*names, "known", "board", "wand", "people"]
        if Calibration.parse(name).has_covariance
    ]
    assert found == ["file-people", "sfm-n40", "known", "board", "wand", "people"]


def test_a_structure_from_motion_is_parsed_and_named():
    variant = Variant.parse("incremental-n75-o2")
    assert variant == Variant("incremental", 75, 2)
    assert variant.name == "incremental-n75-o2"
    assert Variant("global", 40).name == "global-n40-o0"
    with pytest.raises(InputError, match="such as global-n40-o0"):
        Variant.parse("global-n40")


@pytest.mark.parametrize(
    ("name", "cameras", "rule", "steadied"),
    [
        ("all-robust", "all", "robust", True),
        ("two-dlt", "two", "dlt", True),
        ("all-unsteady", "all", "robust", False),
        ("left-half-robust", "left-half", "robust", True),
        ("halfbody", "", methods.HALFBODY, True),
        ("trc", "", "trc", True),
    ],
)
def test_a_fusion_is_parsed_from_its_name(name, cameras, rule, steadied):
    assert Fusion.parse(name) == Fusion(name, cameras, rule, steadied)


@pytest.mark.parametrize(
    ("n_images", "n_frames", "offsets"),
    [(40, 150, [0, 1, 2]), (40, 80, [0, 1]), (11, 11, [0]), (40, 11, [0]), (2, 3, [0, 1])],
)
def test_only_offsets_whose_choices_differ_are_left(n_images, n_frames, offsets):
    assert methods.distinct_offsets(n_images, n_frames, 3) == offsets
