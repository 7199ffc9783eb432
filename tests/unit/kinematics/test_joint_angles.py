"""Angles of poses that are bent by known amounts, and the coverage of their sigmas."""

from functools import partial

import numpy as np
import pytest

from courtside.kinematics import joint_angles, shared_errors
from fixtures.people import footwork, walker


def own(*covariances):
    """Return the variance of independent points with covariances (T, 3, 3) each."""
    errors = shared_errors.independent(np.stack(covariances, axis=1))
    return partial(errors.variance, range(len(covariances)))


NONE = np.zeros((1, 3, 3))


def hinge(degrees, n_frames=1):
    """Return the points of two segments of 0.4 and 0.3 m at an angle, turned in space."""
    rng = np.random.default_rng(5)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    angle = np.radians(degrees)
    last = 0.3 * np.array([np.cos(angle), np.sin(angle), 0])
    places = np.array([[0.4, 0, 0], [0, 0, 0], last]) @ turn.T + [1.0, 2.0, 3.0]
    return [np.repeat(place[None], n_frames, axis=0) for place in places]


@pytest.mark.parametrize("degrees", [0.0, 1e-6, 20.0, 90.0, 150.0, 180.0])
def test_two_segments_at_a_known_angle(degrees):
    angle = joint_angles.between(*hinge(degrees), own(NONE, NONE, NONE))
    assert angle.degrees[0] == pytest.approx(degrees, abs=1e-6)


@pytest.mark.parametrize("degrees", [30.0, 90.0, 140.0])
def test_the_sigma_of_an_angle_holds_ninety_percent(degrees):
    rng = np.random.default_rng(1)
    n_draws = 20_000
    roots = rng.normal(0, 0.006, (3, 3, 3))
    covariances = [np.broadcast_to(r @ r.T, (n_draws, 3, 3)) for r in roots]
    moved = [
        place + rng.normal(size=(n_draws, 3)) @ root.T
        for place, root in zip(hinge(degrees, n_draws), roots, strict=True)
    ]
    angle = joint_angles.between(*moved, own(*covariances))
    inside = np.abs(angle.degrees - degrees) < 1.645 * angle.sigma_deg
    assert 0.885 < inside.mean() < 0.915


def measured(xyz):
    errors = shared_errors.independent(np.zeros((*xyz.shape[:2], 3, 3)))
    return joint_angles.measure(xyz, errors, walker.SKELETON.joints)


def test_a_player_is_bent_as_he_was_made():
    time_s, neck = footwork.neck(60, 3)
    xyz, known = footwork.body(neck, time_s)
    angles = measured(xyz)
    for side in ("left_", "right_"):
        for name in ("knee_flexion", "elbow_flexion"):
            np.testing.assert_allclose(angles[side + name].degrees, known[name], atol=1e-9)
    np.testing.assert_allclose(
        angles["trunk_lean_forward"].degrees, known["trunk_lean_forward"], atol=1e-9
    )
    np.testing.assert_allclose(angles["trunk_lean"].degrees, known["trunk_lean_forward"], atol=1e-9)


def upright(elbow):
    """Return the angles of a person who faces +y, arms straight towards the left `elbow`."""
    joints, xyz = [], []
    for side, sign in (("left_", 1), ("right_", -1)):
        arm = np.multiply(elbow, [sign, 1, 1])
        for name, place in (
            ("shoulder", [0, 0, 1.4]),
            ("elbow", [0, 0, 1.4] + 0.3 * arm),
            ("wrist", [0, 0, 1.4] + 0.55 * arm),
            ("hip", [0, 0, 0.9]),
            ("knee", [0, 0, 0.5]),
            ("ankle", [0, 0, 0.1]),
        ):
            joints.append(side + name)
            xyz.append(np.add(place, [-0.2 * sign, 0, 0]))
    xyz = np.array(xyz)[None]
    return joint_angles.measure(xyz, shared_errors.independent(np.zeros((1, 12, 3, 3))), joints)


@pytest.mark.parametrize(
    ("elbow", "degrees"), [((0, 0, -1), 0), ((-1, 0, 0), 90), ((0, 1, 0), 90), ((0, 0, 1), 180)]
)
def test_a_straight_body_has_zero_angles_and_the_elevation_of_its_arms(elbow, degrees):
    angles = upright(np.array(elbow, dtype=float))
    for side in ("left_", "right_"):
        assert angles[side + "shoulder_elevation"].degrees[0] == pytest.approx(degrees, abs=1e-5)
        for name in ("elbow_flexion", "knee_flexion", "hip_flexion"):
            assert angles[side + name].degrees[0] == pytest.approx(0, abs=1e-5)
    assert angles["trunk_lean"].degrees[0] == pytest.approx(0, abs=1e-9)


def test_leaning_back_is_negative_and_sideways_is_not_forward():
    shift = {"back": ([0, -0.2, 0], -21.801), "side": ([0.2, 0, 0], 0.0)}
    for move, forward in shift.values():
        hips = [np.array([[x, 0, 0.9]]) for x in (-0.1, 0.1)]
        shoulders = [np.array([[x, 0, 1.4]]) + move for x in (-0.2, 0.2)]
        lean, ahead = joint_angles.trunk(hips, shoulders, own(*[NONE] * 4))
        assert lean.degrees[0] == pytest.approx(21.801, abs=1e-3)
        assert ahead.degrees[0] == pytest.approx(forward, abs=1e-3)


def test_the_sigma_of_the_trunk_holds_ninety_percent():
    rng = np.random.default_rng(2)
    xyz, known = footwork.body(np.repeat([[0.0, 0.0, 1.45]], 20_000, axis=0), np.zeros(20_000))
    spread = np.diag([0.01, 0.02, 0.015])
    noisy = xyz + rng.normal(size=xyz.shape) @ spread
    covariance = np.broadcast_to(spread**2, (*xyz.shape[:2], 3, 3))
    angle = joint_angles.measure(
        noisy, shared_errors.independent(covariance), walker.SKELETON.joints
    )["trunk_lean_forward"]
    inside = np.abs(angle.degrees - known["trunk_lean_forward"]) < 1.645 * angle.sigma_deg
    assert 0.885 < inside.mean() < 0.915


@pytest.mark.parametrize(
    ("aside", "least", "most"), [(0, 0.885, 0.915), (20, 0.88, 0.92), (45, 0.87, 0.93)]
)
def test_the_sigma_of_the_trunks_forward_lean_holds_with_a_side_bend(aside, least, most):
    """The trunk leans 10 degrees forwards, then bends sideways with hips and shoulders."""
    rng, lean, n_draws = np.random.default_rng(3), np.radians(10), 20_000
    tilt = np.radians(aside)
    axes = np.array([[np.cos(tilt), 0, np.sin(tilt)], [0, 1, 0], [-np.sin(tilt), 0, np.cos(tilt)]])
    top, wide = 0.5 * np.array([0, np.sin(lean), np.cos(lean)]), np.array([0.18, 0, 0])
    corners = [-wide / 2, wide / 2, top - wide, top + wide]
    true = [np.repeat((corner @ axes)[None], n_draws, axis=0) for corner in corners]
    noisy = [place + rng.normal(0, 0.008, place.shape) for place in true]
    covariance = np.broadcast_to(0.008**2 * np.eye(3), (n_draws, 3, 3))
    _, exact = joint_angles.trunk(true[:2], true[2:], own(*[covariance] * 4))
    _, found = joint_angles.trunk(noisy[:2], noisy[2:], own(*[covariance] * 4))
    inside = np.abs(found.degrees - exact.degrees) < 1.645 * found.sigma_deg
    assert least < inside.mean() < most


def test_who_lies_on_the_side_leans_nowhere_forwards():
    corners = [[0.03, 0, 0.28], [0, 0.03, 0.1], [0.5, 0, 0.36], [0.5, 0.01, 0.02]]
    points = [np.array([corner]) for corner in corners]
    lean, forward = joint_angles.trunk(points[:2], points[2:], own(*[NONE] * 4))
    assert lean.degrees[0] == pytest.approx(90, abs=1)
    assert np.isnan([forward.degrees[0], forward.sigma_deg[0]]).all()


def test_a_missing_joint_is_a_missing_angle():
    xyz, _ = footwork.body(np.repeat([[0.0, 0.0, 1.45]], 3, axis=0), np.zeros(3))
    xyz[1, walker.SKELETON.index("left_ankle")] = np.nan
    angles = measured(xyz)
    assert np.isnan(angles["left_knee_flexion"].degrees).tolist() == [False, True, False]
    assert np.isfinite(angles["right_knee_flexion"].degrees).all()
    assert np.isfinite(angles["trunk_lean"].degrees).all()


def test_every_angle_has_its_zero_and_sign_in_words():
    xyz, _ = footwork.body(np.array([[0.0, 0.0, 1.45]]), np.zeros(1))
    plain = {name.removeprefix("left_").removeprefix("right_") for name in measured(xyz)}
    assert plain == set(joint_angles.DICTIONARY)
