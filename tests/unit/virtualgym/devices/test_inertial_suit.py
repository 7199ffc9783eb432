"""The virtual inertial suit: exact without errors; each error acts as documented."""

import numpy as np
import pytest

from courtside.devices import bvh as bvh_file
from courtside.exports import bvh
from courtside.records.devices.hierarchy import forward
from fixtures.people import suits
from virtualgym.devices import inertial_suit, mocopi_skeleton
from virtualgym.devices.inertial_errors import STRENGTHS, Errors

TIMES = suits.times(4.0, start_s=7.0)
IRON = Errors(disturbed_deg=18.0, disturbed_every_s=3.0)
SHARED = mocopi_skeleton.SHARED


def relative(joints, names):
    """Return joints from the middle of the hips, (J, T - 1, 3) m, without the rest pose."""
    left, right = names("left_hip"), names("right_hip")
    middle = (joints[left] + joints[right]) / 2
    return np.array([joints[names(theirs)] - middle for theirs in SHARED.values()])[:, 1:]


def errors_mm(recording, time_s):
    """Return the distances (J, T - 1) of joints from the truth, both from the hips, mm."""
    ours = {theirs: own for own, theirs in SHARED.items()}
    found = relative(suits.found(recording), ours.get)
    true = relative(suits.true(recording, time_s), lambda name: name)
    return 1000 * np.linalg.norm(found - true, axis=-1)


def test_without_errors_joints_are_the_true_ones():
    recording = suits.record(TIMES, Errors())
    found, true = suits.found(recording), suits.true(recording, TIMES)
    for ours, theirs in SHARED.items():
        assert np.abs(found[ours][1:] - true[theirs][1:]).max() < 1e-4, ours
    assert np.linalg.norm(found["root"][1, [0, 2]]) < 0.05, "it starts over the origin"


def test_the_first_row_is_the_rest_pose_and_time_starts_at_zero():
    posed = suits.record(TIMES, STRENGTHS["usual"]).posed
    np.testing.assert_array_equal(posed.parent_from_joint[0], np.tile(np.eye(3), (27, 1, 1)))
    np.testing.assert_array_equal(posed.translation[0], posed.hierarchy.offsets)
    np.testing.assert_allclose(posed.time_s, np.arange(len(TIMES)) / suits.RATE_HZ)
    assert (posed.translation[:, 1:] == posed.hierarchy.offsets[1:]).all(), "bones are rigid"
    turns = posed.parent_from_joint
    np.testing.assert_allclose(
        turns @ np.swapaxes(turns, -1, -2), np.broadcast_to(np.eye(3), turns.shape), atol=1e-9
    )


def test_the_axes_are_the_apps():
    recording = suits.record(suits.times(0.5), Errors())
    found = suits.found(recording)
    assert found["l_up_arm"][1, 0] > 0.1 > -0.1 > found["r_up_arm"][1, 0], "x to the left"
    assert found["head"][1, 1] > 1.3, "y up"
    assert found["l_toes"][1, 2] > found["l_foot"][1, 2] + 0.08, "z ahead"
    pose = recording.device_from_world[:, :3]
    np.testing.assert_allclose(pose @ pose.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(pose) == pytest.approx(1.0)


def test_a_file_read_back_is_the_motion(tmp_path):
    recording = suits.record(TIMES[:60], STRENGTHS["strong"])
    bvh.write(tmp_path / "suit.bvh", recording.posed)
    again = bvh_file.read(tmp_path / "suit.bvh")
    assert again.hierarchy.joints == recording.posed.hierarchy.joints
    np.testing.assert_allclose(forward(again)[0], forward(recording.posed)[0], atol=2e-6)


def test_the_same_seed_gives_the_same_and_another_seed_another():
    first, second = (suits.record(TIMES[:90], STRENGTHS["disturbed"]) for _ in range(2))
    np.testing.assert_array_equal(first.posed.parent_from_joint, second.posed.parent_from_joint)
    np.testing.assert_array_equal(first.posed.translation, second.posed.translation)
    other = suits.record(TIMES[:90], STRENGTHS["disturbed"], seed=1)
    assert np.abs(other.posed.translation - first.posed.translation).max() > 1e-3


def test_joint_errors_grow_with_the_strength():
    medians = []
    for name in ("mild", "usual", "strong"):
        drawn = [suits.record(TIMES, STRENGTHS[name], seed=seed) for seed in range(2)]
        medians.append(np.median([errors_mm(each, TIMES).mean(axis=1) for each in drawn]))
    assert 15 < medians[0] < 0.75 * medians[1] < 0.75 * 0.75 * medians[2] < 200


def test_latency_shows_the_body_as_it_was():
    late = suits.record(TIMES, Errors(latency_s=0.08))
    assert late.latency_s == 0.08
    found = suits.found(late)["l_hand"][1:]
    pose = late.device_from_world
    then = np.array([suits.performer().joints(t - 0.08)[4] for t in TIMES[1:]])
    np.testing.assert_allclose(found, then @ pose[:, :3].T + pose[:, 3], atol=1e-4)


def test_smoothing_keeps_the_time_and_takes_the_corners():
    # From the T-pose to the clap: the wrist stops at once at first touch.
    contact_s = suits.performer().motion.events["clap_1"]
    time_s = suits.times(1.2, start_s=contact_s - 0.6)
    sharp, smooth = (suits.record(time_s, Errors(smooth_s=s)) for s in (0.0, 0.03))
    apart = [
        np.linalg.norm(f["l_hand"] - f["r_hand"], axis=1)[1:]
        for f in map(suits.found, (sharp, smooth))
    ]
    moving = (apart[0] < 1.0) & (apart[0] > 0.3)
    lag = np.abs(apart[1] - apart[0])[moving[: len(apart[0])]].max()
    assert lag < 0.02, "no delay while the speed is even"
    jerk = [np.abs(np.diff(a, 2)).max() for a in apart]
    assert jerk[1] < 0.6 * jerk[0]


def test_missed_bend_straightens_elbows_only():
    share = 0.3
    recording = suits.record(TIMES, Errors(elbow=share))
    found, true = suits.found(recording), suits.true(recording, TIMES)

    def bend(at, shoulder, elbow, wrist):
        upper, lower = at[elbow] - at[shoulder], at[wrist] - at[elbow]
        cosine = (upper * lower).sum(1) / np.linalg.norm(upper, axis=1)
        return np.arccos(np.clip(cosine / np.linalg.norm(lower, axis=1), -1, 1))[1:]

    ours = bend(found, "l_up_arm", "l_low_arm", "l_hand")
    real = bend(true, "left_shoulder", "left_elbow", "left_wrist")
    assert real.max() > 0.5
    np.testing.assert_allclose(ours, (1 - share) * real, atol=1e-6)
    for name in ("l_up_leg", "l_low_leg", "l_foot", "l_up_arm"):
        np.testing.assert_allclose(found[name][1:], true[SHARED[name]][1:], atol=1e-4)


def test_a_wrong_heading_turns_the_whole_body_when_all_sensors_share_it():
    # Of steady drift half is common; drawn often, its size per minute is as stated.
    finals = []
    for seed in range(8):
        recording = suits.record(suits.times(2.0), Errors(drift_deg_min=60.0), seed=seed)
        across = suits.found(recording)["l_up_leg"] - suits.found(recording)["r_up_leg"]
        finals.append(np.degrees(np.arctan2(-across[-1, 2], across[-1, 0])))
        first = np.degrees(np.arctan2(-across[1, 2], across[1, 0]))
        assert abs(first) < 0.3, "right at the start"
    assert 0.8 < np.std(finals) < 4.0, "2 s at 60 degrees a minute: 2 degrees"


def test_bones_are_wrong_alike_on_both_sides():
    posed = suits.record(TIMES[:30], Errors(bone=0.1)).posed
    right = suits.record(TIMES[:30], Errors()).posed
    at = {name: k for k, name in enumerate(posed.hierarchy.joints)}
    ratio = np.linalg.norm(posed.hierarchy.offsets[1:], axis=1)
    ratio = np.append(1.0, ratio / np.linalg.norm(right.hierarchy.offsets[1:], axis=1))
    for part in ("low_arm", "hand", "low_leg", "foot", "up_leg"):
        assert ratio[at[f"l_{part}"]] == pytest.approx(ratio[at[f"r_{part}"]])
    assert len({round(ratio[at[name]], 6) for name in ("l_hand", "l_low_arm", "l_foot")}) == 3
    xyz = forward(posed)[0]
    assert xyz[0, at["l_toes"], 1] == pytest.approx(
        forward(right)[0][0, at["l_toes"], 1], abs=0.02
    ), "at rest it stands on the floor"


def test_standing_feet_stay_where_they_are_though_legs_are_guessed():
    time_s = suits.times(1.2, start_s=suits.performer().motion.events["tpose_1_start"])
    moved = []
    for skate in (0.0, 1.0):
        found = suits.found(suits.record(time_s, Errors(guess_deg=5.0, guess_s=0.3, skate=skate)))
        both = np.stack([found["l_foot"], found["r_foot"]])[:, 1:]
        moved.append(np.ptp(both.mean(axis=0)[:, [0, 2]], axis=0).max())
    assert moved[0] < 0.35 * moved[1]


def test_a_suit_near_iron_is_right_for_much_of_the_time_and_far_off_at_times():
    recordings = [suits.record(TIMES, IRON, seed=seed) for seed in range(3)]
    off_mm = np.concatenate([errors_mm(each, TIMES).max(axis=0) for each in recordings])
    assert off_mm.max() > 80 and 0.1 < (off_mm < 5).mean() < 0.9


@pytest.mark.parametrize("change", [{"strength": "awful"}, {"rate_hz": 0}])
def test_impossible_suits_are_refused(change):
    with pytest.raises(ValueError, match="expected a strength"):
        inertial_suit.InertialSuit(**change)
