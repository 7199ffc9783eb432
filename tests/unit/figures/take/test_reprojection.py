"""The statistics drawn are numpy's."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from courtside.figures.take import reprojection
from fixtures import drawings
from fixtures.people import walker


def test_the_table_matches_numpys_percentiles():
    record = walker.points(n_persons=2)
    record.reproj_error_px[:, :, 9, 2] = np.nan
    rows = reprojection.table(record).set_index(["joint", "camera"])
    error = record.reproj_error_px[:, :, 7, 1].ravel()
    at = rows.loc[(record.joints[7], "c1")]
    assert (at.n, at.n_accepted) == (40, 38)
    np.testing.assert_allclose([at.median_px, at.mean_px], [np.median(error), error.mean()])
    np.testing.assert_allclose([at.p05_px, at.p95_px], np.percentile(error, [5, 95]))
    used = error[record.accepted[:, :, 7, 1].ravel()]
    np.testing.assert_allclose(at.accepted_median_px, np.median(used))
    never = rows.loc[(record.joints[9], "c2")]
    assert never.n == 0
    assert np.isnan(never.median_px)


def test_every_camera_has_a_panel():
    drawing = reprojection.draw(reprojection.table(walker.points()))
    assert [axis.get_title().split(":")[0] for axis in drawing.axes] == ["c0", "c1", "c2"]


def test_panels_of_eight_cameras_have_room_for_their_words():
    record = walker.points(n_cameras=8)
    record.reproj_error_px[...] *= np.geomspace(0.05, 1, record.reproj_error_px.shape[1])[
        :, np.newaxis, np.newaxis
    ]
    drawing = reprojection.draw(reprojection.table(record))
    assert not drawings.cut(drawing)
    low, high = drawing.axes[0].get_xlim()
    ticks = [axis.get_xticklabels(which="both") for axis in drawing.axes]
    shown = [one for one in itertools.chain(*ticks) if low <= one.get_position()[0] <= high]
    shown = [one for one in [*shown, *(axis.title for axis in drawing.axes)] if one.get_text()]
    boxes = [one.get_window_extent() for one in shown if one.get_visible()]
    assert len(boxes) > 8
    assert not [pair for pair in itertools.combinations(boxes, 2) if pair[0].overlaps(pair[1])]


def test_every_bottom_panel_has_numbers_where_the_last_row_is_not_full():
    drawing = reprojection.draw(reprojection.table(walker.points(n_cameras=5)))
    drawing.draw_without_rendering()
    assert len(drawing.axes) == 5
    named = [bool(axis.get_xlabel()) for axis in drawing.axes]
    numbers = [any(one.get_visible() for one in axis.get_xticklabels()) for axis in drawing.axes]
    assert named == numbers == [False, False, True, True, True]


def test_an_axis_that_ends_just_after_a_power_of_ten_has_a_number_at_each():
    record = walker.points(n_cameras=4)
    spread = np.geomspace(0.1, 130, record.reproj_error_px.shape[1])
    record.reproj_error_px[...] = spread[:, np.newaxis, np.newaxis]
    drawing = reprojection.draw(reprojection.table(record))
    drawing.draw_without_rendering()
    low, high = drawing.axes[0].get_xlim()
    for axis in drawing.axes:
        ticks = axis.get_xticklabels()
        shown = [one for one in ticks if low <= one.get_position()[0] <= high]
        assert [one.get_text() for one in shown] == ["0.1", "1", "10", "100"]
    assert not drawings.cut(drawing)


@pytest.mark.parametrize("scale", [1.0, 0.01])
def test_the_axis_holds_the_medians_however_small_they_are(scale):
    record = walker.points()
    rows = reprojection.table(replace(record, reproj_error_px=scale * record.reproj_error_px))
    low, high = reprojection.draw(rows).axes[0].get_xlim()
    assert low < rows.median_px.min() < rows.median_px.max() < high
    assert scale < 1 or low == reprojection.SMALLEST_PX
