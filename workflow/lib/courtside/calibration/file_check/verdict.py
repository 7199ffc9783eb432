"""Whether cameras disagree more than they should, and which fault explains it best.

Static points count by their root mean square, people's joints by the median over points, each as a
logarithm: a fault whose removal halves both gains 2 log 2. Faults with free numbers pay for them.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import product

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.calibration.file_check import faults, residuals
from courtside.calibration.file_check.faults import Fault
from courtside.geometry.camera import Camera

FEWEST_STATIC, FEWEST_JOINTS = 4, 60  # ASSUME: fewer say nothing
FLOOR_PX = 0.5  # ASSUME: below, residuals say nothing: clicks and networks are no better
PRICE = {0: 0.05, 1: 0.1, 3: 0.2, 4: 0.25, 6: 0.3}  # ASSUME: of a fault, by its free numbers
FREE = (faults.FOCAL, faults.TURNED, faults.ZOOMED, faults.MOVED)
MOST_MIRRORED = 8  # coordinates mirrored together are tried up to so many: 256 ways
# ASSUME: the least gain of an explanation without and with free numbers; and what is too much
# without an explanation: of static points as a share of the longer side of the picture, of joints
# as a share of people's height. Perfect cameras stay well below
# (docs/measured/ways_to_calibrate.md).
LEAST_GAIN = {False: 0.15, True: 0.3}
LARGEST = {"static": 2e-3, "people": 0.035}
MEASURES = {"static": residuals.rms_px, "people": residuals.typical_px}
TO_BE_SURE = (
    "; more cameras may be wrong by less than joints show: click points at rest (`static_points`) "
    "to be sure"
)
WORDS = {"static": "static points by {:.1f} px", "people": "people's joints by {:.1f} px"}


class Seen:
    """What the cameras see: clicks of static points (C, N, 2) px, and people's joints, likewise."""

    def __init__(self, static: NDArray | None = None, people: NDArray | None = None) -> None:
        given = (("static", static, FEWEST_STATIC), ("people", people, FEWEST_JOINTS))
        self.of = {
            what: residuals.Rays(xy)
            for what, xy, fewest in given
            if xy is not None and xy.shape[1] >= fewest
        }

    def px(self, cameras: Sequence[Camera]) -> dict[str, float]:
        """Return how far views disagree, px per axis, by `static` and `people` where enough."""
        return {what: MEASURES[what](rays.residuals(cameras)) for what, rays in self.of.items()}

    def cost(self, cameras: Sequence[Camera]) -> float:
        """Return the sum of the logarithms of these."""
        return float(sum(np.log(max(px, FLOOR_PX)) for px in self.px(cameras).values()))

    def views(self) -> NDArray:
        """Return all points, (C, N, 2) px."""
        return np.concatenate([rays.xy for rays in self.of.values()], axis=1)


@dataclass(frozen=True)
class Verdict:
    """What is wrong: one warning or none, and the faults that explain it, none if unknown."""

    warnings: list[str]
    faults: list[Fault]
    px: dict[str, float]  # how far views disagree, by `static` and `people`
    mended_px: dict[str, float]  # the same without the faults
    cameras: tuple[Camera, ...] = ()  # without the faults; none if there are no faults


@dataclass(frozen=True)
class _Explained:
    cameras: tuple[Camera, ...]
    score: float  # cost and price
    faults: list[Fault] = field(default_factory=list)


def judge(cameras: Sequence[Camera], seen: Seen, person_px: float = np.inf) -> Verdict:
    """Judge cameras by what they see.

    `person_px` is how tall people are in the pictures, from shoulders to ankles. A fault of all
    cameras together (another unit, a mirrored world) does not show in how they agree.
    """
    before = seen.px(cameras)
    if not before:
        return Verdict([], [], {}, {})
    best = _explain(cameras, seen)
    after, free = seen.px(best.cameras), any(one.n_free for one in best.faults)
    side_px = max(max(camera.size) for camera in cameras)
    limits_px = {"static": LARGEST["static"] * side_px, "people": LARGEST["people"] * person_px}
    far = " and ".join(WORDS[what].format(px) for what, px in before.items())
    gain = seen.cost(cameras) - best.score
    if best.faults and gain >= LEAST_GAIN[free] and _within(after, limits_px):
        order = sorted(best.faults, key=lambda one: one.what)
        causes = ", ".join(f"{one.what} ({one.advice})" for one in order)
        left = " and ".join(f"{px:.1f} px" for px in after.values())
        line = f"the cameras of the file disagree: {far}; probably {causes}; then {left} are left"
        line += "" if "static" in before else TO_BE_SURE
        return Verdict([line], order, before, after, best.cameras)
    if _within(before, limits_px):
        return Verdict([], [], before, before)
    line = f"the cameras of the file disagree: {far}; no single fault of it explains this"
    return Verdict([f"{line}{_worst(cameras, seen)}; calibrate again"], [], before, before)


def _within(px: dict[str, float], limits_px: dict[str, float]) -> bool:
    return all(value <= limits_px[what] for what, value in px.items())


def by_camera(cameras: Sequence[Camera], seen: Seen) -> pd.DataFrame:
    """Return the residuals of each camera: `what`, `camera`, `n`, `x_px`, `y_px`, `off_px`.

    `x_px`, `y_px`: the median from where the other cameras expect a point to where it is seen, NaN
    with two cameras. `off_px`: per axis, against points from all views; of static points the root
    mean square, of people's joints its median. The camera `all` stands for all of them.
    """
    rows = []
    for what, rays in seen.of.items():
        together, alone = rays.residuals(cameras), residuals.left_out(cameras, rays.xy)
        for at, camera in enumerate(cameras):
            known = np.isfinite(alone[at, :, 0])
            x_px, y_px = np.median(alone[at, known], axis=0) if known.any() else (np.nan, np.nan)
            n = int(np.isfinite(together[at, :, 0]).sum())
            off_px = MEASURES[what](together[at : at + 1]) if n else np.nan
            rows.append((what, camera.name, n, x_px, y_px, off_px))
        n = int(np.isfinite(together[..., 0]).sum())
        rows.append((what, "all", n, np.nan, np.nan, MEASURES[what](together)))
    return pd.DataFrame(rows, columns=["what", "camera", "n", "x_px", "y_px", "off_px"])


def _worst(cameras: Sequence[Camera], seen: Seen) -> str:
    rows = by_camera(cameras, seen)
    far = np.hypot(rows.x_px, rows.y_px)
    if not np.isfinite(far).any():
        return ""
    worst = rows.loc[far.idxmax()]
    return f", most of all camera {worst.camera} ({worst.x_px:+.1f}, {worst.y_px:+.1f} px)"


def _explain(cameras: Sequence[Camera], seen: Seen) -> _Explained:
    """Return the explanation with the lowest score; without faults if nothing is better."""
    plain = _Explained(tuple(cameras), seen.cost(cameras))
    found = [_greedy(start, seen) for start in (plain, _mirrored(plain, seen))]
    return min([*found, *_fitted(plain, seen)], key=lambda one: one.score)


def _greedy(start: _Explained, seen: Seen) -> _Explained:
    """Add one simple fault after the other, as long as the score falls."""
    best = start
    for _ in range(2 * len(start.cameras)):
        price = PRICE[0] * (len(best.faults) + 1)
        more = [
            _Explained(one.cameras, seen.cost(one.cameras) + price, [*best.faults, one])
            for one in faults.simple(best.cameras)
        ]
        nearer = min(more, key=lambda one: one.score)
        if nearer.score >= best.score:
            return best
        best = nearer
    return best


def _mirrored(start: _Explained, seen: Seen) -> _Explained:
    """Return the best way to mirror principal points of several cameras together."""
    coordinates = [(at, axis) for at in range(len(start.cameras)) for axis in (0, 1)]
    if len(coordinates) > MOST_MIRRORED:
        return start
    found = [start]
    for chosen in product((False, True), repeat=len(coordinates)):
        mirrored, cameras = [], start.cameras
        for (at, axis), wanted in zip(coordinates, chosen, strict=True):
            for one in faults.mirrored(cameras, at, axis) if wanted else ():
                mirrored.append(one)
                cameras = one.cameras
        found.append(_Explained(cameras, seen.cost(cameras) + PRICE[0] * len(mirrored), mirrored))
    return min(found, key=lambda one: one.score)


def _fitted(start: _Explained, seen: Seen) -> list[_Explained]:
    """Return explanations by one camera whose numbers are fitted to what the others see."""
    xy, found, cameras = seen.views(), [], start.cameras
    for at in range(len(cameras) if len(cameras) >= 3 else 0):
        xyz = residuals.placed_by_others(cameras, xy, at)
        for one in faults.fitted(cameras, at, xyz, xy[at], FREE):
            score = seen.cost(one.cameras) + PRICE[one.n_free]
            found.append(_Explained(one.cameras, score, [one]))
    return found
