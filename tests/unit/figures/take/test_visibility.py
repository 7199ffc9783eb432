"""Scores and counts drawn are the record's."""

import tracemalloc
from dataclasses import replace

import numpy as np

from courtside.figures.take import visibility
from fixtures.cameras import scene
from fixtures.people import takes_made, walker


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


def test_a_camera_has_scores_only_while_it_films():
    record, (_, late, _) = takes_made.take()  # `late` has another clock
    found = visibility.scores(takes_made.stopped(late, 8), record.time_s)
    assert (found[:, :8] == 0.75).all()
    assert np.isnan(found[:, 9:]).all()  # the frame between is one interval away
    rows = visibility.table(record, {"c1": found})
    (line,) = visibility.draw(rows, walker.SKELETON).axes[0].lines
    assert np.isfinite(line.get_ydata()).sum() in (8, 9)


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


def test_lines_of_many_cameras_differ():
    record = walker.points()
    drawing = visibility.draw(visibility.table(record, scores(record, 12)), walker.SKELETON)
    looks = {(line.get_color(), line.get_linestyle()) for line in drawing.axes[0].lines}
    assert len(looks) == 12


def test_the_least_views_of_several_persons_are_named_so():
    record = walker.points(n_persons=2)
    record.n_views[0, 2], record.n_views[1, 6] = 1, 0
    rows = visibility.table(record, scores(record))
    (_, lower, *_) = visibility.draw(rows, walker.SKELETON).axes
    shown = np.asarray(lower.images[0].get_array())
    np.testing.assert_array_equal(shown, record.n_views.min(axis=0).T)
    assert "least of all persons" in lower.get_title()


def test_a_take_of_minutes_has_means_of_windows():
    record = walker.points(n_frames=4000, n_persons=2)
    record = replace(record, time_s=np.arange(4000) / 10)
    record.n_views[:] = np.arange(4000)[None, :, None] // 100 % 2 + 1  # 10 s each
    given = {"c0": np.full(record.n_views.shape, 0.5)}
    given["c0"][1, 200:275, 6] = np.nan
    given["c0"][1, 300:400, 6] = np.nan
    rows = visibility.table(record, given)
    assert len(rows) == 2 * 40 * len(record.joints)
    own = rows[(rows.person == "p2") & (rows.joint == record.joints[6])]
    assert own.time_s.tolist() == [5 + 10 * at for at in range(40)]
    assert own.n_views.tolist() == [1, 2] * 20
    assert own.score_c0.tolist()[2] == 0.5 and np.isnan(own.score_c0.tolist()[3])
    (_, lower, *_) = visibility.draw(rows, walker.SKELETON).axes
    assert lower.get_xlabel() == "time (s): means of each 10 s"
