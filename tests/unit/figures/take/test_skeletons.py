"""The paths drawn are the record's."""

from dataclasses import replace

import numpy as np
import pytest
from mpl_toolkits.mplot3d import proj3d

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
    assert sum("z = 2.0 m" in label for label in labels) == 3


def test_several_persons_are_named_at_their_last_place():
    record = walker.points(n_persons=2)
    record.xyz[1, -3:] = np.nan
    drawing = skeletons.draw(record, scene.ring(3), walker.SKELETON)
    named = {text.get_text(): text.xy for text in drawing.axes[1].texts}
    for person, last in (("p1", -1), ("p2", -4)):
        at = record.person_id.tolist().index(person)
        np.testing.assert_allclose(named[person], record.xyz[at, last, :, :2].mean(axis=0))
    alone = skeletons.draw(walker.points(), scene.ring(3), walker.SKELETON)
    assert "p1" not in {text.get_text() for text in alone.axes[1].texts}


def test_labels_of_the_panels_do_not_overlap():
    drawing = skeletons.draw(walker.points(), scene.ring(3), walker.SKELETON)
    drawing.draw_without_rendering()
    space, above = drawing.axes
    (label,) = (text for text in space.texts if text.get_text() == "z (m)")
    assert space.get_zlabel() == ""
    x, y, _ = proj3d.proj_transform(*label.get_position_3d(), space.get_proj())
    middle_px = space.transData.transform((x, y))[0]
    assert middle_px + label.get_window_extent().width / 2 < above.get_tightbbox().x0


@pytest.mark.parametrize("long_m", [4.0, 18.0, 28.0])
def test_the_floor_in_perspective_has_room_for_its_numbers(long_m):
    record = walker.points(n_persons=2)
    record.xyz[1, ..., 1] += long_m
    axis = skeletons.draw(record, scene.ring(3), walker.SKELETON).axes[0]
    low, high = axis.get_ylim()
    numbers = [one for one in axis.yaxis.get_majorticklocs() if low <= one <= high]
    assert 3 <= len(numbers) <= 11


@pytest.mark.parametrize("radius_m", [6.0, 120.0])
def test_the_direction_of_a_camera_is_seen_in_a_hall_of_any_size(radius_m):
    cameras = scene.ring(4, radius_m)
    drawing = skeletons.draw(walker.points(), cameras, walker.SKELETON)
    drawing.draw_without_rendering()
    arrows = [text for text in drawing.axes[1].texts if text.arrow_patch is not None]
    for camera, arrow in zip(cameras, arrows, strict=True):
        tail = drawing.axes[1].transData.transform(arrow.xy)
        way = arrow.get_transform().transform(arrow.get_position()) - tail
        forward = camera.cam_from_world[2, :2]
        points = skeletons.ARROW_POINTS * drawing.dpi / 72
        np.testing.assert_allclose(way, points * forward, atol=0.5)


@pytest.mark.parametrize(("down_m", "bottom_m"), [(0.0, 0.0), (1.2, -1.5)])
def test_people_below_the_origin_are_drawn_in_the_box(down_m, bottom_m):
    record = walker.points()
    record = replace(record, xyz=record.xyz - [0, 0, down_m])
    drawing = skeletons.draw(record, scene.ring(2), walker.SKELETON)
    assert drawing.axes[0].get_zlim()[0] == bottom_m


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
