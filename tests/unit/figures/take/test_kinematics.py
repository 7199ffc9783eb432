"""The figure of kinematics draws the tables' numbers."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from courtside.calibration.court import court
from courtside.exports import measures
from courtside.figures.take import kinematics as speeds
from courtside.kinematics import measures as kinematics
from courtside.kinematics import skeleton_filter
from courtside.records.keypoints import derived_joints
from fixtures.people import footwork, walker

CONFIG = Path(__file__).parents[4] / "config"


@pytest.fixture(scope="module")
def tables():
    time_s, neck = footwork.neck(30, 6, seed=1)
    xyz, _ = footwork.body(neck, time_s)
    record = footwork.record(xyz, time_s, 0.01, 0.0, np.random.default_rng(0))
    how = kinematics.Filter(np.full(len(walker.SKELETON.joints), 6.0))
    table = derived_joints.read(CONFIG / "derived_joints.yaml")
    smooth = skeleton_filter.smooth(record, how.cutoff_hz, how.order)
    people = kinematics.measure(smooth, record, table, "blazepose33", how)
    return measures.frames(people), measures.summary(people, "filtered")


def twice(rows):
    return pd.concat([rows, rows.assign(person="p2")], ignore_index=True)


def test_the_lines_show_the_tables_values(tables):
    frames, summary = tables
    drawing = speeds.draw(frames, summary, court.read(CONFIG / "courts" / "badminton.yaml"))
    drawing.draw_without_rendering()
    plan, speed, angle = drawing.subfigs[0].axes
    paths = [line for line in plan.lines if len(line.get_xdata()) == len(frames)]
    np.testing.assert_array_equal(paths[0].get_xydata(), frames[["neck_x_m", "neck_y_m"]])
    np.testing.assert_array_equal(speed.lines[0].get_ydata(), frames.neck_ground_speed_m_s)
    band = speed.collections[0].get_paths()[0].vertices[:, 1]
    top = frames.neck_ground_speed_m_s + 1.645 * frames.neck_ground_speed_sd_m_s
    assert band.max() == pytest.approx(top.max())
    np.testing.assert_array_equal(angle.lines[0].get_ydata(), frames.left_knee_flexion_deg)
    value = summary.set_index("measure").loc["neck_ground_distance", "value"]
    assert f"{value:.2f}" in plan.get_title()


def test_the_legend_leaves_a_path_at_the_far_end_free(tables):
    frames, summary = tables
    corner = {"neck_x_m": 6.0, "neck_y_m": 13.2}
    shifts = {key: frames[key] - frames[key].max() + end for key, end in corner.items()}
    drawing = speeds.draw(
        frames.assign(**shifts), summary, court.read(CONFIG / "courts" / "badminton.yaml")
    )
    drawing.draw_without_rendering()
    plan = drawing.subfigs[0].axes[0]
    path_px = plan.transData.transform(np.column_stack(list(shifts.values())))
    box = plan.get_legend().get_window_extent()
    assert not [place for place in path_px if box.contains(*place)]


def test_the_limits_of_the_distance_include_the_cameras_error(tables):
    frames, summary = tables
    known = {"value": 12.0, "sigma": 0.3, "sigma_camera": 0.4}
    for camera, reach in ((0.4, 1.645 * 0.5), (np.nan, 1.645 * 0.3)):
        drawing = speeds.draw(frames, summary.assign(**known | {"sigma_camera": camera}), None)
        assert f"12.00 ± {reach:.2f} m" in drawing.subfigs[0].axes[0].get_title()
    short = summary.assign(value=0.28295, sigma=0.01012, sigma_camera=np.nan)
    title = speeds.draw(frames, short, None).subfigs[0].axes[0].get_title()
    assert "0.283 ± 0.017 m on the ground" in title  # as the report has it


def test_a_distance_that_is_unknown_is_told_in_words(tables):
    frames, summary = tables
    title = speeds.draw(frames, summary.assign(value=np.nan), None).subfigs[0].axes[0].get_title()
    assert "nan" not in title and "distance unknown" in title


def test_each_person_has_a_row_and_a_court_is_not_needed(tables):
    frames, summary = (twice(rows) for rows in tables)
    drawing = speeds.draw(frames, summary, None)
    drawing.draw_without_rendering()
    assert len(drawing.subfigs) == 2
    assert drawing.subfigs[1].axes[0].get_title().startswith("p2")


def test_a_path_far_from_the_origin_fills_its_panel_where_there_is_no_court(tables):
    frames, summary = tables
    far = frames.assign(neck_x_m=frames.neck_x_m + 40, neck_y_m=frames.neck_y_m + 60)
    drawing = speeds.draw(far, summary, None)
    drawing.draw_without_rendering()
    axis = drawing.subfigs[0].axes[0]
    path = far[["neck_x_m", "neck_y_m"]].to_numpy()
    low, high = np.transpose([axis.get_xlim(), axis.get_ylim()])
    assert (np.nanmin(path, axis=0) > low).all() and (np.nanmax(path, axis=0) < high).all()
    assert (high - low).max() < 4 * np.ptp(path[np.isfinite(path).all(axis=1)], axis=0).max()


def test_the_table_holds_what_is_drawn(tables):
    rows = speeds.table(tables[0])
    assert {"neck_x_m", "mass_ground_speed_m_s", "trunk_lean_deg"} <= set(rows.columns)
    assert len(rows) == len(tables[0])


def test_a_person_who_was_never_seen_is_drawn_empty(tables):
    frames, summary = (rows.copy() for rows in tables)
    numbers = frames.select_dtypes("number").columns.difference(["time_s", "frame_idx"])
    frames[numbers] = np.nan
    speeds.draw(frames, summary, None).draw_without_rendering()


def test_a_take_of_minutes_is_drawn_by_windows_and_by_the_time_in_each_square(tables):
    frames, summary = tables
    rows = [frames.assign(time_s=frames.time_s + 6.1 * at) for at in range(21)]
    long = pd.concat(rows, ignore_index=True)
    drawing = speeds.draw(long, summary, court.read(CONFIG / "courts" / "badminton.yaml"))
    drawing.draw_without_rendering()
    plan, _, speed, angle = drawing.subfigs[0].axes
    seconds = plan.collections[-1].get_array()
    assert float(np.ma.masked_invalid(seconds).sum()) == pytest.approx(len(long) / 30, rel=0.01)
    assert speed.get_ylabel() == "ground speed (m/s):\nmedian and 5 to 95 %"
    assert angle.get_xlabel() == "time (s): median and 5 to 95 % of each 5 s"
    first = long[long.time_s < 5]
    line = speed.lines[0].get_xydata()[0]
    assert line == pytest.approx([2.5, first.neck_ground_speed_m_s.median()])
    band = speed.collections[0].get_paths()[0].vertices
    at_first = band[band[:, 0] == 2.5, 1]
    wanted = first.neck_ground_speed_m_s.quantile([0.05, 0.95]).tolist()
    assert [at_first.min(), at_first.max()] == pytest.approx(wanted)
