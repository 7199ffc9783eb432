"""T-poses are found where the athlete holds them, by any device, and nowhere else."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from courtside.events import tpose
from courtside.study.errors import InputError
from fixtures.recordings import device_takes

DEVICES = {
    "exact": device_takes.device,
    "blazepose": device_takes.blazepose,
    "mocopi": device_takes.mocopi,
}


def figure(left_arm=(0.58, 0, 0), right_arm=(-0.58, 0, 0), bend=0.0, n=60):
    """Return a still body (x left, y up, z forward), arms straight or forearms bent forward."""
    half = {"shoulder": (0.18, 0.5), "hip": (0.09, 0.0)}
    at = {}
    for side, sign, arm in (("left", 1, left_arm), ("right", -1, right_arm)):
        for part, (aside, height) in half.items():
            at[f"{side}_{part}"] = np.array([sign * aside, height, 0])
        at[f"{side}_elbow"] = at[f"{side}_shoulder"] + np.array(arm) / 2
        fore = (
            np.array([np.cos(bend) * sign, 0, np.sin(bend)]) * 0.29 if bend else np.array(arm) / 2
        )
        at[f"{side}_wrist"] = at[f"{side}_elbow"] + fore
    xyz = np.tile(np.array([at[name] for name in tpose.JOINTS]), (n, 1, 1))
    return device_takes.of(xyz, np.arange(n) / 30, joints=tpose.JOINTS)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("name", DEVICES)
def test_both_t_poses_are_found_and_no_other(name, seed):
    take = device_takes.truth(seed)
    motion = DEVICES[name](np.random.default_rng(seed), take)
    found = tpose.find(motion)
    assert len(found) == 2
    for number, spell in enumerate(found, 1):
        start, stop = (take[2][f"tpose_{number}_{end}"] for end in ("start", "stop"))
        assert start - 0.15 < spell.start_s < spell.stop_s < stop + 0.15
        assert spell.stop_s - spell.start_s > 0.6 * (stop - start)
        assert motion.time_s[spell.frames][[0, -1]].tolist() == [spell.start_s, spell.stop_s]


def test_the_numbers_of_a_known_pose():
    raised = np.array([0.58 * np.cos(0.2), 0.58 * np.sin(0.2), 0])
    (spell,) = tpose.find(figure(left_arm=raised))
    assert spell.level_deg == pytest.approx(np.degrees(0.2))
    assert spell.bend_deg == spell.sideways_deg == pytest.approx(0, abs=1e-4)
    (spell,) = tpose.find(figure(bend=0.3))
    assert spell.bend_deg == pytest.approx(np.degrees(0.3))
    assert spell.speed_per_s == 0


@pytest.mark.parametrize(
    "pose",
    [
        {"left_arm": (0, -0.58, 0)},  # one arm hangs
        {"left_arm": (0, 0, 0.58), "right_arm": (0, 0, 0.58)},  # to the front
        {"left_arm": (-0.58, 0, 0), "right_arm": (0.58, 0, 0)},  # crossed
        {"bend": 1.0},
        {"n": 10},  # too short
    ],
)
def test_other_poses_are_none(pose):
    with pytest.raises(InputError, match="expected a T-pose") as caught:
        tpose.find(figure(**pose))
    assert "\n" not in str(caught.value)


def test_a_moving_arm_is_none():
    angle = np.linspace(-0.3, 0.3, 15)
    xyz = np.concatenate(
        [figure(left_arm=(0.58 * np.cos(a), 0.58 * np.sin(a), 0), n=1).xyz for a in angle]
    )
    with pytest.raises(InputError, match=r"the longest lasts|the nearest is at"):
        tpose.find(device_takes.of(xyz, np.arange(15) / 15, joints=tpose.JOINTS))


def test_frames_that_nobody_performed_do_not_count():
    motion = figure()
    with pytest.raises(InputError, match="nor a frame with both arms"):
        tpose.find(replace(motion, performed=np.zeros(60, bool)))


def test_the_line_says_what_came_nearest_and_when():
    hanging, out = figure(left_arm=(0, -0.58, 0)).xyz, figure(n=12).xyz
    xyz = np.concatenate([hanging, out, hanging])
    with pytest.raises(
        InputError, match=r"longest lasts 0\.\d+ s at 1\.9\d s|longest lasts 0\.\d+ s at 2\.\d"
    ):
        tpose.find(device_takes.of(xyz, np.arange(len(xyz)) / 30, joints=tpose.JOINTS))


def test_a_device_without_elbows_is_refused():
    motion = device_takes.of(
        np.zeros((9, 2, 3)), np.arange(9) / 30, joints=["left_wrist", "right_wrist"]
    )
    with pytest.raises(InputError, match=r"missing: .*left_elbow"):
        tpose.find(motion)


def test_a_rest_pose_that_nobody_performed_gives_a_t_pose_of_its_own():
    hanging = figure(left_arm=(0, -0.58, 0), right_arm=(0, -0.58, 0)).xyz
    xyz = np.concatenate([figure(bend=0.2, n=1).xyz, hanging])
    performed = np.arange(len(xyz)) > 0
    motion = device_takes.of(xyz, np.arange(len(xyz)) / 60, "mocopi", joints=tpose.JOINTS)
    motion = replace(motion, performed=performed)
    with pytest.raises(InputError, match="expected a T-pose"):
        tpose.find(motion)
    spell = tpose.rest(motion)
    assert (spell.first, spell.stop, spell.speed_per_s) == (0, 1, 0)
    assert spell.bend_deg == pytest.approx(np.degrees(0.2))
    with pytest.raises(InputError, match="found none"):
        tpose.rest(replace(motion, performed=np.ones(len(xyz), bool)))
    with pytest.raises(InputError, match="level arms, found arms 90 degrees from square"):
        tpose.rest(replace(motion, performed=~performed))


def test_t_poses_of_many_frames_need_little_memory():
    """The windows of all joints of half a minute at 240 Hz at once are over 100 MB."""
    still = figure(n=7200)
    fast = replace(still, time_s=np.arange(7200) / 240)
    tracemalloc.start()
    (spell,) = tpose.find(fast)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 100e6
    assert spell.stop_s - spell.start_s == pytest.approx(30, abs=1.5)
