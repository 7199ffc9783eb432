"""A check that each video is of its camera, by features of the hall that two pictures share.

Where cameras are right, a feature seen in two pictures lies near the epipolar line of either one in
the other (Hartley & Zisserman 2004, section 11.4.3). Where cameras stand far apart, most features
that look alike are not the same, too few to estimate a geometry from. But few of the false ones lie
near these lines by chance. So it shows whether the pictures fit the cameras as the session names
them, or far better in another order. Nobody has to be detected for it.

A camera that is wrong otherwise is not named: too many faults of it would explain the same.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, permutations

import cv2
import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.geometry import epipolar, rotations
from courtside.geometry.camera import Camera, turned

SIDE_PX = 1280  # longer side of the pictures that features are taken from
MOST_FEATURES = 4000  # of a picture: all features of two pictures are compared
CONTRAST = 0.02  # least of a feature; half of OpenCV's, halls have plain walls
RATIO = 0.85  # ASSUME: between the distances of the best and the next best
NEAR = 2e-3  # ASSUME: of the picture's longer side, from an epipolar line
# Cameras turned at random show how many matches are near a line by chance: few in one pair of
# pictures, many in another with repeated patterns. A pair has at least the share `CHANCE`.
TURNS, TURNED_DEG, TYPICAL, CHANCE, SEED = 40, (2.0, 10.0), 0.9, 0.012, 0
# ASSUME: how much more likely the pictures must be if cameras are exchanged, as a logarithm, and
# the largest share of it that the cameras as they are may have. Exchanged cameras of virtual halls
# gain 22 and more where their pictures have enough in common (docs/measured/ways_to_calibrate.md).
SURE, LEFT = 15.0, 0.5
FEW = 6  # cameras: 720 orders
APART = 5.0  # ASSUME: of two exchanges, the worse by less than this is possible, too
ROWS = ("camera", "other", "n", "near", "near_after")

Pair = tuple[int, int]
Matches = Mapping[Pair, tuple[NDArray, NDArray]]  # px (M, 2) in both pictures, by their indices


@dataclass(frozen=True)
class Verdict:
    """Of which camera each picture is, and what each pair of pictures says."""

    names: dict[str, str]  # the camera that a picture is of, by the camera that it is given for
    # Exchanges that explain the pictures as well: in a regular ring of cameras, one exchange looks
    # like another.
    also: list[tuple[str, str]]
    # Cameras whose pictures do not show it if they are exchanged among them: each shares too little
    # of the hall with the others. An exchange of one of them with another camera shows.
    unjudged: list[str]
    table: pd.DataFrame  # of each pair, with the columns `ROWS`

    @property
    def warnings(self) -> list[str]:
        """One for the cameras whose pictures are exchanged among them."""
        wrong = {name: of for name, of in self.names.items() if of != name}
        if not wrong:
            return []
        pairs = [f"{one} and {of}" for one, of in wrong.items() if wrong[of] == one and one < of]
        if 2 * len(pairs) == len(wrong):
            either = "".join(f", or of {one} and {other}" for one, other in self.also)
            what = f"the videos of {', and of '.join(pairs)}{either} are exchanged"
        else:
            what = ", ".join(f"the video given for {name} is of {of}" for name, of in wrong.items())
        n, near, mended = (int(self.table[name].sum()) for name in ROWS[2:])
        return [
            f"{what}; correct the session's file, or the names in the calibration: of {n} features "
            f"of the hall that look alike in two pictures, {near} are where the calibration "
            f"expects them, {mended} after that"
        ]

    @property
    def remarks(self) -> list[str]:
        """One for the cameras that could not be judged, with the reason."""
        if not self.unjudged:
            return []
        some = self.table[self.table[["camera", "other"]].isin(self.unjudged).any(axis=1)]
        return [
            f"whether the videos of {' and '.join(self.unjudged)} are exchanged could not be "
            "judged: their pictures share too little of the hall with others; of "
            f"{some['n'].sum()} features that look alike there, {some['near_after'].sum()} are "
            "where the calibration expects them, hardly more than by chance"
        ]


def match(pictures: Sequence[NDArray]) -> Matches:
    """Match features of grey pictures (H, W) of the same hall, each with each other one.

    SIFT (Lowe 2004), compared by Hellinger distances (Arandjelovic & Zisserman 2012); both must be
    the best of each other.
    """
    found = [_features(picture) for picture in pictures]
    pairs = combinations(range(len(pictures)), 2)
    return {(one, other): _alike(found[one], found[other]) for one, other in pairs}


def judge(cameras: Sequence[Camera], matches: Matches) -> Verdict:
    """Find of which camera each picture is.

    Columns `near` and `near_after` of the table: the matches near epipolar lines of the cameras as
    they are, and of those that the pictures are of.
    """
    search = _Search(cameras, matches)
    order, also = search.best()
    before, after = near_lines(cameras, matches), near_lines([cameras[k] for k in order], matches)
    rows = [
        (cameras[pair[0]].name, cameras[pair[1]].name, len(xy), before[pair], after[pair])
        for pair, (xy, _) in matches.items()
    ]
    names = [camera.name for camera in cameras]
    of = dict(zip(names, (names[k] for k in order), strict=True))
    either = [(names[one], names[other]) for one, other in also]
    weak = [name for at, name in enumerate(names) if search.evidence(order, {at}) < SURE]
    return Verdict(of, either, weak if len(weak) > 1 else [], pd.DataFrame(rows, columns=ROWS))


def near_lines(
    cameras: Sequence[Camera] | Mapping[int, Camera], matches: Matches
) -> dict[Pair, int]:
    """Return how many matches of each pair of pictures are near each other's epipolar lines."""
    counts = {}
    for at, both in matches.items():
        one, other = (cameras[k] for k in at)
        straight = [epipolar.straight_px(*each) for each in zip((one, other), both, strict=True)]
        away_px = epipolar.distance_px(epipolar.fundamental(one, other), *straight)
        counts[at] = int((np.abs(away_px) < NEAR * max(one.size)).sum())
    return counts


def by_chance(cameras: Sequence[Camera], matches: Matches) -> dict[Pair, float]:
    """Return the share of each pair's matches that is near the lines of wrong cameras."""
    rng, counts = np.random.default_rng(SEED), []
    for _ in range(TURNS):
        axes = rotations.unit(rng.normal(size=(len(cameras), 3)))
        turns = axes * np.deg2rad(rng.uniform(*TURNED_DEG, size=(len(cameras), 1)))
        wrong = [turned(camera, turn) for camera, turn in zip(cameras, turns, strict=True)]
        counts.append(near_lines(wrong, matches))
    return {
        pair: max(
            float(np.quantile([one[pair] for one in counts], TYPICAL)) / max(len(xy), 1), CHANCE
        )
        for pair, (xy, _) in matches.items()
    }


class _Search:
    """The search for the order of cameras that makes the pictures most likely."""

    def __init__(self, cameras: Sequence[Camera], matches: Matches) -> None:
        self.cameras, self.matches = cameras, matches
        self.chance = by_chance(cameras, matches)
        self.known: dict[tuple[Pair, Pair], float] = {}

    def best(self) -> tuple[list[int], list[Pair]]:
        """Return the camera of each picture, and single exchanges that are as likely.

        Cameras whose pictures are exchanged among them stay so if together they gain by far.
        """
        own = list(range(len(self.cameras)))
        order = self._most_likely(own)
        for circle in _circles(order):
            back = [k if k in circle else order[k] for k in own]
            before, after = self.evidence(back, circle), self.evidence(order, circle)
            if after - before < SURE or before > LEFT * after:
                order = back
        if sum(k != of for k, of in enumerate(order)) != 2:
            return order, []
        most = self.evidence(order)
        alike = [o for o in _exchanges(own) if o != order and most - self.evidence(o) < APART]
        pairs = [[k for k in own if other[k] != k] for other in alike]
        return order, [(one, other) for one, other in pairs]

    def _most_likely(self, own: list[int]) -> list[int]:
        """Try all orders of a few cameras; of more, exchange two as long as this gains."""
        if len(own) <= FEW:
            return max((list(order) for order in permutations(own)), key=self.evidence)
        order, nearer = own, max(_exchanges(own), key=self.evidence)
        while self.evidence(nearer) > self.evidence(order):
            order, nearer = nearer, max(_exchanges(nearer), key=self.evidence)
        return order

    def evidence(self, order: Sequence[int], some: Collection[int] = ()) -> float:
        """Return how likely the pictures are against chance, as a logarithm.

        `order` are the cameras that they are of, `some` the pictures that count; without, all.
        """
        pairs = [pair for pair in self.matches if not some or set(pair) & set(some)]
        return sum(self._of_pair(pair, (order[pair[0]], order[pair[1]])) for pair in pairs)

    def _of_pair(self, pair: Pair, of: Pair) -> float:
        if (pair, of) not in self.known:
            both = self.matches[pair]
            cameras = {at: self.cameras[k] for at, k in zip(pair, of, strict=True)}
            near = near_lines(cameras, {pair: both})[pair]
            self.known[pair, of] = _against_chance(near, len(both[0]), self.chance[pair])
        return self.known[pair, of]


def _exchanges(order: list[int]) -> Iterator[list[int]]:
    for one, other in combinations(range(len(order)), 2):
        changed = list(order)
        changed[one], changed[other] = order[other], order[one]
        yield changed


def _circles(order: Sequence[int]) -> list[set[int]]:
    """Return the sets of pictures that are exchanged among them."""
    circles: list[set[int]] = []
    for at, of in enumerate(order):
        if of != at and not any(at in circle for circle in circles):
            circle = {at}
            while of not in circle:
                circle.add(of)
                of = order[of]
            circles.append(circle)
    return circles


def _against_chance(near: int, n: int, chance: float) -> float:
    """Return how likely so many of `n` matches near lines are, against chance, as a logarithm."""
    if near <= chance * n:
        return 0.0
    far, share = n - near, near / n
    others = far * np.log((1 - share) / (1 - chance)) if far else 0.0
    return float(near * np.log(share / chance) + others)


def _features(picture: NDArray) -> tuple[NDArray, NDArray]:
    """Return px (N, 2) of a picture's features and their descriptors (N, 128)."""
    scale = min(1.0, SIDE_PX / max(picture.shape))
    smaller = cv2.resize(picture, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    sift = cv2.SIFT_create(MOST_FEATURES, contrastThreshold=CONTRAST)
    points, descriptors = sift.detectAndCompute(smaller, None)
    if not points:
        return np.zeros((0, 2)), np.zeros((0, 128), np.float32)
    descriptors = np.sqrt(descriptors / descriptors.sum(axis=1, keepdims=True))
    return (np.array([point.pt for point in points]) + 0.5) / scale - 0.5, descriptors


def _alike(one: tuple[NDArray, NDArray], other: tuple[NDArray, NDArray]) -> tuple[NDArray, NDArray]:
    """Return px (M, 2) of the features of two pictures that look alike."""
    if min(len(one[0]), len(other[0])) < 2:
        return np.zeros((0, 2)), np.zeros((0, 2))
    matcher = cv2.BFMatcher()
    back = {each.queryIdx: each.trainIdx for each in matcher.match(other[1], one[1])}
    pairs = [
        (best.queryIdx, best.trainIdx)
        for best, second in matcher.knnMatch(one[1], other[1], k=2)
        if best.distance < RATIO * second.distance and back[best.trainIdx] == best.queryIdx
    ]
    at = np.array(pairs, int).reshape(-1, 2)
    return one[0][at[:, 0]], other[0][at[:, 1]]
