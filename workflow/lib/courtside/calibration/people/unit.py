"""The unit of length of cameras that people alone place: stated heights, and known lengths.

Heights are those of persons whose bodies are found; whose is whose is found with the unit. A known
length lies between two points at rest that are clicked in two cameras or more.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.calibration import point_covariance
from courtside.calibration.bundle import selection
from courtside.calibration.court.joint_adjustment import click_sigma
from courtside.geometry.camera import Camera
from courtside.geometry.triangulation import triangulate_all
from courtside.records.keypoints import skeleton
from courtside.study.errors import InputError

# ASSUME: leg and trunk as BlazePose heavy sees them, share of the height: 0.722 +- 0.006 of the
# four persons of players-dev; BlazePose full sees 0.715. Anatomical ones are longer (0.78, Winter
# 2009, fig. 4.1).
OF_HEIGHT = 0.722
OF_HEIGHT_SIGMA = 0.01  # ASSUME: between persons, share of the length
NETWORK_SIGMA = 0.01  # ASSUME: what is alike for all persons: networks differ by as much
STATED_SIGMA_M = 0.01  # of a height to the centimetre, in shoes or not
MEASURED_SIGMA = 0.01  # ASSUME: of the length of one track, share
# ASSUME: errors that a network makes all the time bend cameras: with exact clicks, a line of 6.1 m
# was 0.5 to 0.9 % off in eight calibrations from players-dev.
BEND_SIGMA = 0.008  # of a known length, share
KNOWN_SIGMA_M = 0.003  # ASSUME: of a known length: ends of painted lines, of rackets, of staffs
LEAST_FRAMES = 20  # ASSUME: that the length of a body needs
SURE = 2.0  # standard deviations
NOBODY = 3.0  # standard deviations: cost of a track of nobody, and of a stated person not seen
HEIGHTS = "stated heights"
MOST_WAYS = 4096  # of giving tracks to persons that are tried in one take; the longest tracks count
MOST_PERSONS = 5  # of a take whose tracks are tried; of more, the tallest is taken for the longest
ROUNDS = 4  # of whose tracks they are and the unit, in turn


@dataclass(frozen=True)
class Body:
    """The body that one track shows."""

    take: int
    length: float  # of leg and trunk, in any unit; NaN where too little is seen
    frames: int
    first: float  # and last time that it is seen, in the take
    last: float
    tracklets: frozenset[tuple[int, int]] = frozenset()  # camera and row of those that it joins


@dataclass(frozen=True)
class Unit:
    """Metres per unit of length."""

    metres: float
    sigma: float  # standard deviation, share
    by: str  # what tells it
    doubts: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class KnownLength:
    """A known length between two points at rest."""

    name: str
    length_m: float
    xy: NDArray  # (C, 2, 2): px of both ends in each camera, NaN where not clicked
    click_sigma_px: float  # of a click, per axis, in a picture of 3840 px width
    on_floor: bool = False  # whether both ends lie on the floor


def length(xyz: NDArray) -> float:
    """Return the length of leg and trunk of a person by joints (T, J, 3), NaN where unknown.

    The sum of the medians of its parts over frames: no posture shortens it. Joints are those of
    `skeleton.JOINTS`.
    """
    place = {name: xyz[:, at] for at, name in enumerate(skeleton.JOINTS)}
    hips, shoulders = (middle(place, part) for part in ("hip", "shoulder"))
    pairs = [[(place[f"{side}_{a}"], place[f"{side}_{b}"]) for side in ("left", "right")]
             for a, b in (("hip", "knee"), ("knee", "ankle"))]  # fmt: skip
    total = 0.0
    for part in [*pairs, [(hips, shoulders)]]:
        apart = np.concatenate([np.linalg.norm(a - b, axis=1) for a, b in part])
        known = apart[np.isfinite(apart)]
        total += float(np.median(known)) if len(known) >= LEAST_FRAMES else np.nan
    return total


def middle(place: dict[str, NDArray], part: str) -> NDArray:
    """Return the middle of the left and the right joints of a part of the body."""
    return (place[f"left_{part}"] + place[f"right_{part}"]) / 2


def of_clicks(
    stated: Sequence[Mapping[str, Any]],
    points: Sequence[str],
    xy: NDArray,
    *,
    click_sigma_px: float,
    click_bias_px: float,
) -> list[KnownLength]:
    """Return the known lengths of a session between clicked `points` (P,), `xy` (C, P, 2) px.

    Each has `points`, `length_m` and perhaps `on_floor`. Scatter and bias of a click are in a
    picture of 3840 px width. Raises `InputError` for a point that is not clicked.
    """
    found = []
    for one in stated:
        name = " to ".join(one["points"])
        if missing := [end for end in one["points"] if end not in points]:
            raise InputError(
                f"known length {name}: expected clicks of both points in `static_points`, found "
                f"none of {missing[0]} among {list(points)}; click it in two cameras or more"
            )
        ends = xy[:, [list(points).index(end) for end in one["points"]]]
        sigma_px = float(np.hypot(click_sigma_px, click_bias_px))
        on_floor = one.get("on_floor", False)
        found.append(KnownLength(name, one["length_m"], ends, sigma_px, on_floor))
    return found


def find(
    cameras: Sequence[Camera],
    bodies: Sequence[Body],
    heights_m: Sequence[Sequence[float | None]],
    known: Sequence[KnownLength] = (),
    shape: NDArray | None = None,
) -> Unit:
    """Return the unit by stated heights and known lengths, each as far as it is certain.

    `shape` (K, K) is the covariance of the cameras' columns, their scale apart. Heights may be
    missing where a length is known. That they contradict each other is a doubt.
    """
    each = [by_length(cameras, one, shape) for one in known]
    if not each or any(all(stated) and stated for stated in heights_m):
        each.append(by_heights(bodies, heights_m))
    if len(each) == 1:
        return each[0]
    metres, sigma = (np.array([getattr(one, key) for one in each]) for key in ("metres", "sigma"))
    weight = sigma**-2 / (sigma**-2).sum()
    unit = float(np.exp(weight @ np.log(metres)))
    apart = np.log(metres / unit)
    doubts = [
        f"{one.by}: all lengths would be {100 * np.expm1(off):+.1f} % by it alone, expected "
        f"{SURE * 100 * one.sigma:.1f} % at most; check it against {each[int(weight.argmax())].by}"
        for one, off in zip(each, apart, strict=True)
        if abs(off) > SURE * one.sigma
    ]
    by = ", ".join(one.by for one in each)
    return Unit(unit, float((sigma**-2).sum() ** -0.5), by, tuple(doubts))


def by_length(cameras: Sequence[Camera], known: KnownLength, shape: NDArray | None = None) -> Unit:
    """Return the unit by one known length; arguments are as for `find`.

    Raises `InputError` where fewer than two cameras see one of the ends.
    """
    ends = triangulate_all(cameras, known.xy)
    along = ends[1] - ends[0]
    own = float(np.linalg.norm(along))
    if not own > 0:
        raise InputError(
            f"known length {known.name}: expected two ends, each clicked in two cameras or more in "
            "front of them, found none that these cameras place; check its clicks"
        )
    n_clicks = known.xy.size
    steps = np.zeros((n_clicks, *known.xy.shape))
    sigma_px = [click_sigma(known.click_sigma_px, camera.size) for camera in cameras]
    np.fill_diagonal(steps.reshape(n_clicks, -1), np.repeat(sigma_px, known.xy[0].size))
    moved = (known.xy + steps).transpose(1, 0, 2, 3).reshape(len(cameras), -1, 2)
    moved_ends = triangulate_all(cameras, moved).reshape(n_clicks, 2, 3)
    variance = ((np.linalg.norm(moved_ends[:, 1] - moved_ends[:, 0], axis=1) - own) ** 2).sum()
    if shape is not None:
        one, other = point_covariance.sensitivity(selection.of_cameras(cameras), ends)
        by_column = along / own @ (other - one)
        variance += by_column @ shape @ by_column
    shares = [np.sqrt(variance) / own, KNOWN_SIGMA_M / known.length_m, BEND_SIGMA]
    sigma = float(np.linalg.norm(shares))
    return Unit(known.length_m / own, sigma, known.name)


def by_heights(bodies: Sequence[Body], heights_m: Sequence[Sequence[float | None]]) -> Unit:
    """Return the unit by the stated heights of each take's persons.

    Whose height is whose is found with the unit: the way to give tracks to persons in which all
    bodies agree best. Tracks seen at one time are different persons, unless they share a tracklet:
    then a camera exchanged two people. A track may be of nobody, and a person unseen. A take counts
    if all its heights are stated and it has as many tracks. Where another way agrees about as well
    and gives another unit, this is a doubt, and so are heights that contradict each other. Raises
    `InputError` where no take counts.
    """
    takes = [
        ways
        for take, stated in enumerate(heights_m)
        if (ways := _ways([one for one in bodies if one.take == take], stated)) is not None
    ]
    if not takes:
        raise InputError(
            "people: expected `height_m` of every subject of a take whose legs and trunk are seen, "
            f"found heights {[list(one) for one in heights_m]} of "
            f"{[sum(one.take == take for one in bodies) for take in range(len(heights_m))]} "
            "persons; state them: nothing else tells the unit of length"
        )
    starts = np.unique(np.concatenate([ways.ratio().ravel() for ways in takes]).round(4))
    found = [_settled(takes, unit) for unit in starts[np.isfinite(starts)]]
    cost, unit, ratios = min(found, key=lambda one: one[0])
    persons = sum(max(list(one).count(height) for one in heights_m) for height in ratios)
    of_height = np.hypot(OF_HEIGHT_SIGMA, STATED_SIGMA_M / min(ratios))
    sigma = float(np.hypot(of_height / np.sqrt(persons), NETWORK_SIGMA))
    rivals = [np.expm1(one[1] - unit) for one in found if one[0] < cost + SURE**2]
    doubts = [*_rivals(rivals, sigma), *_disagreeing(ratios, SURE * np.sqrt(2) * of_height)]
    if persons == 1:
        doubts.append("one person's height alone tells the unit; a second person makes it surer")
    return Unit(float(np.exp(unit)), sigma, HEIGHTS, tuple(doubts))


@dataclass(frozen=True, eq=False)
class _Ways:
    """All W ways to give the B tracks of a take to its persons."""

    height_m: NDArray  # (W, B): of the person of each track; NaN for nobody
    length: NDArray  # (B,)
    weight: NDArray  # (B,): share of the frames
    n_unseen: NDArray  # (W,): stated persons without a track

    def ratio(self) -> NDArray:
        """Return the logarithm (W, B) of metres per unit by each track."""
        return np.log(OF_HEIGHT * self.height_m / self.length)

    def best(self, unit: float) -> tuple[float, NDArray, NDArray]:
        """Return of the way that agrees best its cost, in variances, heights and ratios (B,)."""
        own = np.hypot(OF_HEIGHT_SIGMA, STATED_SIGMA_M / self.height_m)
        off = (self.ratio() - unit) / np.hypot(own, MEASURED_SIGMA)
        cost = np.nan_to_num(off**2, nan=NOBODY**2) @ self.weight + NOBODY**2 * self.n_unseen
        at = int(cost.argmin())
        return float(cost[at]), self.height_m[at], self.ratio()[at]


def _ways(bodies: Sequence[Body], stated: Sequence[float | None]) -> _Ways | None:
    """Return the ways to give the tracks of a take to persons; None if it does not tell."""
    heights = np.array([one or np.nan for one in stated])
    known = sorted((one for one in bodies if np.isfinite(one.length)), key=lambda one: -one.frames)
    if not len(heights) or not np.isfinite(heights).all() or len(known) < len(heights):
        return None
    most = int(np.log(MOST_WAYS) / np.log(len(heights) + 1))
    known = known[: max(len(heights), most)]
    length = np.array([one.length for one in known])
    weight = np.array([one.frames for one in known], dtype=float)
    weight *= len(heights) / weight[: len(heights)].sum()
    if len(heights) > MOST_PERSONS:
        order = np.argsort(np.argsort(length))
        return _Ways(np.sort(heights)[order][None], length, weight, np.zeros(1))
    every = np.array(list(product(range(len(heights) + 1), repeat=len(known))))
    fine = (every < len(heights)).any(axis=1)
    for (a, one), (b, other) in combinations(enumerate(known), 2):
        together = min(one.last, other.last) > max(one.first, other.first)
        if together and not one.tracklets & other.tracklets:
            fine &= (every[:, a] != every[:, b]) | (every[:, a] == len(heights))
    seen = np.sum([(every[fine] == who).any(axis=1) for who in range(len(heights))], axis=0)
    whose = np.append(heights, np.nan)[every[fine]]
    return _Ways(whose, length, weight, len(heights) - seen) if len(whose) else None


def _settled(takes: Sequence[_Ways], unit: float) -> tuple[float, float, dict[float, float]]:
    """Return the cost, the logarithm of the unit, and of it by height, from a first unit."""
    for _ in range(ROUNDS):
        best = [ways.best(unit) for ways in takes]
        height_m, ratio = (np.concatenate(part) for part in list(zip(*best, strict=True))[1:])
        weight = np.concatenate([ways.weight for ways in takes])
        ratios = {}
        for one in np.unique(height_m[np.isfinite(height_m)]):
            own = height_m == one
            ratios[float(one)] = float(np.average(ratio[own], weights=weight[own]))
        unit = float(np.mean(list(ratios.values())))
    return sum(ways.best(unit)[0] for ways in takes), unit, ratios


def _rivals(rivals: Sequence[float], sigma: float) -> Iterator[str]:
    """Yield what other ways to give heights to persons, which agree as well, would change."""
    if (other := max(rivals, key=abs, default=0.0)) and abs(other) > sigma:
        yield (
            "whose height is whose is not certain: with another way that agrees about as well all "
            f"lengths would change by {100 * other:+.1f} %; name a take with one person in it, too"
        )


def _disagreeing(ratios: dict[float, float], most: float) -> Iterator[str]:
    """Yield that stated heights contradict each other."""
    tall, short = (choose(ratios, key=ratios.__getitem__) for choose in (max, min))
    if (apart := ratios[tall] - ratios[short]) > most:
        yield (
            f"stated heights disagree by {100 * apart:.1f} %: if {tall:.2f} m is right, somebody "
            f"stated as {short:.2f} m is {short * np.exp(apart):.2f} m tall; check both"
        )
