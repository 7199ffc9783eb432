"""All sources of a take lie in one body frame, on one clock."""

import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.body_frame import common
from courtside.body_frame import frame as bodyframe
from courtside.devices import mocopi
from courtside.events import detect
from courtside.records.devices import clocks, device_motion, events
from courtside.records.devices.clocks import Clock
from courtside.records.devices.events import Events
from courtside.records.keypoints import derived_joints, skeleton
from courtside.study.errors import InputError
from fixtures.recordings import device_takes
from fixtures.recordings.real_data import REAL, needs_real

CONFIG = Path(__file__).parents[3] / "config"
TABLE = derived_joints.read(CONFIG / "derived_joints.yaml")
CARRIED_BY = bodyframe.anchors(TABLE, "rig", device_takes.JOINTS)
CLOCKS = {"d415-rgb": Clock(status="reference"), "mocopi": Clock(2.0, 0.0)}


def take(seed=0):
    truth = device_takes.truth(seed)
    rng = np.random.default_rng(seed)
    made = [
        device_takes.device(rng, truth),
        device_takes.mocopi(rng, truth, clock=CLOCKS["mocopi"], scale=0.9, cutoff_hz=None),
    ]
    return truth, made, detect.detect(made)


def test_exact_devices_agree_in_space_and_time():
    truth, made, events_of = take()
    chosen = common.common(events_of, CLOCKS)
    aligned = []
    for motion in made:
        frame = bodyframe.at_tpose(motion, CARRIED_BY, chosen[motion.source])
        claps = common.claps_of(motion.source, events_of, CLOCKS)
        aligned.append(common.aligned(motion, frame, CLOCKS[motion.source], claps))
    rgb, mocopi = aligned
    assert mocopi.unit_m == pytest.approx(0.9 * rgb.unit_m, rel=0.005)
    for body in aligned:
        np.testing.assert_allclose(
            body.clap_s, [truth[2]["clap_1"], truth[2]["clap_2"]], atol=0.006
        )
        assert truth[2]["tpose_1_start"] - 0.2 < body.tpose_s[0] or body.tpose_s[0] > 5
    at = np.arange(1.5, 4.0, 1 / 30)
    for name in ("left_wrist", "right_ankle"):
        both = [
            np.column_stack([np.interp(at, b.time_s, line) for line in b.joint(name).T])
            for b in aligned
        ]
        assert np.abs(both[0] - both[1]).max() < 0.02  # units; straight lines between frames


def test_one_t_pose_is_chosen_for_all_although_each_likes_another_best():
    _, made, events_of = take()
    first, second = (events_of[motion.source].tposes for motion in made)
    at_s = {m.source: s for m, s in zip(made, (first, second), strict=True)}
    for best in (0, 1):
        costs = {source: [0.1, 0.1] for source in at_s}
        costs["d415-rgb"][best] = 0.0
        costs["mocopi"][1 - best] = 0.05
        events_of = {
            source: Events(
                [
                    type(s)(**{**vars(s), "cost": c})
                    for s, c in zip(spells, costs[source], strict=True)
                ],
                [],
            )
            for source, spells in at_s.items()
        }
        chosen = common.common(events_of, CLOCKS)
        assert chosen["d415-rgb"].start_s == first[best].start_s
        assert chosen["mocopi"].start_s == second[best].start_s


@pytest.mark.parametrize("clapping", ["d415-rgb", "mocopi"])
def test_a_t_pose_that_a_clap_follows_is_chosen_before_a_better_one(clapping):
    _, _, events_of = take()
    for source, own in events_of.items():
        first, second = own.tposes
        better = replace(first, cost=second.cost / 100)
        claps = own.claps[1:] if source == clapping else []
        events_of[source] = replace(own, tposes=[better, second], claps=claps)
    chosen = common.common(events_of, CLOCKS)
    assert {source: own.tposes.index(chosen[source]) for source, own in events_of.items()} == {
        "d415-rgb": 1,
        "mocopi": 1,
    }


def test_no_common_t_pose_is_an_error_with_the_times():
    _, _, events_of = take()
    wrong = CLOCKS | {"mocopi": Clock(20.0, 0.0)}
    with pytest.raises(InputError, match=r"T-pose that all sources show.*mocopi -") as caught:
        common.common(events_of, wrong)
    assert "\n" not in str(caught.value)


def test_a_source_without_a_t_pose_stops_the_take_with_the_times_of_the_others():
    _, _, events_of = take()
    events_of["mocopi"] = Events([], [])
    with pytest.raises(
        InputError, match=r"found T-poses at .*: d415-rgb \d\.\d\d, .*; mocopi none; film all"
    ):
        common.common(events_of, CLOCKS)


def test_without_any_t_pose_the_line_asks_for_one():
    _, _, events_of = take()
    none = {source: Events([], []) for source in events_of}
    with pytest.raises(InputError, match=r"d415-rgb none; mocopi none; begin and end the"):
        common.common(none, CLOCKS)


def test_the_counterpart_has_the_frame_of_the_same_t_pose():
    truth, made, events_of = take()
    spells = events_of["d415-rgb"].tposes
    for number in (1, 2):
        span = [truth[2][f"tpose_{number}_{end}"] for end in ("start", "stop")]
        frame = common.counterpart(made[0], spells, CARRIED_BY, span)
        body = common.aligned(made[0], frame, CLOCKS["d415-rgb"])
        assert body.tpose_s[0] == pytest.approx(span[0], abs=0.15)
        held = (body.time_s > span[0] + 0.1) & (body.time_s < span[1] - 0.1)
        wrist = np.median(body.joint("left_wrist")[held], axis=0)
        assert wrist[0] == pytest.approx(1.0, abs=0.03)
    with pytest.raises(InputError, match="check the clocks"):
        common.counterpart(made[0], spells, CARRIED_BY, [100.0, 101.0])


def test_a_t_pose_that_nobody_performed_has_no_counterpart():
    _, made, events_of = take()
    with pytest.raises(InputError, match=r"d415-rgb: expected a T-pose .* rest poses .*; film one"):
        common.counterpart(made[0], events_of["d415-rgb"].tposes, CARRIED_BY, np.full(2, np.nan))


def test_frames_that_nobody_performed_are_left_out():
    _, made, events_of = take()
    motion = made[0]
    motion.performed[:7] = False
    frame = bodyframe.at_tpose(motion, CARRIED_BY, events_of["d415-rgb"].tposes[0])
    body = common.aligned(motion, frame, Clock())
    assert len(body.time_s) == len(motion.time_s) - 7 == len(body.fixed) == len(body.reason)


def test_the_script_tells_of_a_device_that_is_not_level(tmp_path, capsys):
    axes = Rotation.from_rotvec([90, 0, 0], degrees=True).as_matrix() @ device_takes.Y_UP
    motion = device_takes.mocopi(np.random.default_rng(0), device_takes.truth(0), axes=axes)
    device_motion.write(tmp_path / "suit.npz", motion)
    clocks.write(tmp_path / "clocks.json", "mocopi", {"mocopi": Clock(status="reference")})
    events.write(tmp_path / "events.json", detect.detect([motion]))
    script = runpy.run_path(str(CONFIG.parent / "workflow" / "scripts" / "align_bodies.py"))
    script["main"](
        tmp_path / "suit.npz",
        tmp_path / "clocks.json",
        [tmp_path / "events.json"],
        CONFIG / "derived_joints.yaml",
        tmp_path / "body.npz",
        tmp_path / "frame.json",
        skeleton="rig",
        devices={"mocopi": "mocopi"},
        stated={},
    )
    assert "Y is not up in its file" in capsys.readouterr().err


def test_a_source_without_a_clap_of_its_own_takes_that_of_another():
    truth, _, events_of = take()
    rgb = events_of["d415-rgb"]
    events_of["d415-rgb"] = Events(rgb.tposes, rgb.claps[1:])
    found = common.claps_of("d415-rgb", events_of, CLOCKS)
    np.testing.assert_allclose(found, [truth[2]["clap_1"], truth[2]["clap_2"]], atol=0.006)


@needs_real
@pytest.mark.parametrize("name", ["jump", "mocopi-mobile-arm-raise-turn"])
def test_a_real_recording_without_t_pose_takes_the_rest_pose_it_brings_along(name):
    joints = skeleton.read(CONFIG / "skeletons" / "mocopi27.yaml")
    motion = mocopi.read(REAL / "mocopi" / f"{name}.bvh", joints)
    events_of = detect.detect([motion])
    assert (events_of["mocopi"].tposes, events_of["mocopi"].claps) == ([], [])
    clocks = {"mocopi": Clock(status="reference")}
    chosen = common.common(events_of, clocks)["mocopi"]
    assert chosen == events_of["mocopi"].rest
    performed = {"mocopi": replace(events_of["mocopi"], rest=None)}
    with pytest.raises(InputError, match="T-pose"):
        common.common(performed, clocks)
    carried_by = bodyframe.anchors(TABLE, "mocopi27", motion.joints)
    body = common.aligned(motion, bodyframe.at_tpose(motion, carried_by, chosen), clocks["mocopi"])
    assert len(body.time_s) == motion.performed.sum()
    assert np.isfinite(body.following).all()
    assert np.isnan(body.tpose_s).all()  # nobody performed it
    wide = body.following[
        :, [list(body.joints).index(f"{s}_shoulder") for s in ("left", "right")], 0
    ]
    assert (wide[:, 0] > 0).all()  # the left shoulder lies to the left in every frame
    assert (wide[:, 1] < 0).all()
    assert 0.5 < body.unit_m < 0.9
