"""Scores and counts drawn are the record's."""

import tracemalloc
from dataclasses import replace

import numpy as np

from courtside.figures.take import visibility
from fixtures.cameras import scene
from fixtures.people import walker


def scores(record, cameras=3):
    return {view.camera: view.score for view in walker.views(record, scene.ring(cameras))}


def test_the_table_holds_the_records_scores_and_views():
    record = walker.points(n_persons=2)
    given = scores(record)
    given["c1"][1, 4, 6] = np.nan
    rows = visibility.table(record, given)
    at = rows[(rows.person == "p2") & (rows.joint == record.joints[6])].iloc[4]
    assert at.time_s == record.time_s[4]
    assert np.isnan(at.score_c1)
    assert at.score_c0 == 0.75
    np.testing.assert_array_equal(rows.n_views, record.n_views.ravel())


def test_a_long_take_needs_memory_for_its_rows_alone():
    record = walker.points(n_frames=4000)
    record = replace(record, joints=record.joints[:1], n_views=record.n_views[..., :1])
    score = scores(walker.points(n_frames=4000), 1)["c0"][..., :1]
    tracemalloc.start()
    rows = visibility.table(record, {"c0": score})
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(rows) == 4000
    assert peak < 10e6  # bytes; a matrix of all pairs of frames has 128 million


def test_the_picture_shows_the_fewest_views():
    record = walker.points()
    rows = visibility.table(record, scores(record))
    drawing = visibility.draw(rows, walker.SKELETON)
    shown = np.asarray(drawing.axes[1].images[0].get_array())
    np.testing.assert_array_equal(shown, record.n_views[0].T)


def test_the_least_views_of_several_persons_are_named_so():
    record = walker.points(n_persons=2)
    record.n_views[0, 2], record.n_views[1, 6] = 1, 0
    rows = visibility.table(record, scores(record))
    (_, lower, *_) = visibility.draw(rows, walker.SKELETON).axes
    shown = np.asarray(lower.images[0].get_array())
    np.testing.assert_array_equal(shown, record.n_views.min(axis=0).T)
    assert "least of all persons" in lower.get_title()
