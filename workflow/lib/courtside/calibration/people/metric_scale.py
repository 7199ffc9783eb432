"""The scale of cameras from people alone, from stated heights and known lengths.

Heights are stated for persons; which track shows which person is estimated with it. A known
length lies between two points at rest that are clicked in two cameras or more.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, product
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.calibration import point_covariance
from courtside.calibration.bundle import conversion
from courtside.calibration.court.joint_adjustment import click_sigma
from courtside.geometry.camera import Camera
from courtside.geometry.triangulation import triangulate_all
from courtside.records.keypoints import skeleton
from courtside.study.errors import InputError

LEARNED_FROM = 8  # persons: the mean of so few is uncertain, too
# ASSUME: between networks, and of real bodies: anatomical lengths are 0.77 (de Leva 1996) to 0.78
# (Winter 2009, fig. 4.1) of the height; those of the persons below are 0.77.
BODIES_SIGMA = 0.015
STATED_SIGMA_M = 0.01  # of a height stated to the centimetre, with shoes or without
MEASURED_SIGMA = 0.01  # ASSUME: of the length of one track, share
# ASSUME: constant errors of a network bend cameras: with exact clicks, the error of a line of 6.1 m
# was 0.5 to 0.9 % in eight calibrations from players-dev.
BEND_SIGMA = 0.008  # of a known length, share; common to all lengths
KNOWN_SIGMA_M = 0.003  # ASSUME: of a known length: ends of painted lines, rackets, poles
LEAST_FRAMES = 20  # ASSUME: for the length of a body
SURE = 2.0  # standard deviations
NOBODY = 3.0  # standard deviations: cost of a track of no person, and of a person without a track
HEIGHTS = "stated heights"
ONE_HEIGHT = "only one person's height defines the scale; add a second person, or a known length"
MOST_NAMED = 4  # lengths that a line names
MOST_WAYS = 4096  # assignments of tracks to persons in one take; only the longest tracks are used
MOST_PERSONS = 5  # of a take with assignments; with more, tracks are ordered by length
ROUNDS = 4  # of assignment and scale, in turn

# Stated heights, m, by take and person; None of a person of whom none is stated.
Heights = Mapping[str, Mapping[str, float | None]]


@dataclass(frozen=True)
class Share:
    """The length of leg and trunk over the height, by one kind of joints."""

    mean: float
    sigma: float  # between persons and directions of view, share of the length


# ASSUME: by BlazePose heavy with a mirrored second look, for the persons of players-dev,
# players-dev-stands and players-dev-near: joints as the network sees them, and less its offsets.
# A network's offsets depend on the direction of view: 0.733, 0.750 and 0.754 in these sessions by
# their true cameras, without the offsets 0.759, 0.765 and 0.765. By people alone, as here, the mean
# of five groups of persons is 0.003 and 0.0005 less.
SEEN = Share(0.745, 0.015)
CORRECTED = Share(0.763, 0.008)


@dataclass(frozen=True)
class Body:
    """The body of one track."""

    take: int
    length: float  # of leg and trunk, in any unit; NaN if too few joints are seen
    frames: int
    first: float  # time of the first joint in the take
    last: float  # time of the last joint
    tracklets: frozenset[tuple[int, int]] = frozenset()  # camera and row, of pieces if cut


@dataclass(frozen=True)
class Scale:
    """The scale of cameras: the length of their unit, m."""

    metres: float  # per unit
    sigma: float  # standard deviation, share
    by: str  # the measurement that defines it
    warnings: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()  # what the stated error already contains


@dataclass(frozen=True, eq=False)
class KnownLength:
    """A known length between two points at rest."""

    name: str
    length_m: float
    xy: NDArray  # (C, 2, 2): both ends in each camera, px, NaN where not clicked
    click_sigma_px: float  # scatter of a click, per axis, at a longer side of 3840 px
    click_bias_px: float = 0.0  # what all clicks in one picture have in common, likewise
    on_floor: bool = False  # whether both ends lie on the floor


def length(xyz: NDArray) -> float:
    """Return the length of leg and trunk of a person from joints (T, J, 3), NaN where unknown.

    It is the sum of the medians of its parts over frames, so posture does not change it. Joints are
    those of `skeleton.JOINTS`.
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

    Each of `stated` has `points`, `length_m` and perhaps `on_floor`. Scatter and bias of a click
    are at a longer side of 3840 px. Raises `InputError` for a point that is not clicked.
    """
    found = []
    for one in stated:
        name = " to ".join(one["points"])
        if missing := [end for end in one["points"] if end not in points]:
            raise InputError(
                f"known length {name}: expected clicks of both points in `static_points`, found "
                f"none of {missing[0]}, only of {', '.join(points)}; click it in two cameras or "
                "more"
            )
        ends = xy[:, [list(points).index(end) for end in one["points"]]]
        click = click_sigma_px, click_bias_px
        found.append(KnownLength(name, one["length_m"], ends, *click, one.get("on_floor", False)))
    return found


def find(
    cameras: Sequence[Camera],
    bodies: Sequence[Body],
    heights_m: Heights,
    known: Sequence[KnownLength] = (),
    shape: NDArray | None = None,
    share: Share = SEEN,
) -> Scale:
    """Return the scale from stated heights and known lengths, weighted by their covariance.

    `shape` (K, K) is the covariance of the cameras' columns without their scale; `share` is that of
    the bodies' lengths in their heights. Heights are not needed if a length is known.
    Contradictions become warnings.
    """
    each, covariance = by_lengths(cameras, known, shape)
    takes = _takes(bodies, heights_m, share)
    if takes or not each:
        each.append(by_heights(bodies, heights_m, share))
        covariance = scipy.linalg.block_diag(covariance, each[-1].sigma ** 2)
    return combined(each, covariance)


def combined(each: Sequence[Scale], covariance: NDArray) -> Scale:
    """Return one scale from several, `covariance` (U, U) of their logarithms.

    The weights are those of least squares, without negative ones.
    """
    if len(each) == 1:
        return each[0]
    weight = np.maximum(np.linalg.solve(covariance, np.ones(len(each))), 0.0)
    weight /= weight.sum()
    scale = float(np.exp(weight @ np.log([one.metres for one in each])))
    warnings = [line for one in each for line in one.warnings]
    warnings += [
        f"{one.by}: expected a change of all lengths by {SURE * 100 * one.sigma:.1f} % at most if "
        f"only these define the scale, found {100 * (one.metres / scale - 1):+.1f} %; check them "
        f"against {each[int(weight.argmax())].by}"
        for one in each
        if abs(np.log(one.metres / scale)) > SURE * one.sigma
    ]
    by = ", ".join(one.by for one in each)
    if len(each) > MOST_NAMED:
        by = f"{each[0].by} and {len(each) - 1} others"
    return Scale(scale, float(np.sqrt(weight @ covariance @ weight)), by, tuple(warnings))


def by_lengths(
    cameras: Sequence[Camera], known: Sequence[KnownLength], shape: NDArray | None = None
) -> tuple[list[Scale], NDArray]:
    """Return the scales from known lengths, and the covariance (L, L) of their logarithms.

    They have in common: the error of the cameras' shape, the bias of the clicks in a picture, the
    bend by a network, and the error of the length of one object at several places: known lengths
    of equal size are taken as such. Raises `InputError` if fewer than two cameras see an end.
    """
    if not known:
        return [], np.zeros((0, 0))
    each = [_share(cameras, one, shape) for one in known]
    own, scatter, bias, by_column = (list(part) for part in zip(*each, strict=True))
    covariance = np.diag(scatter) + np.stack(bias) @ np.stack(bias).T + BEND_SIGMA**2
    if shape is not None:
        covariance += np.stack(by_column) @ shape @ np.stack(by_column).T
    length_m = np.array([one.length_m for one in known])
    same = length_m[:, None] == length_m
    covariance += same * KNOWN_SIGMA_M**2 / np.outer(length_m, length_m)
    sigma = np.sqrt(np.diag(covariance))
    ratio = length_m / own
    scales = [
        Scale(float(r), float(s), k.name) for r, s, k in zip(ratio, sigma, known, strict=True)
    ]
    return scales, covariance


def _share(
    cameras: Sequence[Camera], known: KnownLength, shape: NDArray | None
) -> tuple[float, float, NDArray, NDArray]:
    """Return a known length by the cameras, and shares of it.

    These are its variance by the scatter of clicks, its change by the bias of the clicks in each
    picture (2 C,), of one standard deviation, and its change with each column of the cameras (K,).
    """
    ends = triangulate_all(cameras, known.xy)
    along = ends[1] - ends[0]
    own = float(np.linalg.norm(along))
    if not own > 0:
        raise InputError(
            f"known length {known.name}: expected both ends clicked in two cameras or more, found "
            "an end that cannot be triangulated; check its clicks"
        )
    n_clicks = known.xy.size
    steps = np.eye(n_clicks).reshape(n_clicks, *known.xy.shape)  # 1 px each
    moved_ends = triangulate_all(cameras, (known.xy + steps).transpose(1, 0, 2, 3))
    by_click = np.linalg.norm(moved_ends[:, 1] - moved_ends[:, 0], axis=1) / own - 1
    by_click = np.nan_to_num(by_click.reshape(known.xy.shape))  # (C, 2, 2): camera, end, axis
    sizes = [camera.size for camera in cameras]
    scatter, bias = (
        np.array([click_sigma(px, size) for size in sizes])[:, None]
        for px in (known.click_sigma_px, known.click_bias_px)
    )
    variance = float(((by_click * scatter[:, None]) ** 2).sum())
    by_bias = (by_click.sum(axis=1) * bias).ravel()
    by_column = np.zeros(0)
    if shape is not None:
        clicked = np.isfinite(known.xy).all(axis=-1).T
        one, other = point_covariance.sensitivity(conversion.network_of(cameras), ends, clicked)
        by_column = along / own**2 @ (other - one)
    return own, variance, by_bias, by_column


def by_heights(bodies: Sequence[Body], heights_m: Heights, share: Share = SEEN) -> Scale:
    """Return the scale from the stated heights of each take's persons.

    Tracks are assigned to persons so that the lengths of all bodies agree best. Tracks with common
    times are of different persons, unless they share a tracklet, because a camera exchanged two
    people. A track may be of no person, and a person may have no track. A take is used if all its
    heights are stated and it has as many tracks. There are warnings if another assignment agrees
    about as well and gives another scale, if heights contradict each other, and if both a track and
    a person of one take are left over. Raises `InputError` if no take can be used.
    """
    by_name = _takes(bodies, heights_m, share)
    if not by_name:
        raise InputError(
            "people: expected a take with `height_m` of every person, and as many tracks that show "
            f"legs and trunk, found {'; '.join(_lacking(bodies, heights_m))}; state the heights, "
            "add such a take, or state `known_lengths`: nothing else defines the scale"
        )
    takes = list(by_name.values())
    starts = np.unique(np.concatenate([take.ratio().ravel() for take in takes]).round(4))
    found = [_converged(takes, scale) for scale in starts[np.isfinite(starts)]]
    cost, scale, ratios = min(found, key=lambda one: one[0])
    stated = [list(own.values()) for own in heights_m.values()]
    persons = sum(max(own.count(height) for own in stated) for height in ratios)
    of_height = np.hypot(share.sigma, STATED_SIGMA_M / min(ratios))
    learned = share.sigma / np.sqrt(LEARNED_FROM)
    sigma = float(np.linalg.norm([of_height / np.sqrt(persons), learned, BODIES_SIGMA]))
    rivals = [np.expm1(one[1] - scale) for one in found if one[0] < cost + SURE**2]
    warnings = [*_rivals(rivals, sigma), *_disagreeing(ratios, SURE * np.sqrt(2) * of_height)]
    warnings += _left_over(by_name, scale)
    remarks = (ONE_HEIGHT,) if persons == 1 else ()
    return Scale(float(np.exp(scale)), sigma, HEIGHTS, tuple(warnings), remarks)


@dataclass(frozen=True, eq=False)
class _Assignments:
    """All W assignments of the B tracks of a take to its persons."""

    height_m: NDArray  # (W, B): of the person of each track; NaN for no person
    stature: NDArray  # (B,): height by the length of the body, in its unit
    share_sigma: float  # of the share of this length
    weight: NDArray  # (B,): share of the frames
    n_unseen: NDArray  # (W,): stated persons without a track

    def ratio(self) -> NDArray:
        """Return the logarithm (W, B) of metres per unit by each track."""
        return np.log(self.height_m / self.stature)

    def best(self, scale: float) -> tuple[float, int]:
        """Return the cost of the best assignment, in variances, and its index."""
        own = np.hypot(self.share_sigma, STATED_SIGMA_M / self.height_m)
        off = (self.ratio() - scale) / np.hypot(own, MEASURED_SIGMA)
        cost = np.nan_to_num(off**2, nan=NOBODY**2) @ self.weight + NOBODY**2 * self.n_unseen
        return float(cost.min()), int(cost.argmin())


def _takes(bodies: Sequence[Body], heights_m: Heights, share: Share) -> dict[str, _Assignments]:
    """Return the assignments of all takes that can be used."""
    each = {
        name: _assignments([one for one in bodies if one.take == take], stated.values(), share)
        for take, (name, stated) in enumerate(heights_m.items())
    }
    return {name: found for name, found in each.items() if found is not None}


def _lacking(bodies: Sequence[Body], heights_m: Heights) -> Iterator[str]:
    """Yield why each take says nothing of the scale."""
    for at, (take, stated) in enumerate(heights_m.items()):
        unknown = [name for name, height_m in stated.items() if not height_m]
        usable = sum(one.take == at and np.isfinite(one.length) for one in bodies)
        if unknown:
            yield f"take {take} without the height of {', '.join(unknown)}"
        else:
            shown = ", ".join(stated) or "nobody"
            yield f"take {take} with {usable} of these tracks for {shown}"


def _assignments(
    bodies: Sequence[Body], stated: Iterable[float | None], share: Share
) -> _Assignments | None:
    """Return the assignments of one take; None without all heights, or with fewer tracks."""
    heights = np.array([one or np.nan for one in stated])
    known = sorted((one for one in bodies if np.isfinite(one.length)), key=lambda one: -one.frames)
    if not len(heights) or not np.isfinite(heights).all() or len(known) < len(heights):
        return None
    most = int(np.log(MOST_WAYS) / np.log(len(heights) + 1))
    known = known[: max(len(heights), most)]
    stature = np.array([one.length / share.mean for one in known])
    weight = np.array([one.frames for one in known], dtype=float)
    weight *= len(heights) / weight[: len(heights)].sum()
    if len(heights) > MOST_PERSONS:
        order = np.argsort(np.argsort(stature))
        ordered = np.sort(heights)[order][None]
        return _Assignments(ordered, stature, share.sigma, weight, np.zeros(1))
    every = np.array(list(product(range(len(heights) + 1), repeat=len(known))))
    fine = (every < len(heights)).any(axis=1)
    for (a, one), (b, other) in combinations(enumerate(known), 2):
        together = min(one.last, other.last) > max(one.first, other.first)
        if together and not one.tracklets & other.tracklets:
            fine &= (every[:, a] != every[:, b]) | (every[:, a] == len(heights))
    seen = np.sum([(every[fine] == who).any(axis=1) for who in range(len(heights))], axis=0)
    whose = np.append(heights, np.nan)[every[fine]]
    if not len(whose):
        return None
    return _Assignments(whose, stature, share.sigma, weight, len(heights) - seen)


def _converged(
    takes: Sequence[_Assignments], scale: float
) -> tuple[float, float, dict[float, float]]:
    """Return the cost, the logarithm of the scale, and the same by height, from a first scale."""
    for _ in range(ROUNDS):
        best = [(take, take.best(scale)[1]) for take in takes]
        height_m = np.concatenate([take.height_m[at] for take, at in best])
        ratio = np.concatenate([take.ratio()[at] for take, at in best])
        weight = np.concatenate([take.weight for take in takes])
        ratios = {}
        for one in np.unique(height_m[np.isfinite(height_m)]):
            own = height_m == one
            ratios[float(one)] = float(np.average(ratio[own], weights=weight[own]))
        scale = float(np.mean(list(ratios.values())))
    return sum(take.best(scale)[0] for take in takes), scale, ratios


def _rivals(rivals: Sequence[float], sigma: float) -> Iterator[str]:
    """Yield a warning if other assignments that agree as well give another scale."""
    if (other := max(rivals, key=abs, default=0.0)) and abs(other) > sigma:
        yield (
            "stated heights: another assignment of heights to persons agrees about as well and "
            f"would change all lengths by {100 * other:+.1f} %; add a take with only one person"
        )


def _disagreeing(ratios: dict[float, float], most: float) -> Iterator[str]:
    """Yield a warning if stated heights contradict each other."""
    tall, short = (choose(ratios, key=ratios.__getitem__) for choose in (max, min))
    if (apart := ratios[tall] - ratios[short]) > most:
        yield (
            f"stated heights disagree by {100 * apart:.1f} %: if {tall:.2f} m is right, the person "
            f"of {short:.2f} m is {short * np.exp(apart):.2f} m tall; check both heights"
        )


def _left_over(takes: Mapping[str, _Assignments], scale: float) -> Iterator[str]:
    """Yield a warning for each take in which a track fits nobody and somebody has no track."""
    for name, take in takes.items():
        at = take.best(scale)[1]
        nobody = take.stature[np.isnan(take.height_m[at])]
        if len(nobody) and take.n_unseen[at]:
            yield (
                f"stated heights: take {name} shows a person of {nobody[0] * np.exp(scale):.2f} m, "
                "whom no stated height fits, and a person of the take has no track; check the "
                "heights, and who is in which take"
            )
