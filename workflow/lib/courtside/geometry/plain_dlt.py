"""Triangulation as the badminton paper does it: every view that sees a point counts, none is left out."""

import numpy as np

from courtside.geometry import triangulation
from courtside.geometry.views import Views


def triangulate_plain(cameras, xy, score, *, sigma_px, min_views=2, min_score=0.0):
    """Triangulate points by a DLT over all views that see them, without weights.

    Parameters
    ----------
    cameras : list of Camera, length C
    xy : (C, N, 2) float
        Keypoints in px, distorted as in the pictures; NaN where unseen.
    score : (C, N) float
        Detector confidence, 0 to 1: chooses views, and weighs none.
    sigma_px : float or (N,) float
        Standard deviation per axis of a keypoint: scales the covariance only.
    min_views : int
        Fewest views of a point, at least 2.
    min_score : float
        Keypoints below it are not used.

    Returns
    -------
    triangulated : courtside.geometry.triangulation.Triangulated
        `accepted` are all views used.

    Notes
    -----
    [Shishido2020, section 2]; Hartley & Zisserman 2004, sec. 12.2. The covariance is that of the point of
    least squares in the pictures, to which a DLT is close where cameras are about equally far.
    """
    triangulation.check(cameras, xy, score, min_views)
    used = np.isfinite(xy).all(axis=-1) & np.isfinite(score) & (score >= min_score) & (score > 0)
    used &= used.sum(axis=0) >= min_views
    views = Views(cameras, xy, used.astype(float))
    xyz = triangulation.triangulate(views.xy, views.weight, views.matrix)
    return triangulation.Triangulated(
        xyz=xyz,
        covariance=triangulation.noise_covariance(
            views, xyz, used, np.broadcast_to(sigma_px, len(xyz))
        ),
        accepted=used & np.isfinite(xyz[:, 0]),
        error_px=triangulation.reprojection_px(cameras, xy, xyz),
    )
