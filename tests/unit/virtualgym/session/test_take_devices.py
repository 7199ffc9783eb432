"""Devices of a take: settings, files, clocks; recordings show the truth, which covers all."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from courtside.calibration.court import court
from courtside.devices.realsense import recording
from courtside.geometry import camera
from courtside.records.devices.hierarchy import forward
from courtside.records.truth import take_truth
from courtside.records.truth.take_truth import DeviceTruth
from fixtures.people import mannequin
from fixtures.recordings import coarse_halls
from virtualgym.body import skinned_body
from virtualgym.devices import depth_camera, inertial_suit
from virtualgym.session import session, take, take_devices

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")
SESSION = session.Settings(preset="rich", layout="a", seed=3, size_px=[320, 180], walk_frames=0)
RGBD = {"kind": "rgbd", "size_px": [212, 120], "rate_hz": 20, "subpixel_px": 0.005}
TAKE = take.TakeSettings(
    motion="single_view", seconds=0.2, seed=5, start_s=1.0, cameras=[], rate_hz=40.0,
    players={"p1": {"body": "m2", "options": {"free_s": 0.0, "claps": 1}}},
    devices={"d415": RGBD, "suit": {"kind": "inertial", "strength": "none", "rate_hz": 50}},
    clocks={"suit": {"offset_s": -0.3, "drift_ppm": 500.0}},
)  # fmt: skip


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """A take with a depth camera and a suit, filmed by two processes, in a coarse hall."""
    folder = tmp_path_factory.mktemp("take") / "claps"
    with coarse_halls.built():
        worn = take.simulate_take(SESSION, TAKE, COURT, mannequin.folder(), folder, threads=2)
    return folder, worn, take_truth.read(folder / "truth.npz")


def test_a_take_of_devices_only_has_their_files_and_truth(recorded):
    folder, worn, truth = recorded
    assert {path.name for path in folder.iterdir()} == {"d415.bag", "racket.csv", "truth.npz"}
    assert list(worn) == ["suit"]
    assert (truth.offset_s, truth.shaken) == ({}, {})
    device = {n: (d.kind, d.person, d.offset_s, d.drift_ppm) for n, d in truth.devices.items()}
    assert device == {
        "d415": ("rgbd", "p1", 0.0, 0.0),
        "suit": ("inertial", "p1", -0.3, 500.0),
    }
    # The suit's last row is 0.18 s after its first, which is at 0.3 s of the reference.
    np.testing.assert_allclose(truth.time_s, np.arange(21) / 40)
    assert {"tpose_1_start", "clap_1"} < set(truth.events["p1"])


def test_the_bag_shows_the_truth(recorded):
    folder, _, truth = recorded
    found = recording.read(folder / "d415.bag")
    assert found.colour.size == found.depth.size == (212, 120)
    assert (found.depth_unit_m, found.baseline_m) == (0.001, pytest.approx(0.055))
    assert np.linalg.norm(found.colour_from_depth[:, 3]) == pytest.approx(0.015)
    colour = replace(found.colour, cam_from_world=truth.devices["d415"].from_world)
    shots = list(zip(found.colour_frames(), found.depth_frames(), strict=True))
    np.testing.assert_allclose([shot[0][0] for shot in shots], np.arange(4) / 20, atol=1e-6)
    for (time_s, bgr), (_, steps) in shots:
        joints = truth.xyz[0, np.argmin(np.abs(truth.time_s - time_s))]
        xy = camera.project(colour, joints)
        assert ((xy > 0) & (xy < [212, 120])).all()
        assert _lit(bgr, xy[list(truth.joints).index("rig_head_top")])
        _assert_below_skin(found, colour, truth.joints, joints, steps)


def _lit(bgr, top):
    """Say whether the picture changes at the top of the head."""
    column, row = np.rint(top).astype(int)
    above, below = bgr[row - 6, column].astype(int), bgr[row + 6, column].astype(int)
    return np.abs(above - below).sum() > 40


def _assert_below_skin(found, colour, names, joints, steps):
    """Check that joints lie a few centimetres behind the surface that the depth sensor measures."""
    in_colour = joints @ colour.cam_from_world[:, :3].T + colour.cam_from_world[:, 3]
    turn, shift = found.colour_from_depth[:, :3], found.colour_from_depth[:, 3]
    in_depth = (in_colour - shift) @ turn
    xy = in_depth @ found.depth.K.T
    for name, px, depth_m in zip(names, xy[:, :2] / xy[:, 2:], in_depth[:, 2], strict=True):
        if name.split("_")[-1] in ("hip", "knee", "shoulder", "pelvis"):
            column, row = np.rint(px).astype(int)
            around = steps[row - 2 : row + 3, column - 2 : column + 3].astype(float)
            surface_m = np.median(around[around > 0]) * found.depth_unit_m
            assert 0.0 < depth_m - surface_m < 0.2, name


def test_the_suit_shows_the_truth_at_its_own_time(recorded):
    _, worn, truth = recorded
    posed, device = worn["suit"], truth.devices["suit"]
    xyz = forward(posed)[0][:, posed.hierarchy.joints.index("l_hand")]
    true = truth.xyz[0, :, list(skinned_body.JOINTS).index("left_wrist")]
    own_s = np.arange(1, 10) / 50
    at_s = (own_s + 0.3) / (1 + 500e-6)
    np.testing.assert_allclose(posed.time_s[1:], own_s)
    moved = true @ device.from_world[:, :3].T + device.from_world[:, 3]
    expected = CubicSpline(truth.time_s, moved)(at_s)
    np.testing.assert_allclose(xyz[1:], expected, atol=1e-3)
    assert np.ptp(xyz[1:], axis=0).max() > 0.05, "it moves meanwhile"


def test_recordings_do_not_depend_on_the_number_of_processes(recorded, tmp_path):
    folder, worn, _ = recorded
    with coarse_halls.built():
        again = take.simulate_take(SESSION, TAKE, COURT, mannequin.folder(), tmp_path / "claps")
    for name in ("d415.bag", "truth.npz"):
        assert (tmp_path / "claps" / name).read_bytes() == (folder / name).read_bytes()
    np.testing.assert_array_equal(again["suit"].parent_from_joint, worn["suit"].parent_from_joint)


def test_devices_are_built_of_their_settings():
    made = take_devices.build("d", {"kind": "rgbd", "size_px": [640, 480], "height_m": 1.2}, ["p1"])
    assert isinstance(made, depth_camera.DepthCamera)
    assert (made.size_px, made.depth_size_px, made.height_m) == ((640, 480), (640, 480), 1.2)
    suit = take_devices.build("s", {"kind": "inertial", "subject": "p2"}, ["p1", "p2"])
    assert isinstance(suit, inertial_suit.InertialSuit) and suit.rate_hz == 60
    people = {"p1": None, "p2": None}
    assert [take_devices.subject(each, people) for each in (made, suit)] == ["p1", "p2"]


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({}, "a kind of"),
        ({"kind": "lidar"}, "a kind of"),
        ({"kind": "rgbd", "strength": "mild"}, "keys of device d"),
        ({"kind": "inertial", "strength": "awful"}, "strength"),
        ({"kind": "inertial", "subject": "p9"}, "subject of"),
    ],
)
def test_impossible_devices_are_refused(settings, message):
    with pytest.raises(ValueError, match=message) as fault:
        take_devices.build("d", settings, {"p1": {}})
    assert "\n" not in str(fault.value)


# The truth of a take covers what everything records, by the first clock's steps.


class Walker:
    """Every joint is where the time says."""

    class motion:
        events = {"clap_1": 2.5}  # noqa: RUF012

    def joints(self, time_s):
        return np.full((len(skinned_body.JOINTS), 3), time_s)

    def racket(self, time_s):
        return np.full((2, 3), np.nan)


def truth(**change):
    settings = {
        "motion": "single_view",
        "seconds": 2.0,
        "players": {"p1": {"body": "m1"}},
        "seed": 0,
        "rate_hz": 25.0,
        "start_s": 0.5,
        "devices": {"a": {"kind": "inertial"}, "b": {"kind": "inertial", "rate_hz": 50}},
        "clocks": {"b": {"offset_s": 0.3, "drift_ppm": -200.0}},
    }
    made = take.TakeSettings(**settings | change)
    devices = {
        name: DeviceTruth("inertial", "p1", 0.0, 0.0, 0.0, np.eye(3, 4)) for name in made.devices
    }
    return take_devices.of_take(made, {}, {"p1": Walker()}, devices)


def test_the_truth_begins_with_the_first_device_and_ends_with_the_last():
    found = truth()
    # `b` starts 0.3 s before the reference, `a` ends 1 / 60 s before 2 s.
    np.testing.assert_allclose(found.time_s, np.arange(-8, 51) / 25)
    np.testing.assert_allclose(found.xyz[0, :, 3, 1], found.time_s + 0.5)
    assert found.events == {"p1": {"clap_1": 2.0}}
    assert (found.offset_s, found.drift_ppm, list(found.devices)) == ({}, {}, ["a", "b"])


@pytest.mark.parametrize("offset_s", [0.0, -1.0])
def test_a_late_clock_makes_the_truth_longer(offset_s):
    found = truth(clocks={"b": {"offset_s": offset_s}})
    assert found.time_s[-1] == pytest.approx(2.0 - offset_s, abs=0.03)
    assert found.time_s[0] == 0
