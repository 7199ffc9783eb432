"""Scores and counts drawn are the record's."""

import numpy as np

from courtside.figures.take import visibility
from fixtures.cameras import scene
from fixtures.people import walker


def test_the_table_holds_the_records_scores_and_views():
    record = walker.points(n_persons=2)
    views = walker.views(record, scene.ring(3))
    views[1].score[1, 4, 6] = np.nan
    rows = visibility.table(record, views)
    at = rows[(rows.person == "p2") & (rows.joint == record.joints[6])].iloc[4]
    assert at.time_s == record.time_s[4]
    assert np.isnan(at.score_c1)
    assert at.score_c0 == 0.75
    np.testing.assert_array_equal(rows.n_views, record.n_views.ravel())


def test_the_picture_shows_the_fewest_views():
    record = walker.points()
    rows = visibility.table(record, walker.views(record, scene.ring(3)))
    drawing = visibility.draw(rows, walker.SKELETON)
    shown = np.asarray(drawing.axes[1].images[0].get_array())
    np.testing.assert_array_equal(shown, record.n_views[0].T)
