"""The statistics drawn are numpy's."""

import numpy as np

from courtside.figures.take import reprojection
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
