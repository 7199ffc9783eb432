"""The figure of shake draws the tables' numbers, in pixels and millimetres."""

import numpy as np
import pandas as pd
import pytest

from courtside.figures.style import style
from courtside.figures.take import camera_shake
from courtside.geometry.camera import Camera

FOCAL = 1500.0
PLAYER = np.array([0.0, 0.0, 6.0])
NAMES = ["shift_x_px", "shift_y_px", "rotation_deg", "zoom_percent", "sigma_px"]


def shake(level_px, seed):
    """Return 8 s at 30 Hz with the shift right at a level from 4 s on."""
    shift = np.random.default_rng(seed).normal(0, 0.05, (240, 2))
    shift[120:, 0] += level_px
    made = pd.DataFrame(shift, columns=NAMES[:2])
    made[NAMES[2:]] = 0.0, 0.0, 0.05
    return made.assign(frame_idx=made.index, time_s=made.index / 30, n_matches=150)


@pytest.fixture
def rows():
    cameras, shakes = {}, {"left": shake(0, 0), "mirror": shake(9, 1), "dark": shake(0, 2)}
    for name in shakes:
        pose = np.column_stack([np.eye(3), [0, 0, 3.0]])
        matrix = np.array([[FOCAL, 0, 959.5], [0, FOCAL, 539.5], [0, 0, 1]])
        cameras[name] = Camera(name, (1920, 1080), matrix, np.zeros(5), pose)
    shakes["dark"].loc[:, NAMES] = np.nan
    shakes["left"].loc[30:39, NAMES] = np.nan
    return camera_shake.table(cameras, shakes, PLAYER)


def test_the_table_holds_pixels_millimetres_and_bumps(rows):
    assert rows.camera.value_counts().to_dict() == {"left": 240, "mirror": 240, "dark": 240}
    known = rows[rows.shift_x_px.notna()]
    expected = 1000 * 9.0 / FOCAL * np.hypot(known.shift_x_px, known.shift_y_px)
    np.testing.assert_allclose(known.shift_mm, expected)
    (knock,) = rows[rows.knock_px.notna()].itertuples()
    assert (knock.camera, knock.frame_idx) == ("mirror", 120)
    assert knock.knock_px == pytest.approx(9.0, abs=0.05)
    assert knock.knock_deg == pytest.approx(np.degrees(9 / FOCAL), abs=0.005)


def test_each_camera_has_a_panel_with_its_lines_and_both_axes(rows):
    drawing = camera_shake.draw(rows)
    drawing.draw_without_rendering()
    panels = drawing.axes
    assert len(panels) == 3
    mirror = rows[rows.camera == "mirror"]
    np.testing.assert_array_equal(panels[1].lines[0].get_ydata(), mirror.shift_x_px)
    np.testing.assert_array_equal(panels[1].lines[1].get_ydata(), mirror.shift_y_px)
    assert panels[1].lines[2].get_xdata()[0] == pytest.approx(4.0)  # the knock
    (right,) = panels[1].child_axes
    np.testing.assert_allclose(right.get_ylim(), np.multiply(panels[1].get_ylim(), 9000 / FOCAL))
    assert panels[2].child_axes == []


def test_titles_state_shake_missing_frames_and_bumps(rows):
    left, mirror, dark = (panel.get_title(loc="left") for panel in camera_shake.draw(rows).axes)
    assert left == "left: 0.05 px rms; 10 of 240 frames unknown"
    assert mirror == "mirror: 0.05 px rms; knocked at 4.0 s (9 px, 0.34°)"
    assert dark == "dark: too little background seen"


def test_without_a_player_there_are_pixels_only(rows, tmp_path):
    rows = rows.assign(shift_mm=np.nan)
    drawing = camera_shake.draw(rows)
    assert [panel.child_axes for panel in drawing.axes] == [[], [], []]
    paths = [tmp_path / f"shake.{kind}" for kind in ("pdf", "png", "csv")]
    style.save(drawing, rows, *paths)
    assert len(pd.read_csv(paths[2])) == 720
