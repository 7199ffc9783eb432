import numpy as np
import pytest

from courtside.body_model import angles, fit, pose, segments
from fixtures.people import moving_model

MODEL = segments.model()
DRAWN = ("left_hip_flexion", "right_shoulder_elevation", "pelvis_tilt", "pelvis_list")


def measured(segment, turn):
    """Return the angles of a body that stands, but for one segment turned from its parent."""
    true = moving_model.moving(1)
    local = np.repeat(np.eye(3)[None, None], len(MODEL.names), axis=0)
    local[0] = true.local[0]
    local[moving_model.NAMES.index(segment)] = turn
    still = pose.Pose(np.zeros((1, 3)), local, np.zeros_like(true.angle))
    found = angles.measure(MODEL, still, 1e-4 * np.eye(len(MODEL.sigma))[None])
    return {name: value[0] for name, (value, _) in found.items()}, found


def about(axis, degrees):
    return pose.about(axis, np.radians([degrees]))


@pytest.mark.parametrize(
    ("segment", "axis", "degrees", "angle", "wanted"),
    [
        ("left_femur", 2, 40, "left_hip_flexion", 40),
        ("right_femur", 2, 40, "right_hip_flexion", 40),
        ("left_femur", 0, -20, "left_hip_adduction", 20),
        ("right_femur", 0, 20, "right_hip_adduction", 20),
        ("left_femur", 1, -10, "left_hip_internal_rotation", 10),
        ("right_femur", 1, 10, "right_hip_internal_rotation", 10),
        ("thorax", 2, -30, "trunk_flexion", 30),
        ("thorax", 0, 15, "trunk_bending", 15),
        ("right_humerus", 0, -90, "right_shoulder_elevation", 90),
        ("right_humerus", 0, -90, "right_shoulder_plane", 0),
        ("left_humerus", 0, 60, "left_shoulder_elevation", 60),
        ("left_humerus", 2, 60, "left_shoulder_plane", 90),
    ],
)
def test_rotations_have_names_planes_and_signs(segment, axis, degrees, angle, wanted):
    found, _ = measured(segment, about(axis, degrees))
    assert found[angle] == pytest.approx(wanted, abs=1e-6)


@pytest.mark.parametrize("faces", [0, 37, 90, 170, -120])
def test_tilt_and_list_of_the_pelvis_do_not_depend_on_where_a_person_faces(faces):
    turned = about(1, faces) @ about(0, 12) @ about(2, -20)  # in its own axes, Y up
    found, _ = measured("pelvis", angles.UP_Y.T @ turned)
    assert found["pelvis_rotation"] == pytest.approx(faces, abs=1e-6)
    assert found["pelvis_list"] == pytest.approx(12, abs=1e-6)
    assert found["pelvis_tilt"] == pytest.approx(20, abs=1e-6)


def test_hinges_have_their_angles_and_the_names_are_listed():
    true = moving_model.moving(5)
    found = angles.measure(MODEL, true, 1e-4 * np.eye(len(MODEL.sigma))[None].repeat(5, axis=0))
    knee = -np.degrees(true.angle[:, moving_model.column("right_tibia")])
    np.testing.assert_allclose(found["right_knee_flexion"][0], knee)
    np.testing.assert_allclose(found["right_knee_flexion"][1], np.degrees(0.01))
    assert tuple(found) == angles.names()


def test_standard_deviations_are_those_of_small_errors():
    true = moving_model.moving(4)
    spread = np.diag(1e-6 * np.random.default_rng(0).uniform(0.5, 2, len(MODEL.sigma)))
    stated = angles.measure(MODEL, true, spread[None].repeat(4, axis=0))
    rng, drawn = np.random.default_rng(1), []
    for _ in range(100):
        step = rng.standard_normal((4, len(spread))) * np.sqrt(np.diag(spread))
        one = angles.measure(MODEL, pose.moved(MODEL, true, step), 0 * spread[None].repeat(4, 0))
        drawn.append([one[name][0] for name in DRAWN])
    found = np.std(drawn, axis=0)
    for name, row in zip(DRAWN, found, strict=True):
        np.testing.assert_allclose(row, stated[name][1], rtol=0.3)


def test_what_only_the_prior_determines_is_as_uncertain_as_the_prior():
    """No point shows the forearm's rotation; the knee is known as well as its noise says."""
    true, body = moving_model.moving(6), moving_model.body()
    xyz = moving_model.points(true).xyz[0]
    noise = np.broadcast_to(0.005**2 * np.eye(3), (*xyz.shape, 3))
    data = fit.Data(xyz, np.linalg.inv(noise + 0.015**2 * np.eye(3)), noise)
    seen = angles.of_fit(MODEL, true, fit.spread(MODEL, body, data, true))
    none = fit.Data(xyz, 0 * data.information, noise)
    lost = angles.of_fit(MODEL, true, fit.spread(MODEL, body, none, true))
    for found in (seen, lost):
        np.testing.assert_allclose(found["right_forearm_pronation"][1], 45, rtol=0.02)
        np.testing.assert_allclose(found["right_wrist_flexion"][1], 30, rtol=0.02)
    assert seen["right_knee_flexion"][1].max() < 5
    assert lost["right_knee_flexion"][1] == pytest.approx(180)  # anything
    np.testing.assert_allclose(lost["trunk_bending"][1], 12, rtol=0.02)
