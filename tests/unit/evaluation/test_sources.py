"""Errors and their parts against errors that were put in."""

import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from courtside.body_frame import common
from courtside.body_frame import frame as bodyframe
from courtside.evaluation import sources
from courtside.events import tpose
from courtside.geometry.similarity import Sim3
from courtside.records.devices import device_motion
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import body_motion, derived_joints
from courtside.records.truth import take_truth
from courtside.records.truth.take_truth import TakeTruth
from fixtures.people.bodies_made import body
from fixtures.recordings import device_takes

ROOT = Path(__file__).parents[3]
DERIVED = ROOT / "config" / "derived_joints.yaml"
JOINTS = ["left_hip", "right_hip", "left_wrist", "right_wrist", "right_ankle", "left_ankle"]
UNIT_M = 0.75


def path(time_s, seed=0):
    """Return smooth paths (T, J, 3) in body units."""
    rng = np.random.default_rng(seed)
    hz, phase, size = (
        rng.uniform(0.2, 1.5, (3, 6, 3)),
        rng.uniform(0, 6, (3, 6, 3)),
        [0.4, 0.3, 0.2],
    )
    waves = np.sin(2 * np.pi * hz * np.asarray(time_s)[:, None, None, None] + phase)
    return rng.uniform(-0.7, 0.7, (6, 3)) + np.einsum("k,tkji->tji", size, waves)


TRUE_S = np.arange(0, 20, 1 / 100)
REFERENCE = body(TRUE_S, path(TRUE_S), JOINTS, source="truth", unit_m=UNIT_M)
OWN_S = np.arange(0.5, 19.5, 1 / 30)


def source(
    *, scale=1.0, turn=(0, 0, 0), shift=(0, 0, 0), late_s=0.0, noise=0.0, joints=JOINTS, unit_m=0.7
):
    xyz = scale * path(OWN_S - late_s) @ Rotation.from_rotvec(turn).as_matrix().T + shift
    xyz += noise * np.random.default_rng(1).normal(size=xyz.shape)
    order = [JOINTS.index(name) for name in joints]
    return body(OWN_S, xyz[:, order], joints, unit_m=unit_m)


def parts(**options):
    return sources.split(source(**options), REFERENCE).set_index("part")


def test_an_exact_source_has_no_error():
    _, found = sources.errors(source(), REFERENCE)
    assert set(found) == {
        "body_frame", "trunk_frame", "root_relative", "procrustes_take", "procrustes_frame",
    }  # fmt: skip
    for error in found.values():
        assert np.nanmax(np.abs(error)) < 0.5  # mm: cubic between frames


def test_each_alignment_removes_its_own_error():
    shift = np.array([0.1, -0.05, 0.02])
    turned = source(turn=(0.1, 0.3, -0.1), scale=1.1, shift=shift)
    names, found = sources.errors(turned, REFERENCE)
    assert names == JOINTS
    for alignment in ("procrustes_take", "procrustes_frame"):
        assert np.nanmax(np.abs(found[alignment])) < 0.6
    _, found = sources.errors(source(shift=shift), REFERENCE)
    np.testing.assert_allclose(
        np.nanmean(found["body_frame"], axis=(0, 1)), 1000 * UNIT_M * shift, atol=0.1
    )
    assert np.nanmax(np.abs(found["root_relative"])) < 0.6


def test_the_table_counts_and_adds_up():
    rng = np.random.default_rng(0)
    error = rng.normal(0, 10, (4000, 2, 3)) + np.array([[3, 0, -4], [0, 0, 0]])
    error[:400, 0] = np.nan
    known = np.ones((4000, 2), bool)
    known[:100] = False
    rows = sources.table(["a", "b"], {"body_frame": error}, known).set_index("joint")
    assert rows.n["a"] == 3600
    assert rows.missing_percent["a"] == pytest.approx(100 * 300 / 3900)
    assert rows.missing_percent["b"] == 0
    assert (rows.bias_x_mm["a"], rows.bias_z_mm["a"]) == pytest.approx((3, -4), abs=0.6)
    assert rows.bias_mm["a"] == pytest.approx(5, abs=0.6)
    assert rows.sd_mm["a"] == pytest.approx(10 * np.sqrt(3), rel=0.03)
    np.testing.assert_allclose(rows.rmse_mm**2, rows.bias_mm**2 + rows.sd_mm**2)
    assert rows.median_mm["b"] == pytest.approx(
        10 * np.sqrt(2.366), rel=0.04
    )  # chi, three dimensions
    assert rows.p95_mm["b"] == pytest.approx(10 * np.sqrt(7.815), rel=0.04)
    assert rows.n["all"] == 3600 + 3900


@pytest.mark.parametrize(
    ("options", "part", "value"),
    [
        ({"scale": 1.08}, "scale", 1 / 1.08),
        ({"turn": (0.0, 0.2, 0.0)}, "rotation", np.degrees(0.2)),
        ({"late_s": 0.05}, "time", -0.05),
        ({"shift": (0.06, 0.0, 0.08)}, "origin", 100 * UNIT_M),
        ({"noise": 0.05}, "remainder", None),
    ],
)
def test_a_single_error_is_attributed_to_its_own_part(options, part, value):
    rows = parts(**options)
    assert rows.percent[part] > 90
    assert rows.percent["all"] == pytest.approx(100)
    if value is not None:
        assert rows.value[part] == pytest.approx(value, rel=0.02)


def test_the_parts_add_up_and_none_is_negative():
    options = {
        "scale": 1.05,
        "turn": (0.05, 0.1, 0),
        "late_s": 0.03,
        "shift": (0.05, 0, 0),
        "noise": 0.03,
    }
    rows = parts(**options)
    named = rows.drop(index="all")
    assert named.mean_square_mm2.sum() == pytest.approx(rows.mean_square_mm2["all"])
    assert (named.mean_square_mm2 > 0).all()
    expected = 3 * (0.03 * 1000 * UNIT_M) ** 2 / 1.05**2
    assert rows.mean_square_mm2["remainder"] == pytest.approx(expected, rel=0.03)
    assert rows.value["scale"] == pytest.approx(1 / 1.05, rel=0.005)
    assert rows.value["time"] == pytest.approx(-0.03, abs=0.002)
    assert rows.value["rotation"] == pytest.approx(np.degrees(np.hypot(0.05, 0.1)), rel=0.05)


def test_only_joints_of_both_are_compared():
    few = source(joints=["left_hip", "right_hip", "right_ankle", "left_wrist", "right_wrist"])
    names, found = sources.errors(few, REFERENCE)
    assert names == ["left_hip", "right_hip", "right_ankle", "left_wrist", "right_wrist"]
    assert found["body_frame"].shape[1] == 5


RNG = np.random.default_rng(0)
TRUE = Sim3(1.3, Rotation.random(rng=RNG).as_matrix(), RNG.normal(size=3))
POSE = np.column_stack([Rotation.random(rng=RNG).as_matrix(), RNG.normal(size=3)])
STRAIGHT = np.eye(3)


def own(turn=STRAIGHT, longer=1.0, shift_m=(0, 0, 0)):
    """Return the frame of a device at `POSE` that is off by a turn and a shift in body axes."""
    world_from_device = Sim3(1.0, POSE[:, :3].T, -POSE[:, :3].T @ POSE[:, 3])
    rotation = turn @ TRUE.rotation @ world_from_device.rotation
    origin = TRUE.inverse().translation + TRUE.rotation.T @ np.array(shift_m)
    origin = POSE[:, :3] @ origin + POSE[:, 3]
    scale = TRUE.scale / longer
    return Sim3(scale, rotation, -scale * rotation @ origin)


def test_an_exact_frame_has_no_error():
    found = sources.body_frame_errors(own(), POSE, TRUE)
    assert found == pytest.approx({"angle_deg": 0, "unit_percent": 0, "origin_mm": 0}, abs=1e-5)


def test_rotation_unit_and_shift_are_separated():
    turn = Rotation.from_rotvec(np.radians([1.0, -2.0, 2.0])).as_matrix()
    found = sources.body_frame_errors(own(turn, 1.02, (0.003, 0, 0.004)), POSE, TRUE)
    assert found == pytest.approx({"angle_deg": 3.0, "unit_percent": 2.0, "origin_mm": 5.0})


def test_a_take_without_a_clap_has_all_errors_but_no_true_arcs(tmp_path, caplog):
    times, xyz, _ = device_takes.truth()
    joints = np.array(device_takes.JOINTS)
    nobody = {"offset_s": {}, "drift_ppm": {}}
    true = TakeTruth(
        times, joints, np.array(["p1"]), xyz[None], np.zeros((1, len(times), 2, 3)), **nobody
    )
    take_truth.write(tmp_path / "truth.npz", true)
    motion = device_motion.of_truth(true, "p1")
    table = derived_joints.read(DERIVED)
    at = bodyframe.at_tpose(
        motion, bodyframe.anchors(table, derived_joints.RIG, joints), tpose.find(motion)[0]
    )
    clapped = {"cam": [at.tpose.stop_s + 1.0], "suit": []}
    for name, clap_s in clapped.items():
        own = common.aligned(replace(motion, source=name), at, Clock(), clap_s)
        body_motion.write(tmp_path / f"{name}.npz", own)
    main = runpy.run_path(str(ROOT / "workflow" / "scripts" / "evaluate_sources.py"))["main"]
    files = [tmp_path / f"{name}.csv" for name in ("errors", "parts", "paths", "distortion")]
    bodies = [tmp_path / f"{name}.npz" for name in clapped]
    for used in (bodies[:1], bodies):
        alone = [file.read_text() for file in files[2:] if file.exists()]
        given = used, tmp_path / "truth.npz", DERIVED, *files
        main(*given, labels={"take": "late"}, person="p1", sparc_rate_hz=30)
    assert len(alone) == 2  # numbers of the other source are written as without this one
    assert all(
        file.read_text().startswith(text) for file, text in zip(files[2:], alone, strict=True)
    )
    errors, parts, paths, distortion = map(pd.read_csv, files)
    assert set(errors["source"]) == set(parts["source"]) == set(clapped)
    assert set(paths["source"]) == {"cam"}
    counts = distortion.groupby("source")["n"].sum()
    assert counts["cam"] > 0 and counts["suit"] == 0
    assert distortion["sparc"].isna().tolist() == [False, False, True, True]
    (line,) = [line for line in caplog.messages if "arcs" in line]
    assert line.startswith("no true arcs of suit: expected a clap within 3 s of the T-pose of ")
    assert line.endswith("found claps at no time; clap after each T-pose")
