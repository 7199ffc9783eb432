"""What offsets and errors are fitted on: true cameras, the offset taken away, all limbs there."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from courtside.evaluation import error_fit
from courtside.geometry import camera as camera_models
from courtside.kinematics import cutoffs
from courtside.reconstruction import joint_correction, joint_errors
from courtside.records.cameras.footage import Footage
from courtside.records.devices import clocks
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import keypoints, people
from courtside.records.keypoints.skeleton import JOINTS
from courtside.records.truth import session_truth, take_truth
from courtside.study.errors import InputError
from fixtures.cameras import scene
from fixtures.people import found as people_found
from fixtures.people import true_motion, walker

OPTIONS = {**scene.NEAR, "fix_sides": False}
FILTERING = {"max_gap_s": 0.2, "order": 4, "cutoff_hz": dict.fromkeys(walker.SKELETON.groups, 6.0)}
MOVED_M, LAST = np.array([[0.02], [0], [0]]), np.array([[0, 0, 0, 1]])
OFFSETS = Path(__file__).parents[3] / "config" / "joint_offsets" / "blazepose-full.csv"


def test_errors_are_those_beside_the_known_offset():
    cameras, n_frames = scene.ring(3), 100
    record = replace(walker.points(n_frames), xyz=walker.body(n_frames)[None])
    rng = np.random.default_rng(0)
    views = walker.views(record, cameras)
    for view in views:
        view.xy[...] += rng.normal(0, 1, view.xy.shape)
    table = joint_correction.read(OFFSETS)
    true = record.xyz - np.nan_to_num(joint_correction.offsets(record, table, {"p1": "m"}, cameras))
    truth = true_motion.Truth(record.joints, record.person_id, record.time_s, true)
    seen = [Footage(c, view, Clock()) for c, view in zip(cameras, views, strict=True)]
    given = walker.SKELETON, {"p1": "m"}, table, truth, OPTIONS, FILTERING
    columns, error, covariance, weight = error_fit.joints_of(seen, *given)
    frames = range(0, n_frames, round(record.rate_hz / error_fit.MOST_HZ))
    n = len(frames) * len(JOINTS)
    assert len(frames) < n_frames
    assert columns.shape == (n, len(joint_errors.SIGNS)) and covariance.shape == (n, 3, 3)
    assert np.median(np.linalg.norm(error, axis=1)) < 0.02  # of noise; offsets are up to 0.1
    raw = error_fit.triangulated(seen, walker.SKELETON, ["p1"], OPTIONS)
    variances = [np.trace(one, axis1=-2, axis2=-1) for one in (covariance, raw.covariance_2d)]
    assert np.nanmedian(variances[0]) < 0.8 * np.nanmedian(variances[1])  # the joints are filtered
    assert (weight == error_fit.WEIGHT[3]).all()
    assert (error_fit.joints_of(seen[:2], *given)[3] == error_fit.WEIGHT[2]).all()
    none = *given[:2], None, *given[3:]  # of a network without known offsets
    _, whole, _, _ = error_fit.joints_of(seen, *none)
    assert np.median(np.linalg.norm(whole, axis=1)) > np.median(np.linalg.norm(error, axis=1))


def test_a_take_too_short_to_choose_a_cutoff_from_is_named_by_its_person():
    cameras, record = scene.ring(3), walker.points(12)
    views = walker.views(record, cameras)
    seen = [Footage(c, view, Clock()) for c, view in zip(cameras, views, strict=True)]
    truth = true_motion.Truth(record.joints, record.person_id, record.time_s, record.xyz)
    chosen = {**FILTERING, "cutoff_hz": dict.fromkeys(walker.SKELETON.groups, cutoffs.RESIDUAL)}
    with pytest.raises(InputError, match=r"^development take of p1: .*expected .* found "):
        error_fit.joints_of(seen, walker.SKELETON, {"p1": "m"}, None, truth, OPTIONS, chosen)


def test_a_cutoff_too_high_for_a_take_is_told_once_for_all_sets_of_its_cameras(caplog):
    cameras, record = scene.ring(3), walker.points(12)
    record = replace(record, time_s=np.arange(12) / 10, xyz=walker.body(12)[None])
    seen = [
        Footage(camera, replace(view, time_s=record.time_s), Clock())
        for camera, view in zip(cameras, walker.views(record, cameras), strict=True)
    ]
    truth = true_motion.Truth(record.joints, record.person_id, record.time_s, record.xyz)
    given = seen, walker.SKELETON, {"p1": "m"}, None, truth, OPTIONS, FILTERING
    for n_takes in (1, 2):
        found = error_fit.joints_of_sets(*given)
        assert [weight[0] for *_, weight in found] == [0.25, 0.25, 0.25, 0.4]
        told = [line for line in caplog.messages if "lowered to 4.5" in line]
        assert len(told) == n_takes, caplog.messages


def test_all_sets_of_two_or_more_cameras_are_used():
    found = [len(used) for used in error_fit.sets_of_cameras(["a", "b", "c", "d"])]
    assert found == 6 * [2] + 4 * [3] + [4]


def test_cameras_that_were_clicked_wrong_do_not_count(tmp_path):
    cameras, record = scene.ring(3), walker.points(12)
    wrong = [  # the world is moved by 2 cm along x
        replace(one, cam_from_world=one.cam_from_world @ np.block([[np.eye(3), MOVED_M], [LAST]]))
        for one in cameras
    ]
    camera_models.write_toml(tmp_path / "cameras.toml", wrong, source="made")
    session_truth.write(tmp_path / "session.npz", cameras, {}, np.array(["a"]), np.zeros((1, 3)))
    names = [camera.name for camera in cameras]
    clocks.write(tmp_path / "sync.json", "c0", {name: Clock() for name in names})
    index = {name: np.zeros((1, 12), dtype=int) for name in names}
    found = people_found.people(index, record.person_id, model=record.model)
    people.write(tmp_path / "people.npz", found)
    pose2d = [tmp_path / f"{name}.npz" for name in names]
    for path, view in zip(pose2d, walker.views(record, cameras), strict=True):
        keypoints.write_2d(path, view)
    true = take_truth.TakeTruth(
        record.time_s, record.joints, record.person_id, record.xyz, np.zeros((1, 12, 2, 3)),
        dict.fromkeys(names, 0.0), dict.fromkeys(names, 0.0),
    )  # fmt: skip
    take_truth.write(tmp_path / "take.npz", true)
    names = ("cameras.toml", "session.npz", "people.npz", "sync.json", "take.npz")
    keys = ("cameras", "session_truth", "people", "sync", "truth")
    files = {key: tmp_path / name for key, name in zip(keys, names, strict=True)}
    take = {**files, "pose2d": pose2d, "sex_of": {"p1": "f"}}
    ((seen, sex_of, truth),) = error_fit.footage_with_truth([take])
    raw = error_fit.triangulated(seen, walker.SKELETON, list(sex_of), OPTIONS)
    apart = np.linalg.norm(raw.xyz - truth.xyz, axis=-1)
    assert sex_of == {"p1": "f"} and np.nanmax(apart) < 1e-6
