"""What is drawn on pictures lies where OpenCV projects it, and the table says the same."""

import numpy as np
import pytest

from courtside.figures.style import style
from courtside.figures.take import overlay
from courtside.geometry import camera as camera_models
from fixtures.cameras import scene
from fixtures.people import walker

CAMERAS = scene.ring(3)


def inputs(n_persons=1, offset_px=(3.0, 4.0)):
    record = walker.points(n_persons=n_persons)
    return record, walker.views(record, CAMERAS, offset_px)


def test_the_table_holds_the_distances():
    record, views = inputs(n_persons=2)
    times_s = overlay.chosen_times(record, 2)
    rows = overlay.table([CAMERAS] * 2, views, record, times_s)
    assert len(rows) == 2 * 3 * 2 * 33
    np.testing.assert_allclose(rows.distance_px.dropna(), 5.0, atol=1e-6)
    truth = scene.opencv_projection(CAMERAS[1], record.xyz[0, 6, :1])[0]
    at = rows[(rows.camera == "c1") & (rows.person == "p1") & (rows.joint == "nose")].iloc[0]
    assert at.time_s == pytest.approx(record.time_s[6])
    np.testing.assert_allclose([at.reprojected_x_px, at.reprojected_y_px], truth, atol=1e-6)


def test_each_time_has_its_own_cameras():
    record, views = inputs(offset_px=(0.0, 0.0))
    times_s = overlay.chosen_times(record, 2)
    turned = [camera_models.turned(camera, [0, 14 / 1400, 0]) for camera in CAMERAS]
    rows = overlay.table([CAMERAS, turned], views, record, times_s)
    still, moved = (rows[rows.time_s == time_s].distance_px.dropna() for time_s in times_s)
    assert still.max() < 1e-6
    assert moved.between(13.9, 17).all()  # 14 px in the middle of the picture


def test_times_are_evenly_spread_without_the_ends():
    record, _ = inputs()
    times_s = overlay.chosen_times(record, 3)
    assert len(times_s) == 3
    assert record.time_s[0] < times_s[0] < times_s[-1] < record.time_s[-1]


def drawn(monkeypatch, accepted=True, detected_offset=(200.0, 0.0)):
    """Return the panel at full size over a black picture, and where its corner lies."""
    monkeypatch.setattr(overlay, "PANEL_PX", 10_000)
    record, _ = inputs()
    xy = overlay.reproject(CAMERAS[0], record, record.time_s[6])
    image = np.zeros((1080, 1920, 3), np.uint8)
    flags = np.full(xy.shape[:2], accepted)
    panel = overlay.panel(image, xy + detected_offset, xy, flags, walker.SKELETON)
    x, y, side = overlay._extent(xy + detected_offset, xy, image)
    corner = np.array([max(0, int(x - side / 2)), max(0, int(y - side / 2))])
    return record, panel, corner


def test_reprojected_bones_lie_where_opencv_projects_them(monkeypatch):
    record, panel, corner = drawn(monkeypatch)
    for joint in ("left_knee", "nose", "right_wrist"):
        xyz = record.xyz[0, 6, [walker.SKELETON.index(joint)]]
        x, y = np.round(scene.opencv_projection(CAMERAS[0], xyz)[0] - corner).astype(int)
        assert tuple(panel[y, x]) == style.REPROJECTED_BGR
        assert tuple(panel[y, x + 200]) == style.DETECTED_BGR


def test_red_lines_only_where_a_view_was_not_used(monkeypatch):
    for accepted in (True, False):
        _, panel, _ = drawn(monkeypatch, accepted)
        red = (panel[..., 2] > 150) & (panel[..., :2] < 60).all(axis=2)
        assert red.any() == (not accepted)


def test_nobody_seen_shows_the_whole_picture():
    nothing = np.full((1, 33, 2), np.nan)
    image = np.zeros((100, 160, 3), np.uint8)
    panel = overlay.panel(image, nothing, nothing, np.zeros((1, 33), bool), walker.SKELETON)
    assert panel.shape == image.shape


def test_the_figure_has_a_panel_for_each_camera_and_time():
    panels = [[np.zeros((20, 20, 3), np.uint8)] * 3] * 2
    drawing = overlay.draw(panels, [0.1, 0.2], ["c0", "c1", "c2"])
    assert [axis.get_title() for axis in drawing.axes][:2] == ["c0, 0.10 s", "c1, 0.10 s"]
    assert len(drawing.axes) == 6
