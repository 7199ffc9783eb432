"""Claps of the virtual athlete, as devices see them: the truth says when the palms first touch."""

import re
from dataclasses import replace

import numpy as np
import pytest

from courtside.events import claps, tpose
from fixtures.recordings import device_takes


def found_at(motion):
    return claps.find(motion, tpose.find(motion))[0]


def why_none(motion):
    found, others = claps.find(motion, tpose.find(motion))
    assert not found
    return claps.none_counts(motion.source, others)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize(
    ("make", "options", "most_s"),
    [
        (device_takes.device, {}, 0.006),
        (device_takes.device, {"rate_hz": 60.0}, 0.006),
        (device_takes.mocopi, {}, 0.006),
        (device_takes.mocopi, {"rate_hz": 50.0}, 0.006),
        (device_takes.mocopi, {"cutoff_hz": 10.0}, 0.006),
        (device_takes.blazepose, {"noise_m": (0.003, 0.003, 0.03)}, 0.008),
    ],
)
def test_the_first_touch_is_found_within_8_ms(make, options, most_s, seed):
    take = device_takes.truth(seed)
    found = found_at(make(np.random.default_rng(seed), take, **options))
    assert [clap.tpose for clap in found] == [0, 1]
    for number, clap in enumerate(found, 1):
        error_s = clap.time_s - take[2][f"clap_{number}"]
        assert abs(error_s) < most_s
        assert abs(error_s) < 2.5 * clap.uncertainty_s
        assert 0 < clap.distance_m < 0.15
        assert 1.0 < clap.speed_m_s < 5.0
        assert not clap.rebounds


def test_noisy_claps_are_covered():
    errors, stated = [], []
    for seed in range(24):
        take = device_takes.truth(seed % 2)
        for clap in found_at(device_takes.blazepose(np.random.default_rng(seed), take)):
            times = [take[2][name] for name in ("clap_1", "clap_2")]
            errors.append(min((clap.time_s - at for at in times), key=abs))
            stated.append(clap.uncertainty_s)
    errors, stated = np.array(errors), np.array(stated)
    assert len(errors) >= 46
    assert np.mean(np.abs(errors) <= 1.645 * stated) >= 0.8
    assert np.sqrt(np.mean(errors**2)) < 0.015
    assert np.median(stated) < 0.015


def test_rebounding_hands_touch_first_at_the_event():
    take = device_takes.truth(0, 2.0, "tpose_clap_bouncing")
    found = found_at(device_takes.device(np.random.default_rng(0), take, rate_hz=60.0))
    assert len(found) == 2
    for number, clap in enumerate(found, 1):
        assert clap.rebounds
        # Palms give for 8 ms before they fly apart: the corner is there, and the uncertainty says
        # so.
        assert 0 < clap.time_s - take[2][f"clap_{number}"] < 0.013
        assert clap.uncertainty_s >= 0.008


@pytest.mark.parametrize("kind", ["cameras", "rgbd"])
@pytest.mark.parametrize("rate_hz", [20.0, 24.0, 25.0, 30.0, 50.0])
def test_rebounding_hands_touch_first_at_the_event_at_any_rate(rate_hz, kind):
    errors, stated, rebounds = [], [], []
    for seed in range(8):
        take = device_takes.truth(seed % 2, 2.0, "tpose_clap_bouncing")
        rng = np.random.default_rng(seed)
        options = {"kind": kind, "rate_hz": rate_hz, "noise_m": (0.004, 0.004, 0.01)}
        found = found_at(device_takes.device(rng, take, **options))
        assert len(found) == 2
        errors += [c.time_s - take[2][f"clap_{number}"] for number, c in enumerate(found, 1)]
        stated += [clap.uncertainty_s for clap in found]
        rebounds += [clap.rebounds for clap in found]
    errors, stated = np.array(errors), np.array(stated)
    # Palms give for 8 ms before they fly apart; the corner is there.
    assert 0 < errors.mean() < 0.01
    assert np.mean(np.abs(errors) <= 1.645 * stated) >= 0.9
    assert np.mean(rebounds) >= 0.85


def test_a_filter_that_lags_delays_the_clap_by_its_lag():
    take = device_takes.truth(0)
    options = {"cutoff_hz": None, "causal_s": 0.03}
    found = found_at(device_takes.mocopi(np.random.default_rng(0), take, **options))
    assert len(found) == 2
    for number, clap in enumerate(found, 1):
        assert 0.015 < clap.time_s - take[2][f"clap_{number}"] < 0.035


def cut(motion, keep):
    return replace(
        motion,
        **{key: getattr(motion, key)[keep] for key in ("time_s", "xyz", "reason", "performed")},
    )


def test_no_clap_after_the_t_pose_is_told_with_the_times():
    take = device_takes.truth(0)
    motion = device_takes.mocopi(np.random.default_rng(0), take)
    before = cut(motion, motion.time_s < take[2]["clap_1"] - 0.2)
    assert "no time at which the hands come together" in why_none(before)
    # The first T-pose is not there: its clap is one without a T-pose.
    events = take[2]
    gone = (motion.time_s > events["tpose_1_start"] - 0.5) & (
        motion.time_s < events["tpose_1_stop"]
    )
    late = cut(motion, ~gone & (motion.time_s < events["clap_2"] - 0.2))
    why = why_none(late)
    assert re.search(rf"only at {events['clap_1'] - 0.1:.1f}\d s \(no T-pose", why)
    assert "\n" not in why


@pytest.mark.parametrize(("rate_hz", "n_claps"), [(12.0, 0), (18.0, 0), (20.0, 2)])
def test_too_few_frames_per_second_are_told(rate_hz, n_claps):
    take = device_takes.truth(0)
    motion = device_takes.device(np.random.default_rng(0), take, rate_hz=rate_hz)
    if n_claps:
        assert len(found_at(motion)) == n_claps
    else:
        assert f"{rate_hz:.0f} frames per second are too few: a clap needs 18.9" in why_none(motion)


def test_a_clap_without_its_t_pose_is_listed_and_not_used():
    take = device_takes.truth(1)
    motion = device_takes.mocopi(np.random.default_rng(0), take)
    events = take[2]
    gone = (motion.time_s > events["tpose_1_start"] - 0.5) & (
        motion.time_s < events["tpose_1_stop"]
    )
    motion = cut(motion, ~gone)
    (second,), (first,) = claps.find(motion, tpose.find(motion))
    assert "no T-pose" in first.why
    assert first.time_s == pytest.approx(events["clap_1"], abs=0.15)
    assert second.time_s == pytest.approx(events["clap_2"], abs=0.006)


@pytest.mark.parametrize(
    ("change", "why"),
    [("behind", "in front"), ("above", "too high"), ("bent", "bent"), ("apart", "stay together")],
)
def test_hands_together_otherwise_are_no_clap(change, why):
    take = device_takes.truth(0)
    motion = device_takes.device(np.random.default_rng(0), take, axes=np.eye(3), rate_hz=60.0)
    later = motion.time_s > take[2]["tpose_1_stop"] + 0.05
    names = motion.joints.tolist()
    xyz = motion.xyz.copy()
    hands = [names.index("left_wrist"), names.index("right_wrist")]
    elbows = [names.index("left_elbow"), names.index("right_elbow")]
    shoulders = [names.index("left_shoulder"), names.index("right_shoulder")]
    middle = xyz[later][:, shoulders].mean(axis=1, keepdims=True)
    if change == "behind":  # y is forwards in the world of this athlete
        xyz[np.ix_(later, hands, [1])] = 2 * middle[..., 1:2] - xyz[np.ix_(later, hands, [1])]
    if change == "above":
        xyz[np.ix_(later, hands, [2])] += 0.5
    if change == "bent":
        xyz[np.ix_(later, elbows, [2])] -= 0.35
    if change == "apart":
        contact = motion.time_s > take[2]["clap_1"] + 0.02
        xyz[np.ix_(contact, hands[:1], [0])] += 0.8 * np.sign(
            xyz[0, hands[0], 0] - xyz[0, hands[1], 0]
        )
    motion = cut(replace(motion, xyz=xyz), motion.time_s < take[2]["clap_1"] + 0.3)
    found, others = claps.find(motion, tpose.find(motion))
    assert not found
    (other,) = [one for one in others if one.time_s > take[2]["clap_1"] - 0.2]
    assert why in other.why


def test_arms_that_seem_bent_only_where_hands_hide_them_clap():
    take = device_takes.truth(0)
    motion = device_takes.device(np.random.default_rng(0), take, axes=np.eye(3), rate_hz=60.0)
    straight = found_at(motion)
    xyz = motion.xyz.copy()
    elbows = [motion.joints.tolist().index(f"{side}_elbow") for side in ("left", "right")]
    hidden = abs(motion.time_s - take[2]["clap_1"]) < 0.15
    xyz[np.ix_(hidden, elbows, [2])] -= 0.35
    assert found_at(replace(motion, xyz=xyz)) == straight


def test_distances():
    motion = device_takes.device(np.random.default_rng(0), device_takes.truth(0))
    spell = tpose.find(motion)[0]
    apart, line = claps.wrist_distance(motion), claps.separation(motion, spell)
    assert np.all(line <= apart + 1e-9)
    np.testing.assert_allclose(line[spell.frames], apart[spell.frames], rtol=0.01)


def test_a_hand_that_is_lost_behind_the_other_leaves_the_clap():
    take = device_takes.truth(0)
    motion = device_takes.device(np.random.default_rng(0), take)
    wrist = motion.joints.tolist().index("right_wrist")
    shoulder = motion.joints.tolist().index("right_shoulder")
    line = np.median(motion.joint("left_wrist") - motion.joint("right_wrist"), axis=0)
    line /= np.linalg.norm(line)
    xyz = motion.xyz.copy()
    for name in ("clap_1", "clap_2"):
        hidden = np.abs(motion.time_s - take[2][name] - 0.3) < 0.25  # while hands are held together
        away = xyz[hidden, shoulder] - xyz[hidden, wrist]
        # In depth only: as cameras in line with both hands lose one.
        xyz[hidden, wrist] += away - (away @ line)[:, None] * line
    found = found_at(replace(motion, xyz=xyz))
    for number, clap in enumerate(found, 1):
        assert abs(clap.time_s - take[2][f"clap_{number}"]) < 2.5 * clap.uncertainty_s
    assert len(found) == 2


def test_exchanged_sides_are_named():
    """Then the chest is behind, and a clap in front of it is behind the back."""
    motion = device_takes.mocopi(np.random.default_rng(0), device_takes.truth(0))
    names = [str(name) for name in motion.joints]
    other = {"left": "right", "right": "left"}
    names = [re.sub("left|right", lambda side: other[side[0]], name) for name in names]
    line = why_none(replace(motion, joints=np.array(names)))
    assert "not in front of the chest but behind: are left and right exchanged?" in line
