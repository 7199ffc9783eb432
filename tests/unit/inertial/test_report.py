"""The report of a correction says what was done: against the bodies themselves."""

import json
from functools import cache

import numpy as np
import pytest

from courtside.inertial import correction
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
