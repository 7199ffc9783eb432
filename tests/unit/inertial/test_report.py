"""The report of a correction says what was done: against the bodies themselves."""

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from courtside.inertial import correction
from courtside.inertial import report as reports
from courtside.records.devices.hierarchy import forward
from fixtures.people import moved_bodies


@cache
def case():
    true = moved_bodies.moving(3, seconds=10.0)
    raw = moved_bodies.stretched(true, {"left_knee": 0.95, "right_knee": 0.95})
    vision = moved_bodies.seen(true, 3, missing=0.2)
    return raw, vision, *correction.correct(raw, vision, sigma_m=0.03)


def test_bone_scales_are_those_of_the_body():
    raw, _, body, report = case()
    lengths = [np.linalg.norm(posed.translation[0], axis=1) for posed in (raw, body)]
    for at, joint in enumerate(raw.hierarchy.joints[1:], start=1):
        assert report.bone_scale[joint] == pytest.approx(lengths[1][at] / lengths[0][at], abs=1e-4)
    assert report.bone_scale["left_knee"] == pytest.approx(1 / 0.95, abs=0.02)  # as it was made


def test_place_in_visions_frame_agrees_with_vision():
    raw, vision, body, report = case()
    at = np.searchsorted(raw.time_s, vision.time_s)
    away = np.linalg.norm(moved_bodies.in_vision(body, report)[at] - vision.xyz, axis=2)
    assert 1e3 * np.nanmedian(away, axis=0) == pytest.approx(report.after_mm, rel=0.35)


def test_seen_and_noise_are_visions():
    _, vision, _, report = case()
    seen = np.isfinite(vision.xyz).all(axis=2).mean(axis=0)
    assert report.seen == pytest.approx(seen, abs=1e-3)
    assert np.median(report.noise_mm) == pytest.approx(26, rel=0.25)  # of 20, 20 and 35
    assert min(report.weight) > 0.5


def test_changes_are_of_the_pose_alone():
    raw, _, body, report = case()
    old, new = (forward(posed)[0] for posed in (raw, body))
    assert report.change_mm["root"] == 0
    for joint in ("left_knee", "right_wrist"):
        column = raw.hierarchy.joints.index(joint)
        lengths = [np.linalg.norm(xyz[:, column] - xyz[:, 0], axis=1) for xyz in (old, new)]
        least = 1e3 * np.median(np.abs(lengths[1] - lengths[0]))
        assert report.change_mm[joint] >= least - 1
        assert report.change_mm[joint] < 60


def test_a_report_is_written_as_json(tmp_path):
    report = case()[-1]
    report.write(tmp_path / "report.json")
    read = json.loads((tmp_path / "report.json").read_text())
    assert read["bone_scale"] == report.bone_scale
    assert read["joints"] == list(report.joints)


def test_right_corrections_are_not_doubted():
    assert reports.doubts(case()[-1], lag_s=0.01) == []


def test_vision_in_another_unit_is_told():
    raw, vision, *_ = case()
    large = replace(vision, xyz=2.5 * vision.xyz)
    line, *_ = reports.doubts(correction.correct(raw, large, sigma_m=0.03)[1], lag_s=0.01)
    assert line.startswith("correction by ") and "times as long" in line
    factor = float(line.split("bones ")[1].split(" ")[0])
    assert 2 < factor < 3


@pytest.mark.parametrize("late_s", [0.3, 2.0])
def test_a_wrong_clock_is_told(late_s):
    """A shift of the clock takes up a small error, slow turns and shift a large one."""
    raw, vision, *_ = case()
    late = replace(raw, time_s=raw.time_s + late_s)
    lines = reports.doubts(correction.correct(late, vision, sigma_m=0.03, lag_s=0.01)[1], 0.01)
    wanted = "shift of the clock by" if late_s < 1 else "largest slow turns or shift"
    assert any(wanted in line for line in lines)
