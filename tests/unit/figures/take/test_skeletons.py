"""The paths drawn are the record's."""

from dataclasses import replace

import numpy as np

from courtside.figures.style import oblique_view, style
from courtside.figures.take import skeletons
from fixtures.cameras import scene
from fixtures.people import walker


def test_the_table_holds_the_records_paths():
    record = walker.points(n_persons=2)
    rows = skeletons.table(record)
    one = rows[(rows.person == "p2") & (rows.joint == "left_ankle")]
    at = record.joints.tolist().index("left_ankle")
    np.testing.assert_array_equal(one[["x_m", "y_m", "z_m"]], record.xyz[1, :, at])
    assert len(rows) == 2 * 4 * 20


def test_left_and_right_have_their_colours():
    drawing = skeletons.draw(walker.points(), scene.ring(3), walker.SKELETON)
    colours = {line.get_color() for line in drawing.axes[0].lines}
    assert {style.LEFT, style.RIGHT, style.MIDDLE} <= colours
    labels = [text.get_text() for text in drawing.axes[1].texts]
    assert sum("2.0 m high" in label for label in labels) == 3


def test_a_take_without_any_point_is_drawn_empty():
    record = walker.points()
    empty = replace(record, xyz=np.full_like(record.xyz, np.nan))
    drawing = skeletons.draw(empty, scene.ring(2), walker.SKELETON)
    drawing.draw_without_rendering()


def test_a_joint_far_away_does_not_fill_the_drawing_with_lines():
    record = walker.points()
    far = record.xyz.copy()
    far[0, :10] += [4e7, -5e7, 1e7]
    drawing = skeletons.draw(replace(record, xyz=far), scene.ring(2), walker.SKELETON)
    assert len(drawing.axes[0].lines) < 300
    drawing.draw_without_rendering()


def test_the_grid_has_whole_metres_and_is_wider_in_a_wider_view():
    low, high = np.array([-1.3, 0.2, 0]), np.array([2.4, 3.0, 2])
    xs, ys = oblique_view.grid_m(low, high)
    assert xs.tolist() == [-1, 0, 1, 2] and ys.tolist() == [1, 2, 3]
    xs, _ = oblique_view.grid_m(low, np.array([302.4, 3.0, 2]))
    assert xs[:3].tolist() == [0, 10, 20] and xs[-1] == 300
