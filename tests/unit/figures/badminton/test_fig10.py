"""Trails hold the points of the frames up to each instant, and pictures what was detected then."""

import numpy as np

from courtside.figures.badminton import fig10
from courtside.figures.style import oblique_view, picture_crops
from fixtures.people import takes_made, walker

FRAMES = slice(2, 19)


def test_instants_span_the_frames():
    np.testing.assert_array_equal(fig10.instants(FRAMES, 3), [2, 10, 18])
    np.testing.assert_array_equal(fig10.instants(slice(4, 6), 3), [4, 5])


def test_trails_are_the_joints_of_these_frames():
    record, _ = takes_made.take(n_persons=2)
    found = fig10.trails(takes_made.STICK.of(record.xyz), takes_made.STICK, FRAMES)
    assert set(found) == {"neck", "left_wrist", "right_wrist", "left_ankle", "right_ankle"}
    wrist = record.xyz[:, 2:19, walker.SKELETON.index("right_wrist")]
    np.testing.assert_array_equal(found["right_wrist"], wrist)
    shoulders = [walker.SKELETON.index(f"{side}_shoulder") for side in ("left", "right")]
    np.testing.assert_allclose(found["neck"], record.xyz[:, 2:19, shoulders].mean(axis=2))


def test_the_table_holds_all_frames_and_says_which_are_drawn():
    record, _ = takes_made.take()
    rows = fig10.table(record, takes_made.STICK, FRAMES, [2, 10, 18])
    assert len(rows) == 17 * 14
    np.testing.assert_allclose(rows[rows.drawn].time_s.unique(), record.time_s[[2, 10, 18]])
    assert set(rows[rows.trail].joint) == set(fig10.TRAILS)
    at = rows[(rows.joint == "left_elbow")].iloc[5]
    xyz = record.xyz[0, 7, walker.SKELETON.index("left_elbow")]
    np.testing.assert_allclose([at.x_m, at.y_m, at.z_m], xyz)


def drawn():
    record, seen = takes_made.take()
    shown = fig10.instants(FRAMES, 3)
    images = takes_made.pictures()
    pictures = [
        {
            one.camera.name: (images[one.camera.name], takes_made.STICK.of(one.view.xy[:, frame]))
            for one in seen
        }
        for frame in shown
    ]
    return record, fig10.draw(record, takes_made.STICK, FRAMES, shown, pictures)


def test_each_row_has_its_trails_up_to_its_instant():
    record, drawing = drawn()
    for row, last in enumerate((2, 10, 18)):
        axis = drawing.axes[4 * row + 3]
        trails = [line for line in axis.lines if line.get_marker() == "."]
        assert [len(line.get_xdata()) for line in trails] == [last - 2 + 1] * 5
        wrist = record.xyz[0, 2 : last + 1, walker.SKELETON.index("left_wrist")]
        wanted = oblique_view.Sight().seen(wrist)
        assert any(np.allclose(line.get_xydata(), wanted) for line in trails)


def test_all_rows_are_to_one_scale_and_show_one_part_of_each_picture():
    _, drawing = drawn()
    for column in range(4):
        limits = {drawing.axes[4 * row + column].get_xlim() for row in range(3)}
        assert len(limits) == 1
    assert [axis.get_title() for axis in drawing.axes[:3]] == ["c0", "c1", "c2"]
    drawing.draw_without_rendering()


def test_a_camera_that_films_later_shows_the_same_part_then():
    record, seen = takes_made.take()
    shown, images = fig10.instants(FRAMES, 3), takes_made.pictures()

    def pictures(first):
        rows = [{n: (image, np.full((1, 14, 2), np.nan)) for n, image in images.items()}] * 3
        return [{**rows[0], "c1": (first, rows[0]["c1"][1])}, *rows[1:]]

    none = picture_crops.at_frame(
        takes_made.stopped(seen[1], 5), record, shown[-1], walker.SKELETON, hidden=True
    )[0]
    whole, late = (
        fig10.draw(record, takes_made.STICK, FRAMES, shown, pictures(first)).axes
        for first in (images["c1"], none)
    )
    assert late[1].get_xlim() == late[5].get_xlim() == whole[1].get_xlim()
    assert [text.get_text() for text in late[1].texts] == ["does not film then"]
    assert not late[5].texts
