"""Words of file names in several scripts, and names made of them."""

import pytest

from courtside.drafting import names
from courtside.study.configuration import configuration


@pytest.mark.parametrize(
    ("parts", "expected"),
    [
        (["smash1_left"], ("smash1", "left")),
        (["Cam 01-takeTwo"], ("cam01", "take", "two")),
        (["left", "GX010034"], ("left", "gx010034")),
        (["left_20260503"], ("left", "20260503")),
        (["iPhone 13", "leftGoPro2"], ("iphone13", "left", "gopro2")),
        (["2026-05-01 smash (2)"], ("2026", "05", "01", "smash2")),
        (["Schläger_Übung"], ("schlager", "ubung")),
        (["コート"], ("コート",)),
        (["左カメラ2_試技1"], ("left", "cam2", "trial1")),
        (["カメラ１＿スマッシュ"], ("cam1", "スマッシュ")),  # full width
        (["ｶﾒﾗ3"], ("cam3",)),  # half width
        (["왼쪽 카메라_서브"], ("left", "cam", "서브")),
        (["Левая Камера дубль 2"], ("left", "cam", "take2")),
        (["右侧机位-发球"], ("right", "cam", "发球")),
        (["take", "1"], ("take", "1")),  # a folder's name and a file's are not one word
    ],
)
def test_names_are_split_into_words(parts, expected):
    assert names.words_of(parts) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("North Gym", "north_gym"),
        ("our-walk", "our-walk"),
        ("Our_walk - 2026-05-01", "our_walk_2026-05-01"),
        ("  --A.b--  ", "a_b"),
        ("Größe", "grosse"),
        ("コート", "koto"),
        ("ガット", "gatuto"),
        ("서브", "seobeu"),
        ("подача", "podacha"),
        ("σερβίς", "servis"),
        ("左カメラ", "left_cam"),
        ("体育館", "session1"),  # no spelling of their own
        ("体育館 2", "session1"),
        ("🏸", "session1"),
        ("", "session1"),
        ("Con", "session1"),  # a device of Windows
        ("NULL", "session1"),  # a missing value in tables
        ("a" * 54 + " b", "a" * 54),
    ],
)
def test_names_are_such_as_a_configuration_accepts(text, expected):
    found = names.name(text, "session1")
    assert found == expected
    assert configuration.NAME.fullmatch(found)


@pytest.mark.parametrize(
    ("words", "texts", "expected"),
    [
        ("cam0", ["cam_0", "serve/Cam_0-b"], "cam_0"),
        ("cam0", ["cam-0"], "cam-0"),
        ("cam0", ["cam0", "cam0"], "cam0"),
        ("cam0", ["cam_0", "cam0"], "cam0"),  # spelled in two ways
        ("cam0", ["cam_0", "cam_00"], "cam0"),
        ("cam1", ["mycam_1", "cam_12"], "cam1"),
        ("cam1", ["Cam 1"], "cam1"),
        ("front_left", ["front-left", "Front-Left 2"], "front-left"),
        ("go_pro3", ["GoPro3"], "go_pro3"),
        ("depth_color640_x480", ["depth_color_640x480"], "depth_color_640x480"),
        ("serve2_nd", ["serve-2nd", "serve-2nd-left"], "serve-2nd"),
        ("cam1_left", ["cam_1_left"], "cam_1_left"),
        ("left_cam2", ["左カメラ2"], "left_cam2"),
        ("take1", [], "take1"),
    ],
)
def test_names_are_spelled_as_in_all_texts(words, texts, expected):
    assert names.spelling(words, texts) == expected


def test_distinct_appends_the_first_free_number():
    assert names.distinct("walk", {}) == "walk"
    assert names.distinct("walk", {"walk": 0, "walk_2": 0}) == "walk_3"


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
    assert names.alike(one, other) is same
