"""Known errors in a smooth body are found from noisy vision, and what is right is left so."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.inertial import correction, fit
from courtside.records.devices.hierarchy import PosedHierarchy, forward
from courtside.records.keypoints.skeleton import JOINTS as LIMB_JOINTS
from courtside.study.errors import InputError
from fixtures.people import moved_bodies

SECONDS = 15.0
SIGMA_M = 0.03
SAME_JOINTS = {"OFFSET_M": 0.002}  # vision's are the skeleton's
LONGER = {
    **{f"{side}_elbow": 1.08 for side in ("left", "right")},
    **{f"{side}_knee": 0.94 for side in ("left", "right")},
}


def heading(n):
    return np.radians(40) * np.linspace(0, 1, n) ** 2


@cache
def truth():
    return moved_bodies.moving(0, SECONDS)


@cache
def corrected(case):
    """Return (device's body, corrected body, report) of a case."""
    true = truth()
    bodies = {
        "right": true,
        "bones": moved_bodies.stretched(true, {j: 1 / f for j, f in LONGER.items()}),
        "heading": moved_bodies.drifted(true, -heading(len(true.time_s))),
        "swivel": moved_bodies.swivelled(true, "left", np.radians(30)),
    }
    vision = moved_bodies.seen(true, 1)
    with pytest.MonkeyPatch.context() as patch:
        for name, size_m in SAME_JOINTS.items():
            patch.setattr(fit, name, size_m)
        found = correction.correct(bodies[case], vision, sigma_m=SIGMA_M)
    return bodies[case], *found


def errors_m(posed, report):
    """Return distances (T, 12) to the truth, in vision's frame."""
    return np.linalg.norm(
        moved_bodies.in_vision(posed, report) - moved_bodies.true_in_vision(truth()), axis=2
    )


def sparc(speed, rate_hz, cutoff_hz=10.0, level=0.05, pad=4):
    """Spectral arc length of a speed profile (Balasubramanian et al. 2015)."""
    n = 2 ** int(np.ceil(np.log2(len(speed)) + pad))
    frequency = np.arange(n) * rate_hz / n
    spectrum = np.abs(np.fft.fft(speed, n))
    spectrum = spectrum[frequency <= cutoff_hz] / spectrum.max()
    last = np.flatnonzero(spectrum >= level)[-1] + 1
    steps = np.diff(spectrum[:last])
    return -np.sum(np.hypot(1 / (last - 1), steps))


def test_bones_get_their_lengths():
    _, _, report = corrected("bones")
    found = {joint: report.bone_scale[joint] for joint in LONGER}
    assert found == pytest.approx(LONGER, abs=0.02)


def test_a_drifting_heading_is_taken_off():
    _, body, report = corrected("heading")
    wanted = np.degrees(np.interp(report.heading_s, truth().time_s, heading(len(truth().time_s))))
    off = np.array(report.heading_deg) - wanted
    assert np.ptp(wanted) > 30
    assert np.abs(off - np.median(off)).max() < 3
    assert np.median(errors_m(body, report)) < 0.025


def test_an_elbow_turned_about_the_arm_is_turned_back():
    raw, body, report = corrected("swivel")
    elbow, wrist = (LIMB_JOINTS.index(f"left_{part}") for part in ("elbow", "wrist"))
    true = moved_bodies.limbs(truth())
    before = np.linalg.norm(moved_bodies.limbs(raw) - true, axis=2)
    after = errors_m(body, report)
    assert np.median(before[:, elbow]) > 0.05
    assert np.median(before[:, wrist]) < 1e-9
    assert np.median(after[:, elbow]) < 0.4 * np.median(before[:, elbow])
    assert np.median(after[:, wrist]) < 0.03


@pytest.mark.parametrize("case", ["right", "bones", "heading", "swivel"])
def test_what_is_fast_stays_the_devices(case):
    raw, body, report = corrected(case)
    for side in ("left", "right"):
        wrist = LIMB_JOINTS.index(f"{side}_wrist")
        paths = [moved_bodies.limbs(posed)[:, wrist] for posed in (truth(), raw, body)]
        speeds = [np.linalg.norm(np.gradient(path, axis=0), axis=1) for path in paths]
        smoothness = [sparc(speed, moved_bodies.RATE_HZ) for speed in speeds]
        jerks = [np.sqrt(np.mean(np.diff(path, 3, axis=0) ** 2)) for path in paths]
        assert smoothness[2] > min(smoothness[:2]) - 0.05 * abs(smoothness[0])
        assert jerks[2] < 1.15 * max(jerks[:2])
    assert max(report.rms_change_mm) > report.rms_change_mm[-1]


def test_a_right_device_stays_nearly_right():
    _, body, report = corrected("right")
    vision = moved_bodies.seen(truth(), 1)
    at = np.searchsorted(truth().time_s, vision.time_s)
    theirs = np.nanmedian(
        np.linalg.norm(vision.xyz - moved_bodies.true_in_vision(truth())[at], axis=2)
    )
    assert theirs > 0.03
    assert np.median(errors_m(body, report)) < 0.5 * theirs


def test_a_right_device_stays_right_where_vision_is_good():
    vision = moved_bodies.seen(truth(), 2, sd_m=(0.001,) * 3, outliers=0.02)
    body, report = correction.correct(truth(), vision, sigma_m=0.001)
    assert np.median(errors_m(body, report)) < 0.004


def test_a_body_keeps_its_size_before_a_camera_that_sees_it_flat():
    """It faces the camera in most frames, and turned, its far side is seen too near, as skin is."""
    true = moved_bodies.facing_vision(moved_bodies.moving(0, 30.0), turning=0.5)
    vision = moved_bodies.seen(true, 1, memory_s=0.3)
    middle = np.nanmean(vision.xyz[:, :, 2], axis=1, keepdims=True)
    vision.xyz[:, :, 2] = middle + 0.7 * (vision.xyz[:, :, 2] - middle)
    body, _ = correction.correct(true, vision, sigma_m=SIGMA_M)
    for part in ("shoulder", "hip"):
        places = moved_bodies.limbs(true), vision.xyz, moved_bodies.limbs(body)
        wanted, seen, found = (width_m(xyz, part) for xyz in places)
        assert 0.93 * wanted < seen < wanted
        assert found == pytest.approx(wanted, rel=0.1)


def width_m(xyz, part):
    left, right = (xyz[:, LIMB_JOINTS.index(f"{side}_{part}")] for side in ("left", "right"))
    return np.nanmedian(np.linalg.norm(left - right, axis=1))


def test_the_corrected_body_has_constant_bones():
    raw, body, _ = corrected("swivel")
    assert body.hierarchy.joints == raw.hierarchy.joints
    lengths = np.linalg.norm(body.translation[:, 1:], axis=2)
    assert np.ptp(lengths, axis=0).max() < 1e-12
    product = body.parent_from_joint @ body.parent_from_joint.swapaxes(2, 3)
    assert np.abs(product - np.eye(3)).max() < 1e-9
    assert np.allclose(body.hierarchy.offsets[1:], body.translation[0, 1:])


def test_joints_that_nobody_sees_stay_the_devices():
    vision = moved_bodies.seen(truth(), 3)
    legs = [joint.split("_")[1] in ("knee", "ankle") for joint in LIMB_JOINTS]
    vision.xyz[:, legs] = np.nan
    raw = moved_bodies.swivelled(truth(), "right", 0.5)
    body, report = correction.correct(raw, vision, sigma_m=SIGMA_M)
    time_s = raw.time_s
    turn = np.radians(np.interp(time_s, report.heading_s, report.heading_deg))
    old, new = forward(raw)[1], forward(body)[1]
    for joint in ("left_hip", "right_knee"):
        at = raw.hierarchy.joints.index(joint)
        wanted = moved_bodies.about_up(turn) @ old[:, at]
        off = Rotation.from_matrix(wanted.swapaxes(1, 2) @ new[:, at]).magnitude()
        assert np.degrees(off).max() < 1.0
    assert report.seen[LIMB_JOINTS.index("left_knee")] == 0
    assert report.after_mm[LIMB_JOINTS.index("left_knee")] is None


def test_a_shift_of_the_clock_is_found():
    vision = moved_bodies.seen(truth(), 4, late_s=0.03)
    body, report = correction.correct(truth(), vision, sigma_m=SIGMA_M, lag_s=0.03)
    assert report.lag_s == pytest.approx(-0.03, abs=0.005)
    assert report.lag_sd_s < 0.005
    assert np.allclose(body.time_s, truth().time_s - report.lag_s)


def test_a_row_that_nobody_performed_keeps_its_pose():
    true = moved_bodies.moving(0, 4.0)
    first = PosedHierarchy(
        true.hierarchy,
        np.concatenate([[true.time_s[0] - 1 / 60], true.time_s]),
        np.concatenate([true.hierarchy.offsets[None], true.translation]),
        np.concatenate(
            [np.tile(np.eye(3), (1, len(true.hierarchy.joints), 1, 1)), true.parent_from_joint]
        ),
    )
    performed = np.arange(len(first.time_s)) > 0
    vision = moved_bodies.seen(true, 1)
    body, _ = correction.correct(first, vision, sigma_m=SIGMA_M, performed=performed)
    assert np.array_equal(body.parent_from_joint[0], first.parent_from_joint[0])
    assert np.array_equal(body.translation[0, 0], first.translation[0, 0])
    assert np.allclose(body.translation[0, 1:], body.hierarchy.offsets[1:])


def test_a_pose_that_the_suit_repeats_is_not_compared_with_vision():
    """Lost from 5 to 8 s: what the report tells is that of the other times."""
    true, vision = truth(), moved_bodies.seen(truth(), 1)
    local, held = true.parent_from_joint.copy(), (true.time_s > 5.0) & (true.time_s <= 8.0)
    local[held] = local[np.flatnonzero(held)[0] - 1]
    frozen = replace(true, parent_from_joint=local)
    _, report = correction.correct(frozen, vision, sigma_m=SIGMA_M)
    xyz = vision.xyz.copy()
    xyz[(vision.time_s > 5.0) & (vision.time_s <= 8.0)] = np.nan
    _, wanted = correction.correct(true, replace(vision, xyz=xyz), sigma_m=SIGMA_M)
    assert report.slow_deg == pytest.approx(wanted.slow_deg, rel=0.3)
    assert report.after_mm == pytest.approx(wanted.after_mm, rel=0.1)
    assert report.noise_mm == pytest.approx(wanted.noise_mm, rel=0.1)


def test_feet_keep_their_floor():
    raw, body, _ = corrected("bones")
    ankles = [LIMB_JOINTS.index(f"{side}_ankle") for side in ("left", "right")]
    lowest = [
        np.percentile(moved_bodies.limbs(p)[:, ankles, 1].min(axis=1), 5) for p in (raw, body)
    ]
    assert lowest[1] == pytest.approx(lowest[0], abs=1e-9)


def test_vision_about_its_own_hips_is_refused():
    vision = replace(moved_bodies.seen(truth(), 1), kind="rgb", source="d415-rgb")
    with pytest.raises(InputError, match="d415-rgb: expected joints with a place in space"):
        correction.correct(truth(), vision, sigma_m=SIGMA_M)
