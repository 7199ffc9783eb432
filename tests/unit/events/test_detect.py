"""What sources show: of one device one source must clap, a device that is alone none."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.events import detect
from courtside.records.devices.clocks import Clock
from courtside.study.errors import InputError
from fixtures.recordings import device_takes

DEVICES = {"d415-rgb": "d415", "mocopi": "mocopi", "d415-depth": "d415"}


def shown(motions, devices, stated=()):
    return detect.of_devices(detect.detect(motions), devices, stated)


def take():
    truth = device_takes.truth(3)
    rng = np.random.default_rng(3)
    rgb = device_takes.device(rng, truth)
    still = np.repeat(rgb.xyz[:1], len(rgb.xyz), axis=0)  # arms down all the time
    depth = replace(rgb, source="d415-depth", xyz=still)
    return truth, rgb, device_takes.mocopi(rng, truth), depth


def test_a_source_without_a_clap_is_borne_with_where_its_device_claps_in_another():
    truth, rgb, mocopi, depth = take()
    found = shown([rgb, mocopi, depth], DEVICES)
    assert found["d415-depth"].claps == []
    assert len(found["d415-rgb"].claps) == len(found["mocopi"].claps) == 2
    assert found["d415-rgb"].claps[0].time_s == pytest.approx(truth[2]["clap_1"], abs=0.02)


def test_a_source_with_its_own_t_poses_has_the_claps_of_its_device():
    """Its arms look bent whenever hands come together; the second T-pose is not in it at all."""
    truth, rgb, mocopi, _ = take()
    events, xyz = truth[2], rgb.xyz.copy()
    later = rgb.time_s > events["tpose_1_stop"] + 0.05
    elbows = [rgb.joints.tolist().index(f"{side}_elbow") for side in ("left", "right")]
    xyz[np.ix_(later, elbows, [1])] += 0.35
    depth = replace(rgb, source="d415-depth", xyz=xyz)
    alone = shown([depth], {"d415-depth": "d415"})["d415-depth"]
    assert (len(alone.tposes), alone.claps) == (1, [])
    found = shown([depth, mocopi, rgb], DEVICES)
    (clap,) = found["d415-depth"].claps
    assert clap == found["d415-rgb"].claps[0]
    assert clap.tpose == 0
    assert len(found["mocopi"].claps) == 2


def test_a_t_pose_in_two_spells_has_each_clap_once():
    truth, rgb, mocopi, _ = take()
    events, xyz = truth[2], rgb.xyz.copy()
    middle_s = (events["tpose_1_start"] + events["tpose_1_stop"]) / 2
    elbows = [rgb.joints.tolist().index(f"{side}_elbow") for side in ("left", "right")]
    bent = (np.abs(rgb.time_s - middle_s) < 0.2) | (rgb.time_s > events["tpose_1_stop"] + 0.05)
    xyz[np.ix_(bent, elbows, [1])] += 0.35
    found = shown([replace(rgb, source="d415-depth", xyz=xyz), mocopi, rgb], DEVICES)["d415-depth"]
    assert len(found.tposes) == 2
    assert [clap.tpose for clap in found.claps] == [1]


def test_a_device_among_others_must_clap():
    _, _, mocopi, depth = take()
    with pytest.raises(InputError, match="d415-depth: expected a T-pose"):
        shown([mocopi, depth], DEVICES)
    still = replace(mocopi, xyz=np.repeat(mocopi.xyz[:1], len(mocopi.xyz), axis=0))
    with pytest.raises(InputError) as raised:
        shown([still, depth], DEVICES)
    assert [line.split(":")[0] for line in raised.value.lines] == ["mocopi", "d415-depth"]
    found = shown([mocopi, depth], DEVICES, stated=["d415"])
    assert (len(found["mocopi"].claps), found["d415-depth"].claps) == (2, [])


def test_the_reference_need_not_clap_where_all_other_clocks_are_stated():
    _, rgb, mocopi, depth = take()
    found = shown([depth, mocopi], DEVICES, stated=["mocopi"])
    assert (found["d415-depth"].claps, len(found["mocopi"].claps)) == ([], 2)
    owners = {"d415-depth": "d415", "mocopi": "mocopi", "webcam-rgb": "webcam"}
    webcam = replace(rgb, source="webcam-rgb")
    with pytest.raises(InputError, match="d415-depth: expected a T-pose"):
        shown([depth, mocopi, webcam], owners, stated=["mocopi"])


def test_a_device_that_is_alone_need_not():
    *_, depth = take()
    found = shown([depth], {"d415-depth": "d415"})["d415-depth"]
    assert (found.tposes, found.claps) == ([], [])


CLOCK = Clock(2.0, 50.0)


def devices():
    rng = np.random.default_rng(0)
    take = device_takes.truth(0)
    return take, [device_takes.device(rng, take), device_takes.mocopi(rng, take, clock=CLOCK)]


def test_events_are_on_the_reference_clock():
    take, motions = devices()
    rows = detect.events(detect.detect(motions), {"mocopi": CLOCK})
    for source in ("d415-rgb", "mocopi"):
        own = rows[(rows.source == source) & (rows.event == "clap")]
        assert own.number.tolist() == [1, 2]
        assert own.used.all()
        for number, at_s in zip(own.number, own.time_s, strict=True):
            assert at_s == pytest.approx(take[2][f"clap_{number}"], abs=0.006)
        spells = rows[(rows.source == source) & rows.event.str.startswith("tpose")]
        assert len(spells) == 4
    mocopi = rows[rows.source == "mocopi"]
    np.testing.assert_allclose(CLOCK.to_reference(mocopi.own_time_s), mocopi.time_s)
    assert list(rows.columns) == detect.EVENT_COLUMNS


def test_a_device_that_shows_nothing_has_a_row_that_says_so():
    still = device_takes.of(np.tile(devices()[1][0].xyz[:1], (90, 1, 1)), np.arange(90) / 30)
    (row,) = detect.events(detect.detect([still])).to_dict("records")
    assert row["event"] == "none" and not row["used"]
    assert "expected a T-pose" in row["why"]


def test_a_source_without_wrists_has_a_row_that_names_them():
    (rgb, _), lost = devices()[1], ["left_wrist", "right_wrist"]
    kept = ~np.isin(rgb.joints, lost)
    bare = device_takes.of(rgb.xyz[:, kept], rgb.time_s, joints=rgb.joints[kept])
    found = detect.detect([bare])
    assert "missing: ['left_wrist', 'right_wrist']" in found["d415-rgb"].fault
    assert detect.wrists([bare]).distance_m.isna().all()
    assert detect.events(found).event.tolist() == ["none"]


def test_wrists_are_as_far_apart_as_they_are():
    take, motions = devices()
    motions[0].performed[:5] = False
    rows = detect.wrists(motions, {"mocopi": CLOCK})
    rgb = rows[rows.source == "d415-rgb"]
    assert rgb.distance_m.isna().sum() == 5
    times, xyz, _ = take
    left, right = (device_takes.JOINTS.index(f"{side}_wrist") for side in ("left", "right"))
    apart = np.linalg.norm(xyz[:, left] - xyz[:, right], axis=1)
    true = np.interp(rgb.time_s[5:], times, apart)
    np.testing.assert_allclose(rgb.distance_m[5:], true, atol=0.01)
