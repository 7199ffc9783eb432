"""What is drawn on pictures lies where OpenCV projects it, and the table says the same."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.figures.style import picture_crops
from courtside.figures.take import overlay
from courtside.records.cameras.footage import Footage
from courtside.records.devices.clocks import Clock
from fixtures.cameras import scene
from fixtures.people import takes_made, walker

CAMERAS = scene.ring(3)
IMAGE = np.zeros((1080, 1920, 3), np.uint8)


def inputs(n_persons=1, offset_px=(3.0, 4.0)):
    record = walker.points(n_persons=n_persons)
    views = walker.views(record, CAMERAS, offset_px)
    pairs = zip(CAMERAS, views, strict=True)
    return record, [Footage(camera, view, Clock(), "") for camera, view in pairs]


def test_the_table_holds_the_distances():
    record, footage = inputs(n_persons=2)
    rows = overlay.table(record, footage, overlay.frames(record, 2), walker.SKELETON)
    assert len(rows) == 2 * 3 * 2 * 33
    np.testing.assert_allclose(rows.distance_px.dropna(), 5.0, atol=1e-6)
    truth = scene.opencv_projection(CAMERAS[1], record.xyz[0, 6, :1])[0]
    at = rows[(rows.camera == "c1") & (rows.person == "p1") & (rows.joint == "nose")].iloc[0]
    assert at.time_s == pytest.approx(record.time_s[6])
    np.testing.assert_allclose([at.reprojected_x_px, at.reprojected_y_px], truth, atol=1e-6)


def test_exchanged_sides_are_taken_as_the_fusion_took_them():
    record, footage = inputs(offset_px=(0.0, 0.0))
    mirror = walker.SKELETON.mirror()
    crossed = replace(footage[1].tracklets, xy=footage[1].tracklets.xy[:, :, mirror])
    footage[1] = replace(footage[1], tracklets=crossed)
    record.swapped[..., 1] = True
    rows = overlay.table(record, footage, [6], walker.SKELETON)
    assert rows.distance_px.max() < 1e-6
    record = replace(record, accepted=np.zeros_like(record.accepted))
    images = [[IMAGE] * 3]
    for axis in overlay.draw(record, footage, [6], images, walker.SKELETON).axes:
        red = joints_of(axis, picture_crops.MARKED).reshape(-1, 2, 2)
        np.testing.assert_allclose(red[:, 0], red[:, 1], atol=1e-6)


def test_each_frame_has_its_own_camera():
    record, footage = inputs(offset_px=(0.0, 0.0))
    shown = overlay.frames(record, 2)
    turns = np.zeros((len(record.time_s), 3))
    turns[shown[1]] = [0, 14 / 1400, 0]
    rows = overlay.table(
        record, [replace(one, turns=turns) for one in footage], shown, walker.SKELETON
    )
    times_s = record.time_s[shown]
    still, moved = (rows[rows.time_s == time_s].distance_px.dropna() for time_s in times_s)
    assert still.max() < 1e-6
    assert moved.between(13.9, 17).all()  # 14 px in the middle of the picture


def test_a_picture_between_two_frames_is_compared_with_the_skeleton_of_its_own_time():
    record, footage = inputs(offset_px=(0.0, 0.0))
    late_s = 0.4 * (record.time_s[1] - record.time_s[0])
    view, xyz = footage[1].tracklets, record.xyz[0]
    later = xyz[:-1] + 0.4 * np.diff(xyz, axis=0)
    xy = view.xy.copy()
    for frame, body in enumerate(later):
        xy[0, frame] = scene.opencv_projection(CAMERAS[1], body)
    seen = replace(view, time_s=view.time_s + late_s, xy=xy)
    footage[1] = replace(footage[1], tracklets=seen)
    rows = overlay.table(record, footage, [8], walker.SKELETON)
    assert rows[rows.camera == "c1"].distance_px.max() < 1e-6


def test_a_camera_that_does_not_film_has_neither_a_picture_nor_joints():
    record, footage = inputs()
    footage[1] = takes_made.stopped(footage[1], 8)
    rows = overlay.table(record, footage, [6, 12], walker.SKELETON)
    off = rows[(rows.camera == "c1") & (rows.time_s == record.time_s[12])]
    columns = [name for name in off if name.endswith("_px")]
    assert off[columns].isna().all(axis=None)
    assert rows.drop(off.index)[columns].notna().all(axis=None)
    none, *_ = picture_crops.at_frame(footage[1], record, 12, walker.SKELETON, hidden=True)
    images = [[IMAGE] * 3, [IMAGE, none, IMAGE]]
    drawing = overlay.draw(record, footage, [6, 12], images, walker.SKELETON)
    said = [[text.get_text() for text in axis.texts] for axis in drawing.axes]
    assert said == [[], [], [], [], ["does not film then"], []]
    assert not drawing.axes[4].images
    assert len(joints_of(drawing.axes[4], picture_crops.MARKED)) == 0


def test_frames_are_evenly_spread_without_the_ends():
    record, _ = inputs()
    shown = overlay.frames(record, 3)
    assert len(shown) == 3
    assert 0 < shown[0] < shown[-1] < len(record.time_s) - 1


def test_pictures_of_eight_cameras_are_as_wide_as_those_of_four():
    sizes = []
    for count in (4, 5, 8):
        cameras = scene.ring(count)
        record = walker.points(n_cameras=count)
        views = walker.views(record, cameras, (3.0, 4.0))
        pairs = zip(cameras, views, strict=True)
        footage = [Footage(camera, view, Clock(), "") for camera, view in pairs]
        drawing = overlay.draw(record, footage, [6, 9], [[IMAGE] * count] * 2, walker.SKELETON)
        drawing.draw_without_rendering()
        titles = [axis.get_title() for axis in drawing.axes]
        times = [f"{record.time_s[frame]:.2f} s" for frame in (6, 9)]
        assert titles == [f"c{k}, {time}" for time in times for k in range(count)]
        sizes.append([axis.get_window_extent().width for axis in drawing.axes])
    assert min(sizes[1]) > 0.95 * max(sizes[0]) and min(sizes[2]) > 0.95 * max(sizes[0])


def drawn(accepted=True):
    """Return the axis of a panel in which joints are detected 200 px beside the true ones."""
    record, footage = inputs(offset_px=(200.0, 0.0))
    record = replace(record, accepted=np.full_like(record.accepted, accepted))
    drawing = overlay.draw(record, footage[:1], [6], [[IMAGE]], walker.SKELETON)
    return record, drawing.axes[0]


def joints_of(axis, colour):
    lines = [line for line in axis.lines if line.get_color() == colour]
    return np.concatenate([line.get_xydata() for line in lines]) if lines else np.empty((0, 2))


def test_reprojected_bones_lie_where_opencv_projects_them():
    record, axis = drawn()
    for joint in ("left_knee", "nose", "right_wrist"):
        xyz = record.xyz[0, 6, [walker.SKELETON.index(joint)]]
        xy = scene.opencv_projection(CAMERAS[0], xyz)[0]
        for colour, beside in ((picture_crops.REPROJECTED, 0), (picture_crops.DETECTED, 200)):
            apart = np.linalg.norm(joints_of(axis, colour) - xy - [beside, 0], axis=1)
            assert apart.min() < 1e-6


def test_red_lines_only_where_a_view_was_not_used():
    for accepted in (True, False):
        red = joints_of(drawn(accepted)[1], picture_crops.MARKED).reshape(-1, 2, 2)
        assert len(red) == (0 if accepted else 33)
        np.testing.assert_allclose(
            red[:, 0] - red[:, 1], np.tile([200.0, 0.0], (len(red), 1)), atol=1e-9
        )


def test_nobody_seen_shows_the_whole_picture():
    record, footage = inputs()
    record = replace(record, xyz=np.full_like(record.xyz, np.nan))
    seen = footage[0].tracklets
    unseen = replace(seen, xy=np.full_like(seen.xy, np.nan))
    nobody = [replace(footage[0], tracklets=unseen)]
    axis = overlay.draw(record, nobody, [6], [[IMAGE]], walker.SKELETON).axes[0]
    (left, right), (bottom, top) = axis.get_xlim(), axis.get_ylim()
    assert left <= 0 <= 1920 <= right and top <= 0 <= 1080 <= bottom


def test_the_figure_has_a_panel_for_each_camera_and_time():
    record, footage = inputs()
    drawing = overlay.draw(record, footage, [5, 10], [[IMAGE] * 3] * 2, walker.SKELETON)
    assert [axis.get_title() for axis in drawing.axes][:2] == ["c0, 0.10 s", "c1, 0.10 s"]
    assert len(drawing.axes) == 6
