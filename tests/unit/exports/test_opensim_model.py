"""The `.osim` model: its motion file plays on it, by forward kinematics of the format itself."""

from dataclasses import replace
from itertools import pairwise
from xml.etree import ElementTree

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.body_model import segments, take
from courtside.exports import opensim, opensim_model
from courtside.exports.trc import WORLD_AXES
from courtside.kinematics import centre_of_mass
from courtside.records.devices import hierarchy
from fixtures.people import moving_model

HINGES = {"clavicle": "XY", "forearm": "ZY", "hand": "ZX", "tibia": "ZY", "foot": "ZX"}


@pytest.fixture(scope="module")
def walking():
    """Return the fitted motion of a body that walks on the spot."""
    points = moving_model.points(moving_model.moving(30))
    hz = dict.fromkeys(moving_model.JOINTS, 8.0)
    return take.motion(points, {0: take.person(points, 0, hz, 1.75)})


def anyhow(motion, n_frames=40, seed=3):
    """Return the motion with random places and turns of all joints."""
    rng = np.random.default_rng(seed)
    turned = np.empty((1, n_frames, len(motion.segments), 3, 3))
    for at, name in enumerate(motion.segments):
        part = name.split("_")[-1]
        if part in HINGES:
            angles = rng.uniform(-179, 179, (n_frames, 2))
            turned[0, :, at] = Rotation.from_euler(HINGES[part], angles, degrees=True).as_matrix()
        else:
            turned[0, :, at] = Rotation.random(n_frames, rng=rng).as_matrix()
    return replace(
        motion,
        time_s=motion.time_s[0] + np.arange(n_frames) / 30,
        root=rng.uniform(-5, 5, (1, n_frames, 3)),
        parent_from_segment=turned,
        angle_deg=np.zeros((1, n_frames, len(motion.angles))),
        angle_sigma_deg=np.zeros((1, n_frames, len(motion.angles))),
    )


def numbers(element, tag):
    return np.array(element.findtext(tag).split(), dtype=float)


def columns(path):
    """Return the columns of a motion file by name."""
    names, *rows = path.read_text().split("endheader\n")[1].splitlines()
    table = np.array([row.split("\t") for row in rows], dtype=float)
    return dict(zip(names.split("\t"), table.T, strict=True))


def played(osim, mot):
    """Return the markers (T, 3) in the ground by name: OpenSim's CustomJoint, frame by frame."""
    return located(osim, posed(osim, mot), "MarkerSet/objects/Marker", "location")


def located(osim, poses, kind, tag):
    """Return the places (T, 3) in the ground of what is fixed to bodies, by name."""
    found = {}
    for one in ElementTree.parse(osim).getroot().find("Model").iterfind(kind):
        on = one.findtext("socket_parent_frame") or f"/bodyset/{one.get('name')}"
        turned, place = poses[on]
        found[one.get("name")] = place + turned.apply(numbers(one, tag))
    return found


def posed(osim, mot):
    """Return rotation and place of each body, frame by frame."""
    model, values = ElementTree.parse(osim).getroot().find("Model"), columns(mot)
    n_frames = len(values["time"])
    poses = {"/ground": (Rotation.identity(n_frames), np.zeros((n_frames, 3)))}
    for joint in model.iterfind("JointSet/objects/CustomJoint"):
        frames = {one.get("name"): one for one in joint.iterfind("frames/PhysicalOffsetFrame")}
        above, below = (
            frames[joint.findtext(f"socket_{end}_frame")] for end in ("parent", "child")
        )
        turned, place = poses[above.findtext("socket_parent")]
        place = place + turned.apply(numbers(above, "translation"))
        assert not numbers(below, "translation").any()
        for frame in (above, below):
            assert not numbers(frame, "orientation").any()
        own, moved = turned, np.zeros((n_frames, 3))
        for axis in joint.iterfind("SpatialTransform/TransformAxis"):
            by, along = axis.findtext("coordinates"), numbers(axis, "axis")
            if not by:
                assert axis.findtext("Constant/value") == "0"
            elif axis.get("name").startswith("rotation"):
                slope, offset = numbers(axis, "LinearFunction/coefficients")
                angle = np.radians(slope * values[by] + offset)
                own = own * Rotation.from_rotvec(angle[:, None] * along)
            else:
                moved = moved + values[by][:, None] * along
        poses[below.findtext("socket_parent")] = own, place + turned.apply(moved)
    return poses


@pytest.mark.parametrize("poses", ["walking", "anyhow"])
def test_the_motion_file_plays_on_the_model(tmp_path, walking, poses):
    motion = walking if poses == "walking" else anyhow(walking)
    opensim.write_motion(tmp_path / "a.mot", motion, 0)
    opensim_model.write(tmp_path / "a.osim", motion, 0)
    found = played(tmp_path / "a.osim", tmp_path / "a.mot")
    assert list(found) == motion.joints.tolist()
    origin, turned = hierarchy.forward(motion.posed(0)[0])
    for joint, segment, place in zip(
        motion.joints, motion.segment_of, motion.places[0], strict=True
    ):
        true = origin[:, segment] + turned[:, segment] @ place
        np.testing.assert_allclose(found[joint], true[:, [1, 2, 0]], atol=5e-6)


def test_angles_of_the_model_are_those_of_the_table(tmp_path, walking):
    opensim.write_motion(tmp_path / "a.mot", walking, 0)
    found = columns(tmp_path / "a.mot")
    degrees = dict(zip(walking.angles.tolist(), walking.angle_deg[0].T, strict=True))
    for name, angle in (
        ("hip_flexion_l", "left_hip_flexion"),
        ("hip_adduction_l", "left_hip_adduction"),
        ("hip_rotation_l", "left_hip_internal_rotation"),
        ("knee_angle_l", "left_knee_flexion"),
        ("knee_internal_rotation_l", "left_knee_internal_rotation"),
        ("ankle_inversion_r", "right_ankle_inversion"),
        ("ankle_inversion_l", "left_ankle_inversion"),
        ("elbow_flex_l", "left_elbow_flexion"),
        ("forearm_pronation_l", "left_forearm_pronation"),
        ("wrist_ulnar_deviation_l", "left_wrist_ulnar_deviation"),
    ):
        np.testing.assert_allclose(found[name], degrees[angle], atol=1e-5, err_msg=name)
    np.testing.assert_allclose(found["lumbar_extension"], -degrees["trunk_flexion"], atol=1e-5)
    # The same pelvis, but OpenSim's angles are about the hall's axes.
    turns = np.stack([found[f"pelvis_{name}"] for name in ("tilt", "list", "rotation")], axis=1)
    pelvis = Rotation.from_euler("ZXY", turns, degrees=True)
    own = np.stack([degrees[f"pelvis_{name}"] for name in ("rotation", "list", "tilt")], axis=1)
    np.testing.assert_allclose(pelvis.as_euler("YXZ", degrees=True), own * [1, 1, -1], atol=1e-5)


def test_the_model_is_whole_as_opensim_4_reads_it(tmp_path, walking):
    opensim_model.write(tmp_path / "a.osim", walking, 0, mass_kg=70)
    root = ElementTree.parse(tmp_path / "a.osim").getroot()
    assert (root.tag, root.get("Version")) == ("OpenSimDocument", "40000")
    model = root.find("Model")
    bodies = [f"/bodyset/{one.get('name')}" for one in model.iterfind("BodySet/objects/Body")]
    joints = model.findall("JointSet/objects/CustomJoint")
    ends = [[f.findtext("socket_parent") for f in one.iterfind("frames/*")] for one in joints]
    assert [below for _, below in ends] == bodies
    for number, (above, _) in enumerate(ends):
        assert above in ["/ground", *bodies[:number]]
    names = [one.get("name") for one in model.iter("Coordinate")]
    assert len(set(names)) == len(names) == len(segments.model().sigma)
    for joint in joints:  # each coordinate drives one axis, as `CustomJoint` demands
        axes = joint.findall("SpatialTransform/TransformAxis")
        kinds = [f"{kind}{n}" for kind in ("rotation", "translation") for n in (1, 2, 3)]
        assert [one.get("name") for one in axes] == kinds
        used = [one.findtext("coordinates") for one in axes if one.findtext("coordinates")]
        assert used == [one.get("name") for one in joint.iter("Coordinate")]
        turns = np.array([numbers(one, "axis") for one in axes[:3]])
        assert abs(np.linalg.det(turns)) == 1
    assert "femur_l to tibia_l 0.4" in model.findtext("credits")


def test_the_model_of_a_person_without_fitted_frames_has_no_bodies(tmp_path):
    nobody = take.motion(moving_model.points(moving_model.moving(30)), {})
    opensim_model.write(tmp_path / "a.osim", nobody, 0)
    text = (tmp_path / "a.osim").read_text()
    assert "nan" not in text
    assert "No frame was fitted" in text
    for kind in ("Body", "CustomJoint", "Marker"):
        assert not list(ElementTree.parse(tmp_path / "a.osim").iter(kind))


def weights(path):
    root = ElementTree.parse(path).getroot()
    return {one.get("name"): one for one in root.iter("Body")}


def test_masses_are_the_subjects_with_the_inertia_of_solid_bodies(tmp_path, walking):
    total = {}
    for sex, mass in (("m", 80), ("f", 60), (None, None)):
        opensim_model.write(tmp_path / "a.osim", walking, 0, mass_kg=mass, sex=sex)
        bodies = weights(tmp_path / "a.osim")
        kg = {name: float(one.findtext("mass")) for name, one in bodies.items()}
        total[sex] = sum(kg.values())
        for one in bodies.values():
            x, y, z, *products = numbers(one, "inertia")
            assert min(x + y - z, y + z - x, z + x - y) > 0
            assert not any(products)
        assert kg["femur_l"] == kg["femur_r"]
        share = {"m": 0.1416, "f": 0.1478, None: 0.1447}[sex]  # de Leva 1996, table 4
        assert kg["femur_l"] / total[sex] == pytest.approx(share, abs=1e-4)
    assert total["m"] == pytest.approx(80)
    assert total["f"] == pytest.approx(60)
    assert total[None] == pytest.approx(22 * 1.75**2, rel=0.02)


def test_a_thighs_centre_and_inertia_are_near_those_of_anatomy(tmp_path, walking):
    opensim_model.write(tmp_path / "a.osim", walking, 0, mass_kg=73, sex="m")
    thigh = weights(tmp_path / "a.osim")["femur_r"]
    length = abs(walking.offsets[0, walking.segments.tolist().index("right_tibia"), 1])
    _, y, _ = numbers(thigh, "mass_center")
    assert -y / length == pytest.approx(0.41, abs=0.03)  # de Leva 1996, table 4: 40.95 % of men
    across = numbers(thigh, "inertia")[0]
    gyration = np.sqrt(across / float(thigh.findtext("mass"))) / length
    assert gyration == pytest.approx(0.329, abs=0.04)  # the same table


def degrees_of(angles):
    """Return what `euler_deg` finds for angles (T, 3), which must make the same rotations."""
    turned = Rotation.from_euler("ZXY", angles, degrees=True).as_matrix()
    found = opensim_model.euler_deg(turned)
    again = Rotation.from_euler("ZXY", found, degrees=True).as_matrix()
    np.testing.assert_allclose(again, turned, atol=1e-9)
    return found


@pytest.mark.parametrize("sex", ["m", "f", None])
def test_the_bodys_centre_is_that_of_the_kinematics(tmp_path, walking, sex):
    head = {"left_ear": (0.01, 0.15, -0.07), "right_ear": (0.01, 0.15, 0.07), "nose": (0.1, 0.1, 0)}
    straight = walking.parent_from_segment.copy()
    straight[:, :, np.isin(walking.segments, ["thorax", "left_clavicle", "right_clavicle"])] = (
        np.eye(3)
    )
    motion = replace(
        walking,
        parent_from_segment=straight,
        joints=np.array([*walking.joints, *head]),
        segment_of=np.append(walking.segment_of, [walking.segments.tolist().index("head")] * 3),
        places=np.concatenate([walking.places, np.array(list(head.values()))[None]], axis=1),
    )
    osim, mot = tmp_path / "a.osim", tmp_path / "a.mot"
    opensim_model.write(osim, motion, 0, mass_kg=70, sex=sex)
    opensim.write_motion(mot, motion, 0)
    centres = located(osim, posed(osim, mot), "BodySet/objects/Body", "mass_center")
    whole = sum(
        float(one.findtext("mass")) / 70 * centres[name] for name, one in weights(osim).items()
    )
    at = played(osim, mot)
    for name, ends in (("mid_hip", "hip"), ("mid_shoulder", "shoulder"), ("head_mass", "ear")):
        at[name] = (at[f"left_{ends}"] + at[f"right_{ends}"]) / 2
    stated = sum(share * at[point] for point, share in centre_of_mass.shares(sex).items())
    # Of each foot's 1.4 % of the mass, the kinematics have the centre at the ankle, 9 cm away.
    assert np.linalg.norm(whole - stated, axis=1).max() < 2 * 0.014 * 0.09


def test_angles_go_on_beyond_half_a_turn():
    angles = np.linspace([60, -30, 10], [230, 40, -190], 82)
    np.testing.assert_allclose(degrees_of(angles), angles, atol=1e-6)


PATHS = {
    # Raised to the side until it points up, lowered in front
    "over the pole": [[0, 0, 0], [0, -88, 0], [180, -88, 180], [180, -10, 180], [0, 0, 0]],
    # Swung round by the back as a racket arm is, once more each time
    "by the back": [
        [0, 0, 0],
        [-90, -45, -60],
        [-180, -50, -180],
        [-300, -45, -300],
        [-360, 0, -360],
    ],
}


@pytest.mark.parametrize("path", PATHS)
@pytest.mark.parametrize("n_frames", [3, 30])
@pytest.mark.parametrize("repeats", [1, 3])
def test_an_arm_that_hangs_again_has_angles_near_zero(path, n_frames, repeats):
    corners = PATHS[path]
    parts = [np.linspace(*ends, n_frames) for ends in pairwise(corners)]
    angles = np.concatenate(parts * repeats)
    found = degrees_of(angles)
    down = np.abs((angles + 180) % 360 - 180).max(axis=1) < 60
    assert down[-1]
    assert np.abs(found[down]).max() < 60
    assert np.abs(found[:, 1]).max() <= 90


def goes_on(found, turned):
    """Return whether angles (T, 3) halfway between frames are halfway between rotations, too."""
    between = Rotation.from_euler("ZXY", (found[1:] + found[:-1]) / 2, degrees=True)
    step = np.degrees((turned[1:] * turned[:-1].inv()).magnitude())
    way = np.degrees((between * turned[:-1].inv()).magnitude())
    return (way <= step + 0.1).all()


@pytest.mark.parametrize("path", PATHS)
@pytest.mark.parametrize("side", ["left", "right"])
def test_a_swung_arm_has_coordinates_that_a_spline_may_go_through(tmp_path, walking, path, side):
    """OpenSim takes speeds and moments from splines through the coordinates of a motion file."""
    turned = np.concatenate([np.linspace(*ends, 30) for ends in pairwise(PATHS[path])])
    motion = anyhow(walking, len(turned))
    arm = motion.segments.tolist().index(f"{side}_humerus")
    arms = Rotation.from_euler("ZXY", turned, degrees=True)
    motion.parent_from_segment[0, :, arm] = arms.as_matrix()
    opensim.write_motion(tmp_path / "a.mot", motion, 0)
    values, mirror = columns(tmp_path / "a.mot"), -1 if side == "left" else 1
    names = [f"glenohumeral_{name}_{side[0]}" for name in ("flexion", "adduction", "rotation")]
    found = np.stack([values[name] for name in names], axis=1) * [1, mirror, mirror]
    assert goes_on(found, arms)


@pytest.mark.parametrize(
    "path",
    [
        [[0, 4, 30], [-1080, 4, 30]],  # three rolls forwards
        [[0, 0, 30], [0, 80, 30], [20, 110, 50], [0, 180, 30]],  # half a cartwheel
    ],
    ids=["rolls", "cartwheel"],
)
def test_a_pelvis_that_turns_over_has_coordinates_that_a_spline_may_go_through(
    tmp_path, walking, path
):
    turned = np.concatenate([np.linspace(*ends, 120) for ends in pairwise(path)])
    motion, turns = anyhow(walking, len(turned)), Rotation.from_euler("ZXY", turned, degrees=True)
    motion.parent_from_segment[0, :, 0] = turns.as_matrix()[:, np.argsort(WORLD_AXES)]
    opensim.write_motion(tmp_path / "a.mot", motion, 0)
    values = columns(tmp_path / "a.mot")
    found = np.stack([values[f"pelvis_{name}"] for name in ("tilt", "list", "rotation")], axis=1)
    assert goes_on(found, turns)


def test_coordinates_lie_in_the_ranges_of_the_model(tmp_path, walking):
    motion = anyhow(walking, 400)
    turning = Rotation.from_rotvec(np.linspace([0, 0, 0], [0, 0, 3.5 * 360], 400), degrees=True)
    motion.parent_from_segment[0, :, 0] = turning.as_matrix() @ walking.parent_from_segment[0, 0, 0]
    opensim.write_motion(tmp_path / "a.mot", motion, 0)
    opensim_model.write(tmp_path / "a.osim", motion, 0)
    values = columns(tmp_path / "a.mot")
    assert np.ptp(values["pelvis_rotation"]) == pytest.approx(3.5 * 360, abs=1e-3)
    for one in ElementTree.parse(tmp_path / "a.osim").getroot().iter("Coordinate"):
        low, high = numbers(one, "range")
        found = values[one.get("name")]
        found = found if one.get("name")[:-1] == "pelvis_t" else np.radians(found)
        assert low <= found.min() <= found.max() <= high, one.get("name")
