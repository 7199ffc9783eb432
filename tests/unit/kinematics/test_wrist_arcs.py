"""Wrists on circles about the shoulders are on their own arcs, not on that about the navel."""

import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from courtside.kinematics import wrist_arcs
from courtside.records.keypoints import body_motion
from courtside.study.errors import InputError
from fixtures.people.bodies_made import body

SCRIPTS = Path(__file__).parents[3] / "workflow" / "scripts"
JOINTS = ["left_shoulder", "right_shoulder", "left_wrist", "right_wrist"]
ASIDE, ARM, BACK = 0.25, 0.75, -0.05


def swing(off=0.0, stretch_z=1.0):
    """Return a body whose straight arms close in the second after the T-pose."""
    time_s = np.arange(0, 2.5, 1 / 60)
    meet = np.pi / 2 + np.arcsin(ASIDE / ARM)
    angle = np.clip(time_s - 1.0, 0, 1) * meet
    out = np.where(time_s > 1.0, off, 0.0)
    xyz = np.zeros((len(time_s), 4, 3))
    for k, sign in ((0, 1), (1, -1)):
        xyz[:, k] = [sign * ASIDE, 0.4, BACK]
        reach = ARM + out
        xyz[:, k + 2, 0] = sign * (ASIDE + reach * np.cos(angle))
        xyz[:, k + 2, 1] = 0.4
        xyz[:, k + 2, 2] = BACK + stretch_z * reach * np.sin(angle)
    return body(time_s, xyz, JOINTS)


def test_a_path_about_the_shoulder_has_no_distortion():
    left, right = wrist_arcs.arcs(swing())
    assert left.side == "left" and right.side == "right"
    for arc, sign in ((left, 1), (right, -1)):
        np.testing.assert_allclose(arc.shoulder, [sign * ASIDE, BACK])
        assert arc.radius == pytest.approx(ARM)
        np.testing.assert_allclose(arc.off_arc, 0, atol=1e-12)
        np.testing.assert_allclose(arc.meeting, [0, BACK + np.sqrt(ARM**2 - ASIDE**2)])
        assert arc.time_s[0] >= 1.0 and arc.time_s[-1] <= 2.0
    row = wrist_arcs.distortion([left]).iloc[0]
    assert row.end_radius == pytest.approx(row.meeting_z, abs=0.02)
    assert row.end_radius == pytest.approx(0.657, abs=0.02)  # not 1: the circle is out of reach
    assert row.mean_off_circle > 0.1


@pytest.mark.parametrize("off", [0.04, -0.03])
def test_a_path_outside_or_inside_is_off_by_that(off):
    rows = wrist_arcs.distortion(wrist_arcs.arcs(swing(off=off)))
    np.testing.assert_allclose(rows.mean_signed, off, atol=abs(off) / 30)
    np.testing.assert_allclose(rows.mean_distance, abs(off), atol=abs(off) / 30)
    np.testing.assert_allclose(rows.p95_distance, abs(off), rtol=1e-9)


def test_depth_that_is_pressed_flat_shows():
    rows = wrist_arcs.distortion(wrist_arcs.arcs(swing(stretch_z=0.7)))
    assert np.all(rows.mean_signed < -0.05)
    assert np.all(rows.p95_distance > rows.mean_distance)


def test_arms_out_of_reach_have_no_meeting_point():
    left, _ = wrist_arcs.arcs(swing())
    short = wrist_arcs.Arc("left", left.time_s, left.path, np.array([0.25, 0.0]), 0.2)
    assert np.isnan(short.meeting[1])


def test_missing_points_are_counted_out():
    made = swing()
    made.fixed[70:80, 2] = np.nan
    rows = wrist_arcs.distortion(wrist_arcs.arcs(made)).set_index("side")
    assert rows.n["right"] - rows.n["left"] == 10
    assert rows.mean_distance["left"] == pytest.approx(0, abs=1e-12)


def test_the_paths_are_a_table():
    rows = wrist_arcs.paths(wrist_arcs.arcs(swing()))
    assert isinstance(rows, pd.DataFrame)
    assert list(rows.columns) == ["side", "time_s", "x", "z", "off_arc", "off_circle"]
    first = rows[rows.side == "left"].iloc[0]
    assert (first.x, first.z) == pytest.approx((1.0, BACK), abs=0.02)


def test_no_clap_after_the_t_pose():
    made = swing()
    made.clap_s[:] = 0.5
    with pytest.raises(InputError, match=r"made: expected a clap .* claps at 0\.50"):
        wrist_arcs.arcs(made)
    assert wrist_arcs.missing(swing()) == ""


def test_a_clap_long_after_the_t_pose_ends_no_arc():
    """Between them the person plays: those paths are no arcs."""
    made = swing()
    late = replace(made, time_s=made.time_s + 3.0, clap_s=np.array([1.0 + 3.5]))
    with pytest.raises(InputError, match=r"within 3 s of the T-pose of .* found claps at 4\.50"):
        wrist_arcs.arcs(late)


def test_without_a_t_pose_the_tables_say_that_there_is_no_point():
    made = swing()
    made.tpose_s[:] = np.nan
    with pytest.raises(InputError, match="made: expected a T-pose, found only the rest pose"):
        wrist_arcs.arcs(made)
    rows = wrist_arcs.distortion([])
    assert rows[["side", "n"]].to_numpy().tolist() == [["left", 0], ["right", 0]]
    assert rows.drop(columns=["side", "n"]).isna().all(axis=None)
    assert rows.columns.tolist() == wrist_arcs.distortion(wrist_arcs.arcs(swing())).columns.tolist()
    points = wrist_arcs.paths([])
    assert len(points) == 0
    assert points.columns.tolist() == wrist_arcs.paths(wrist_arcs.arcs(swing())).columns.tolist()


def test_the_script_goes_on_where_a_source_has_no_t_pose(tmp_path, caplog):
    """Of a suit alone as of a suit beside a camera that shows one."""
    none, both = (replace(swing(), source=name) for name in ("suit", "cam"))
    none = replace(none, tpose_s=np.full(2, np.nan))
    files = {one.source: tmp_path / f"{one.source}.npz" for one in (none, both)}
    body_motion.write(files["suit"], none)
    body_motion.write(files["cam"], both)
    script = runpy.run_path(str(SCRIPTS / "measure_arcs.py"))
    for names in (["suit"], ["suit", "cam"]):
        tables = tmp_path / "paths.csv", tmp_path / "distortion.csv"
        script["main"]([files[name] for name in names], *tables, sparc_rate_hz=30)
        paths, distortion = map(pd.read_csv, tables)
        assert set(paths["source"]) == set(names) - {"suit"}
        assert distortion["source"].tolist() == [name for name in names for _ in range(2)]
        counts = distortion.groupby("source")["n"].sum()
        assert counts["suit"] == 0 and (counts.drop("suit") > 0).all()
        assert "no arcs of suit: expected a T-pose" in caplog.text
