"""The similarity from reconstructed court points to the court that most of them agree on."""

import math
from itertools import combinations, islice

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.geometry import similarity
from courtside.geometry.similarity import Sim3
from courtside.study.errors import InputError

MOST_SUBSETS = 2000  # ASSUME: all subsets of up to 23 points, and an even choice of more
# Of the length of a normal vector in three dimensions with standard deviation 1 per axis.
MEDIAN = 1.538
QUANTILE_99 = 3.368
MIRRORED_RATIO = 4.0  # ASSUME: points are mirrored if their mirror image fits so much better
MAX_ROUNDS = 20  # ASSUME: the inliers settle in a few


def fit(x_in_a: ArrayLike, x_in_b: ArrayLike, sigma: ArrayLike) -> tuple[Sim3, NDArray]:
    """Fit `b_from_a` to most of the same points (P, 3) in both frames, NaN where missing in one.

    Also return the inliers (P,) bool: points within the 99 % limit. `sigma`, one or (P,), is the
    standard deviation of a point per axis, in units of b. If the points scatter more, all sigmas
    are scaled up by one factor.

    Least median of squares (Rousseeuw & Leroy 1987) over all subsets of three points: no random
    numbers. Then weighted least squares on the inliers until they stay the same. Mirrored points
    that all lie in one plane fit a rotation as well: only the cameras' positions tell them apart,
    which are not known here. Raises `InputError` if the points are fewer than three, collinear, or
    mirrored.
    """
    x_in_a, x_in_b = np.asarray(x_in_a, float), np.asarray(x_in_b, float)
    sigma = np.broadcast_to(np.asarray(sigma, float), len(x_in_a))
    finite = np.isfinite(x_in_a).all(axis=1) & np.isfinite(x_in_b).all(axis=1)
    known = np.flatnonzero(finite)
    if similarity.is_collinear(x_in_a[known]) or similarity.is_collinear(x_in_b[known]):
        line = ", all on one line" if len(known) > 2 else ""
        raise _too_few(f"{len(known)} that two cameras see{line}")
    places = x_in_a[known], x_in_b[known], sigma[known]
    b_from_a, agree = _select(*places)
    if not agree.any():
        raise _too_few(f"{len(known)} of which those that agree are on one line")
    _refuse_mirrored(b_from_a, *places)
    accepted = np.zeros(len(x_in_a), dtype=bool)
    accepted[known[agree]] = True
    return b_from_a, accepted


def _too_few(found: str) -> InputError:
    return InputError(
        f"court points: expected three or more that are not on one line, found {found}; click more "
        "points, in two cameras or more each"
    )


def _refuse_mirrored(b_from_a: Sim3, x_in_a: NDArray, x_in_b: NDArray, sigma: NDArray) -> None:
    if len(x_in_a) < 4:
        return
    flipped = x_in_a * [1, 1, -1]
    mirrored, agree = _select(flipped, x_in_b, sigma)
    as_found = _distance(b_from_a, x_in_a, x_in_b, sigma)[agree]
    as_mirrored = _distance(mirrored, flipped, x_in_b, sigma)[agree]
    if np.sqrt(np.mean(as_found**2)) > MIRRORED_RATIO * max(1, np.sqrt(np.mean(as_mirrored**2))):
        raise InputError(
            "court points: expected a right-handed world (x along the short side, y along the long "
            "side, z up), found the points of its mirror image; exchange the names of the left and "
            "right points in all cameras, or undo the flip of the videos"
        )


def _select(x_in_a: NDArray, x_in_b: NDArray, sigma: NDArray) -> tuple[Sim3, NDArray]:
    """Return the similarity that most points agree on, and the inliers (P,) bool.

    There are no inliers where the points that agree are collinear in either frame.
    """
    n_points = len(x_in_a)
    subsets = triples(n_points, MOST_SUBSETS)
    weight = 1 / sigma**2
    scale, rotation, shift = similarity.fit_many(x_in_a[subsets], x_in_b[subsets], weight[subsets])
    placed = scale[:, None, None] * (x_in_a @ rotation.transpose(0, 2, 1)) + shift[:, None]
    distance = np.sort(np.linalg.norm(placed - x_in_b, axis=-1) / sigma, axis=1)
    quorum = (n_points + 4) // 2 - 1
    # A rotation about the line of three collinear points is arbitrary.
    usable = np.isfinite(distance[:, quorum])
    for xyz in (x_in_a, x_in_b):
        usable &= similarity.flatness(xyz[subsets])[:, 1] >= similarity.LINE
    best = np.argmin(np.where(usable, distance[:, quorum], np.inf))
    fitted = Sim3(float(scale[best]), rotation[best], shift[best])
    found = _distance(fitted, x_in_a, x_in_b, sigma)
    # Three points fit themselves, which makes the scatter look small: start with a wide limit.
    now = found <= 2 * QUANTILE_99 * max(1, distance[best, quorum] / MEDIAN)
    agree = np.zeros(n_points, dtype=bool)
    for _ in range(MAX_ROUNDS):
        if (
            (now == agree).all()
            or similarity.is_collinear(x_in_a[now])
            or similarity.is_collinear(x_in_b[now])
        ):
            break
        agree = now
        fitted = similarity.umeyama(x_in_a[agree], x_in_b[agree], weight[agree])
        found = _distance(fitted, x_in_a, x_in_b, sigma)
        now = found <= QUANTILE_99 * max(1, np.sort(found)[quorum] / MEDIAN)
    return fitted, agree


def triples(n: int, most: int) -> NDArray:
    """Return (N, 3) index: all triples of n points, or about `most` of them, evenly chosen."""
    step = -(-math.comb(n, 3) // most)
    return np.array(list(islice(combinations(range(n), 3), 0, None, step)))


def _distance(b_from_a: Sim3, x_in_a: NDArray, x_in_b: NDArray, sigma: NDArray) -> NDArray:
    return np.linalg.norm(b_from_a.points(x_in_a) - x_in_b, axis=1) / sigma
