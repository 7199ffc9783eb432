"""What the correction of an inertial skeleton by vision changed, and what it rests on."""

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import rotations
from courtside.inertial.fit import BODY, HEADING_DEG, SHIFT_M, SIZE_RANGE, TURN_DEG, Fit
from courtside.records.devices.hierarchy import PosedHierarchy, forward
from courtside.study.errors import StrPath
from courtside.study.execution.files import write_json

# ASSUME: more prior deviations than a right clock or body takes, and the share of the largest slow
# turn or shift from which it is at its limit. On the suit of `players-b` right data took 0.6
# deviations of the clock and 0.25 of the limit; a clock wrong by 0.3 s took 15, by 1 s the limit.
MOST_DEVIATIONS, AT_LIMIT = 4.0, 0.95
LEAST_LAG_S = 1e-3  # ASSUME: clocks that are said to be one still differ by this


@dataclass(frozen=True)
class CorrectionReport:
    """A correction in numbers; every array as a list."""

    source: str  # vision's
    joints: list[str]  # common to vision and the skeleton, in the order of the lists below
    seen: list[float]  # share of vision's frames with that joint
    weight: list[float]  # mean weight of these frames: 1 as expected, towards 0 for outliers
    noise_mm: list[float]  # estimated standard deviation of vision per axis
    offset_mm: list[float]  # length of vision's estimated constant offset
    independent_s: list[float]  # estimated time per independent value of vision
    # Median distance to vision (agreement, not accuracy) as placed by the first estimate.
    before_mm: list[float | None]
    after_mm: list[float | None]  # the same, corrected
    # Median change of each joint of the skeleton about the root, without the change of heading.
    change_mm: dict[str, float]
    bone_scale: dict[str, float]  # factor on the bone that ends at a joint
    mount_deg: dict[str, float]  # constant turn of each segment
    slow_deg: dict[str, float]  # estimated standard deviation of the slow turns, by kind
    heading_removed_deg: float  # range of the heading correction
    heading_s: list[float]  # times of `heading_deg`, once a second
    heading_deg: list[float]  # heading correction
    shift_m: float  # estimated standard deviation of the slow shift of the root
    lag_s: float  # estimated shift of the clock: subtracted from the device's times
    lag_sd_s: float  # its standard deviation
    vision_from_device: list[list[float]]  # (3, 4) of the corrected skeleton
    rounds: int
    rms_change_mm: list[float]  # change of all joints in each round of the fit

    def write(self, path: StrPath) -> None:
        """Write as JSON."""
        write_json(path, asdict(self))


def describe(fit: Fit, before: PosedHierarchy, after: PosedHierarchy) -> CorrectionReport:
    """Describe a finished fit; `before` and `after` hold the performed frames."""
    seen = np.isfinite(fit.seen.xyz).all(axis=2)
    count = np.maximum(seen.sum(axis=0), 1)
    sigma = np.sqrt(np.trace(fit.noise.covariance, axis1=1, axis2=2) / 3)
    typical = [
        np.median(fit.seen.sigma_m[at, d]) if at.any() else 1.0 for d, at in enumerate(seen.T)
    ]
    fixed, layout = fit.fixed, fit.model.fixed
    mount = np.linalg.norm(fixed[layout["mount"]].reshape(-1, 3), axis=1)
    offset = np.linalg.norm(fixed[layout["offset"]].reshape(-1, 3), axis=1)
    slow = {kind: np.degrees(size) for kind, size in fit.size.items() if kind != "shift"}
    return CorrectionReport(
        source=fit.seen.source,
        joints=list(fit.seen.joints),
        seen=_list(seen.mean(axis=0), 3),
        weight=_list(fit.noise.weight.sum(axis=0) / count, 3),
        noise_mm=_list(1e3 * sigma * np.array(typical), 1),
        offset_mm=_list(1e3 * offset, 1),
        independent_s=_list(fit.noise.inflation / fit.rate_hz, 2),
        before_mm=_away(fit, fit.first),
        after_mm=_away(fit, fit.last),
        change_mm=_changes(fit, before, after),
        bone_scale=_scales(fit),
        mount_deg=dict(zip(fit.segments.names, _list(np.degrees(mount), 2), strict=True)),
        slow_deg={kind: round(float(size), 2) for kind, size in slow.items()},
        **_heading(fit),
        shift_m=float(fit.size["shift"]),
        lag_s=float(fixed[layout["lag"]][0]),
        lag_sd_s=float(np.sqrt(fit.border_covariance[layout["lag"], layout["lag"]][0, 0])),
        vision_from_device=_vision_from_device(fit, after),
        rounds=fit.round,
        rms_change_mm=_list(1e3 * np.array(fit.rms_change_m), 3),
    )


def doubts(report: CorrectionReport, lag_s: float) -> list[str]:
    """Return lines on corrections so large that vision and suit do not show the same.

    `lag_s` is the stated standard deviation of the offset between both clocks. Distances to vision
    do not tell: slow turns and bones give way until the skeleton fits.
    """
    said = []
    stretch = float(np.median(list(report.bone_scale.values())))
    if abs(np.log(stretch)) > MOST_DEVIATIONS * BODY:
        said.append(
            f"bones {stretch:.2f} times as long: look whether its lengths are in metres, and the "
            "suit's height is that of the wearer"
        )
    if abs(report.lag_s) > MOST_DEVIATIONS * max(lag_s, LEAST_LAG_S):
        said.append(
            f"a shift of the clock by {1e3 * report.lag_s:.0f} ms, where {1e3 * lag_s:.0f} ms are "
            "its standard deviation: look at the wrist distance"
        )
    stated = TURN_DEG | {"heading": HEADING_DEG, "shift": SHIFT_M}
    sizes = report.slow_deg | {"shift": report.shift_m}
    most = AT_LIMIT * SIZE_RANGE[1]
    if bent := [kind for kind, size in sizes.items() if size >= most * stated[kind]]:
        said.append(
            f"the largest slow turns or shift that are allowed ({', '.join(bent)}): both perhaps "
            "show different moments or persons; look at the wrist distance"
        )
    start = f"correction by {report.source}: expected errors of a suit, found "
    return [start + line for line in said]


def _list(values: Iterable[float], digits: int) -> list[float]:
    return [round(float(value), digits) for value in values]


def _away(fit: Fit, xyz: NDArray) -> list[float | None]:
    distance = 1e3 * np.linalg.norm(fit.vision - xyz, axis=2)
    return [
        round(float(np.nanmedian(joint)), 1) if np.isfinite(joint).any() else None
        for joint in distance.T
    ]


def _scales(fit: Fit) -> dict[str, float]:
    joints, parents = fit.posed.hierarchy.joints, fit.posed.hierarchy.parents
    factor = fit.model.stretches(fit.fixed)
    return {
        joint: round(float(value), 4)
        for joint, parent, value in zip(joints, parents, factor, strict=True)
        if parent >= 0
    }


def _total_heading(fit: Fit, time_s: NDArray) -> NDArray:
    return (
        fit.alignment.heading_at(time_s) + fit.slow_at(time_s)[:, fit.model.slow["heading"]][:, 0]
    )


def _heading(fit: Fit) -> dict[str, Any]:
    time_s = np.arange(fit.posed.time_s[0], fit.posed.time_s[-1], 1.0)
    heading = np.degrees(_total_heading(fit, time_s))
    return {
        "heading_removed_deg": round(float(np.ptp(heading)), 2),
        "heading_s": _list(time_s, 3),
        "heading_deg": _list(heading, 2),
    }


def _changes(fit: Fit, before: PosedHierarchy, after: PosedHierarchy) -> dict[str, float]:
    """Return the median change of each joint about the root, in axes turned back by the heading."""
    old, new = (forward(posed)[0] for posed in (before, after))
    turn = rotations.rotation_from_rodrigues(_total_heading(fit, after.time_s)[:, None] * fit.up)
    old = np.einsum("tij,tkj->tki", turn, old - old[:, :1])
    change = 1e3 * np.median(np.linalg.norm(new - new[:, :1] - old, axis=2), axis=0)
    return dict(zip(before.hierarchy.joints, _list(change, 1), strict=True))


def _vision_from_device(fit: Fit, after: PosedHierarchy) -> list[list[float]]:
    layout = fit.model.fixed
    turned = rotations.rotation_from_rodrigues(fit.fixed[layout["tilt"]])
    rotation = fit.alignment.vision_from_device @ turned
    root = fit.translation[:, 0] + fit.slow_at(after.time_s)[:, fit.model.slow["shift"]]
    place = root @ turned.T + fit.fixed[layout["place"]] + fit.place
    place = place @ fit.alignment.vision_from_device.T - after.translation[:, 0] @ rotation.T
    return np.column_stack([rotation, place.mean(axis=0)]).tolist()
