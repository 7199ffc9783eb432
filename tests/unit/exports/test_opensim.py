"""The marker set: well-formed, a marker for each of the TRC file's, on bodies the models have."""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.body_model import take
from courtside.exports import markers, opensim
from courtside.records.keypoints import skeleton
from fixtures.people import moving_model

SKELETONS = Path(__file__).parents[3] / "config" / "skeletons"
# Bodies of Model_Pose2Sim_simple.osim of Pose2Sim 0.10.49.
BODIES = {f"{body}_{side}" for side in "lr" for body in (
    "femur", "tibia", "talus", "calcn", "toes", "humerus", "ulna", "radius", "hand"
)} | {"pelvis", "torso", "head"}  # fmt: skip


def read(path):
    """Return body, place and fixedness of each marker, as OpenSim's serialiser nests them."""
    root = ElementTree.parse(path).getroot()
    assert (root.tag, root.get("Version")) == ("OpenSimDocument", "40000")
    found = {}
    for entry in root.findall("MarkerSet/objects/Marker"):
        body = entry.findtext("socket_parent_frame")
        place = [float(value) for value in entry.findtext("location").split()]
        assert body.startswith("/bodyset/")
        assert entry.get("name") not in found
        found[entry.get("name")] = (body.removeprefix("/bodyset/"), place, entry.findtext("fixed"))
    return found


@pytest.mark.parametrize("name", ["blazepose33", "cpm14", "body25", "body25b", "halpe26", "coco17"])
def test_every_skeleton_of_a_network_has_its_markers(tmp_path, name):
    joints = skeleton.read(SKELETONS / f"{name}.yaml").joints
    opensim.write_markers(tmp_path / "m.xml", joints)
    found = read(tmp_path / "m.xml")
    assert list(found) == markers.names(joints)
    assert {body for body, *_ in found.values()} <= BODIES
    assert found["LKnee"] == ("tibia_l", [0, 0, 0], "true")
    assert found["RWrist"] == ("hand_r", [0, 0, 0], "true")
    assert all(len(place) == 3 for _, place, _ in found.values())


def test_sides_mirror_each_other_and_rough_places_may_move(tmp_path):
    joints = skeleton.read(SKELETONS / "blazepose33.yaml").joints
    opensim.write_markers(tmp_path / "m.xml", joints)
    found = read(tmp_path / "m.xml")
    for left in (name for name in found if name.startswith("L")):
        (body, (x, y, z), fixed), (other, place, same) = found[left], found["R" + left[1:]]
        assert place == [x, y, -z]
        assert (body[:-1], fixed) == (other[:-1], same)
    assert found["REye"][1][2] > 0  # z to the right
    assert {found[name][2] for name in ("Nose", "LHeel", "RThumb")} == {"false"}


def test_joints_without_a_place_have_no_marker_and_are_logged_once(tmp_path, caplog):
    caplog.set_level("INFO", logger="courtside")
    joints = skeleton.read(SKELETONS / "coco133.yaml").joints
    opensim.write_markers(tmp_path / "m.xml", joints)
    assert list(read(tmp_path / "m.xml")) == markers.names(joints[:23])  # without face and hands
    (line,) = caplog.messages
    assert line.startswith("m.xml: no markers for 110 joints such as right_jaw_1")


def motion():
    """Return the fitted motion of a body that walks on the spot."""
    points = moving_model.points(moving_model.moving(30))
    hz = dict.fromkeys(moving_model.JOINTS, 8.0)
    return take.motion(points, {0: take.person(points, 0, hz, 1.75)})


def test_a_motion_file_has_opensims_header_and_coordinates(tmp_path):
    found = motion()
    opensim.write_motion(tmp_path / "a.mot", found, 0)
    head, rows = (tmp_path / "a.mot").read_text().split("endheader\n")
    stated = dict(line.split("=") for line in head.split()[1:])
    names, *lines = rows.splitlines()
    names, values = names.split("\t"), np.array([line.split("\t") for line in lines], dtype=float)
    assert stated["inDegrees"] == "yes"
    assert values.shape == (int(stated["nRows"]), int(stated["nColumns"])) == (30, len(names))
    column = dict(zip(names, values.T, strict=True))
    np.testing.assert_allclose(column["time"], found.time_s, atol=1e-6)
    knee = found.angle_deg[0, :, found.angles.tolist().index("left_knee_flexion")]
    np.testing.assert_allclose(column["knee_angle_l"], knee, atol=1e-5)
    assert np.ptp(column["pelvis_ty"]) < 0.05 < np.mean(column["pelvis_ty"]) - 0.9
    for name in ("arm_add_l", "arm_add_r"):  # both arms 44 degrees from the trunk
        assert np.abs(column[name] + 43).max() < 4
    assert 10 < column["pelvis_rotation"][-1] - column["pelvis_rotation"][0] < 40


def test_the_trunk_bends_as_far_in_pose2sims_default_model(tmp_path):
    """Its constraints turn five more joints by these multiples of L5_S1's angle, about its axes."""
    others = {
        "Flex_Ext": [1.8571, 1.6429, 1.1429, 0.9286, 0.5714],
        "Lat_Bending": [1.33, 2.4314, 2.4314, 2.0392, 1.549],
        "axial_rotation": [1.0625, 1.0625, 0.875, 0.8125, 0.75],
    }
    bent = motion()
    angles = np.linspace([-60, -20, -30], [10, 15, 40], len(bent.time_s))
    bent.parent_from_segment[0, :, bent.segments.tolist().index("thorax")] = Rotation.from_euler(
        "ZXY", angles, degrees=True
    ).as_matrix()
    opensim.write_motion(tmp_path / "a.mot", bent, 0)
    names, *lines = (tmp_path / "a.mot").read_text().split("endheader\n")[1].splitlines()
    values = np.array([line.split("\t") for line in lines], dtype=float).T
    column = dict(zip(names.split("\t"), values, strict=True))
    for (name, multiples), angle in zip(others.items(), angles.T, strict=True):
        whole = column[f"L5_S1_{name}"] * (1 + sum(multiples))
        np.testing.assert_allclose(whole, angle, atol=1e-4)


def test_the_motion_file_of_a_person_without_fitted_frames_has_no_rows(tmp_path):
    found = take.motion(moving_model.points(moving_model.moving(30)), {})
    opensim.write_motion(tmp_path / "a.mot", found, 0)
    head, rows = (tmp_path / "a.mot").read_text().split("endheader\n")
    assert "nRows=0\n" in head
    names, *lines = rows.splitlines()
    assert (names.split("\t")[0], lines) == ("time", [])
