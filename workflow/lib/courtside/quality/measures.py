"""Quality measures of each camera and each person of a take, to be compared with limits."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from courtside.quality import seen as views
from courtside.quality.seen import Seen
from courtside.records.keypoints import skeleton as limbs
from courtside.statistics.normal_errors import MEDIAN_TO_SIGMA


def of_camera(seen: Seen, camera: int) -> dict[str, float]:
    """Return the quality measures of a camera; NaN if unknown.

    `found`: of the persons who should be in its picture, the share that the network found, whoever
    they are; `followed`: the share that is followed as that person; `accepted`: share of its
    keypoints of limbs that triangulation used; `reprojection`: median distance of the middles of
    both sides' keypoints from where the other cameras place them, heights of the person in that
    picture (where these place nobody: of keypoints from where all place the joints).
    """
    expected = seen.expected(camera)
    wanted = expected.sum(axis=0)
    there = views.shown(seen.rows[camera][:, seen.at]).sum(axis=0)
    followed = seen.followed[camera][:, seen.at]
    error_px = seen.points.reproj_error_px[..., camera]
    known = np.isfinite(error_px)
    errors = np.linalg.norm(seen.errors(camera, seen.xy[camera][:, seen.at]), axis=-1)
    if not np.isfinite(errors).any():
        errors = error_px / seen.height_px[camera][..., None]
    return {
        "found": _share(np.minimum(there, wanted).sum(), wanted.sum()),
        "followed": _share((followed & expected).sum(), wanted.sum()),
        "accepted": _share(seen.points.accepted[..., camera][known].sum(), known.sum()),
        "reprojection": _median(errors),
    }


def of_person(seen: Seen, person: int) -> dict[str, float]:
    """Return the quality measures of a person over all cameras; NaN if unknown.

    `views_2`, `views_3`: share of the limb joints that rest on two and three cameras or more, while
    the person is there;
    `accepted` and `reprojection` as of a camera, from the joints as all cameras place them;
    `limb_length`: how far the length of a limb varies, as a share of it (robust standard deviation,
    median over the limbs).
    """
    points = seen.points
    n_views, error_px = points.n_views[person], points.reproj_error_px[person]
    placed, known = np.isfinite(points.xyz[person, ..., 0]), np.isfinite(error_px)
    present = seen.present[person]
    heights = np.moveaxis(seen.height_px[:, person], 0, -1)[:, None]
    return {
        "views_2": float((placed & (n_views >= 2))[present].mean()),
        "views_3": float((placed & (n_views >= 3))[present].mean()),
        "accepted": _share(points.accepted[person][known].sum(), known.sum()),
        "reprojection": _median(error_px / heights),
        "limb_length": limb_variation(points.xyz[person], [str(j) for j in points.joints]),
    }


def limb_variation(xyz: NDArray, joints: list[str]) -> float:
    """Return the variation of limb lengths of joints (T, J, 3), as a share; NaN if unknown."""
    found = []
    for side in ("left_", "right_"):
        for start, stop in (pair for chain in limbs.CHAINS for pair in pairwise(chain)):
            ends = [joints.index(side + name) for name in (start, stop) if side + name in joints]
            if len(ends) == 2:
                length = np.linalg.norm(xyz[:, ends[0]] - xyz[:, ends[1]], axis=-1)
                found.append(
                    MEDIAN_TO_SIGMA * _median(np.abs(length - _median(length))) / _median(length)
                )
    return _median(np.array(found))


def _share(part: float, whole: float) -> float:
    return float(part / whole) if whole else float("nan")


def _median(values: NDArray) -> float:
    values = values[np.isfinite(values)]
    return float(np.median(values)) if len(values) else float("nan")
