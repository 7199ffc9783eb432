"""Plates show the median T-pose of a recording, a schematic one without, and the map of joints."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.figures.devices import skeleton_plates
from courtside.figures.style import joint_map, source_styles
from courtside.records.keypoints import derived_joints, skeleton
from fixtures import drawings
from fixtures.people import swung_arms

CONFIG = Path(__file__).parents[4] / "config"
TABLE = derived_joints.read(CONFIG / "derived_joints.yaml")
SKELETONS = [
    skeleton.read(CONFIG / "skeletons" / f"{name}.yaml") for name in ("mocopi27", "nuitrack19")
]
OF = {"mocopi": "mocopi27"}


@pytest.fixture(scope="module")
def found():
    return skeleton_plates.plates([swung_arms.body()], SKELETONS, OF)


@pytest.fixture(scope="module")
def rows():
    return joint_map.rows(SKELETONS, TABLE)


def test_a_recordings_plate_is_its_tpose_and_others_are_schematic(found):
    assert [(plate.source, plate.kind) for plate in found] == [
        ("mocopi", "inertial"),
        ("", "other"),
    ]
    first, second = found
    wrist = first.xyz[first.skeleton.index("left_wrist")]
    np.testing.assert_allclose(wrist, [1, 0.5, 0], atol=1e-9)  # not where the swing ends
    assert np.isfinite(first.xyz).all(axis=1).sum() == len(swung_arms.JOINTS)
    assert np.isfinite(second.xyz).all()


def test_only_the_tpose_counts():
    body = swung_arms.body()
    before, after = body.time_s < 0.4, body.time_s > 0.6
    moved = body.fixed + np.where(before, 5.0, np.where(after, 7.0, 0.0))[:, None, None]
    body = replace(body, fixed=moved, tpose_s=np.array([0.4, 0.6]))
    (plate,) = skeleton_plates.plates([body], SKELETONS[:1], OF)
    wrist = plate.xyz[plate.skeleton.index("right_wrist")]
    np.testing.assert_allclose(wrist, [-1, 0.5, 0], atol=1e-9)


def test_without_a_tpose_a_frame_of_the_take_is_drawn_and_named(rows):
    body = swung_arms.body()
    late = np.where(body.time_s > 1.5, 1.2, 1.0)[:, None, None]
    body = replace(body, following=body.following * late, tpose_s=np.full(2, np.nan))
    found = skeleton_plates.plates([body], SKELETONS, OF)
    apart = np.linalg.norm(body.following[:, 2] - body.following[:, 3], axis=1)
    at = int(apart.argmax())
    wrist = found[0].xyz[found[0].skeleton.index("left_wrist")]
    np.testing.assert_allclose(wrist, body.following[at, 2])
    pose = f"no T-pose; frame at {body.time_s[at]:.2f} s"
    table = skeleton_plates.table(found, rows)
    assert set(table["pose"]) == {pose, "schematic"}
    drawing = skeleton_plates.draw(found, rows)
    assert drawing.subfigs[0].axes[0].get_title().endswith(pose)
    nobody = replace(body, following=np.full_like(body.following, np.nan))
    found = skeleton_plates.plates([nobody], SKELETONS, OF)
    assert np.isnan(found[0].xyz).all()
    drawing = skeleton_plates.draw(found, rows)
    title = drawing.subfigs[0].axes[0].get_title()
    assert " ".join(title.split()).endswith("no T-pose, and no frame with both arms")
    assert drawings.cut(drawing) == []


def test_front_and_side_are_drawn_with_numbers_of_common_joints_only(found, rows):
    drawing = skeleton_plates.draw(found, rows)
    drawing.draw_without_rendering()
    schematic = drawing.subfigs[0].axes[1]
    assert "schematic: nuitrack19, 19 joints" in schematic.get_title()
    xyz = found[1].xyz
    dots = [a.get_xydata() for a in schematic.lines if a.get_marker() == "o"]
    np.testing.assert_array_equal(dots[0], xyz[:, [0, 1]])
    np.testing.assert_allclose(dots[1], xyz[:, [2, 1]] + [skeleton_plates.ASIDE, 0])
    colours = {a.get_color() for a in drawing.subfigs[0].axes[0].lines if a.get_marker() == "o"}
    assert colours == {source_styles.COLOURS["inertial"]}
    numbers = {text.get_text() for text in schematic.texts if text.get_text().isdigit()}
    limbs = SKELETONS[1].groups["limbs"]
    assert numbers == {str(SKELETONS[1].index(joint)) for joint in limbs}


def test_the_map_below_names_every_common_joint_once(found, rows):
    axis = skeleton_plates.draw(found, rows).subfigs[1].axes[0]
    words = [text.get_text() for text in axis.texts]
    assert words.count("left, right wrist") == 1
    assert "stands for the navel" in words and "centre of the head †" in words
    assert "14 l_hand, 18 r_hand" in words and "neck" in words


def test_the_table_names_the_common_joint_of_each_joint(found, rows):
    table = skeleton_plates.table(found, rows)
    assert len(table) == 27 + 19 and set(table["source"]) == {"mocopi", "schematic"}
    hip = table[(table["skeleton"] == "mocopi27") & (table["joint"] == "left_hip")].iloc[0]
    assert hip["device_name"] == "l_up_leg" and hip["number"] == 19
    assert hip["stands_for"] == "hip 1; mid_hip 0.5; pelvis_thorax 0.35"
