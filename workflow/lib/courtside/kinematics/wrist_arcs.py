"""The wrists' paths from T-pose to clap, seen from above, against arcs about the shoulders.

The arms turn about the shoulders: wrists of straight arms cannot follow the circle of radius 1
about the navel on which they start. The subject's own arcs have their centres at the shoulders.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.records.devices.events import CLAP_WITHIN_S
from courtside.records.keypoints.body_motion import BodyMotion
from courtside.study.errors import InputError
from courtside.study.execution import log

PLANE = [0, 2]  # x to the left hand, z forwards
SIDES = ("left", "right")
PATHS = ("side", "time_s", "x", "z", "off_arc", "off_circle")
DISTORTION = (
    "side", "n", "shoulder_x", "shoulder_z", "radius", "meeting_z", "mean_signed", "mean_distance",
    "p95_distance", "mean_off_circle", "end_radius",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Arc:
    """One wrist's path and its own arc, in the x-z plane of the body, units."""

    side: str
    time_s: NDArray  # (n,): on the reference clock
    path: NDArray  # (n, 2): x and z of the wrist; NaN where missing
    shoulder: NDArray  # (2,): centre of the arc: the shoulder in the T-pose
    radius: float  # of the arc: from shoulder to wrist in the T-pose

    @property
    def off_arc(self) -> NDArray:
        """Distance of the path to the own arc, (n,) units; positive outside."""
        return np.linalg.norm(self.path - self.shoulder, axis=1) - self.radius

    @property
    def off_circle(self) -> NDArray:
        """Distance of the path to the circle of radius 1, (n,) units; positive outside."""
        return np.linalg.norm(self.path, axis=1) - 1.0

    @property
    def meeting(self) -> NDArray:
        """Where the own arc crosses the middle and the hands could meet, (2,); NaN out of reach."""
        aside = self.radius**2 - self.shoulder[0] ** 2
        return np.array([0.0, self.shoulder[1] + np.sqrt(aside) if aside >= 0 else np.nan])


def missing(body: BodyMotion) -> str:
    """Return why a source has no arcs (no T-pose, or no clap after it); empty if it has arcs."""
    start_s, stop_s = body.tpose_s
    if not np.isfinite(stop_s):
        return (
            f"{body.source}: expected a T-pose, found only the rest pose of its own model; film one"
        )
    if not len(_claps_s(body)):
        claps = ", ".join(f"{time_s:.2f}" for time_s in body.clap_s) or "no time"
        return (
            f"{body.source}: expected a clap within {CLAP_WITHIN_S:g} s of the T-pose of "
            f"{start_s:.2f} to {stop_s:.2f} s, found claps at {claps}; clap after each T-pose"
        )
    return ""


def arcs(body: BodyMotion) -> list[Arc]:
    """Return the arcs of the left and right wrist from the T-pose's end to the first clap after it.

    An `InputError` with the words of `missing` if there are none.
    """
    if why := missing(body):
        raise InputError(why)
    start_s, stop_s = body.tpose_s
    still = (body.time_s >= start_s) & (body.time_s <= stop_s)
    moving = (body.time_s >= stop_s) & (body.time_s <= _claps_s(body)[0])
    found = []
    for side in SIDES:
        shoulder, wrist = (body.joint(f"{side}_{part}")[:, PLANE] for part in ("shoulder", "wrist"))
        centre = np.nanmedian(shoulder[still], axis=0)
        radius = float(np.linalg.norm(np.nanmedian(wrist[still], axis=0) - centre))
        found.append(Arc(side, body.time_s[moving], wrist[moving], centre, radius))
    return found


def arcs_or_none(body: BodyMotion, whose: str = "arcs") -> list[Arc]:
    """Return the arcs of a source; none, and why in the log, if it has none (`missing`)."""
    if why := missing(body):
        log.logger.warning("no %s of %s", whose, why)
        return []
    return arcs(body)


def _claps_s(body: BodyMotion) -> NDArray:
    """Return the claps that belong to the T-pose: later ones end other movements."""
    after_s = body.clap_s - body.tpose_s[1]
    return body.clap_s[(after_s > 0) & (after_s <= CLAP_WITHIN_S)]


def paths(found: Sequence[Arc]) -> pd.DataFrame:
    """Return the points of arcs as a table: side, time_s, x, z, off_arc, off_circle; body units."""
    rows = [
        (arc.side, *values)
        for arc in found
        for values in zip(arc.time_s, *arc.path.T, arc.off_arc, arc.off_circle, strict=True)
    ]
    return pd.DataFrame(rows, columns=PATHS).astype(dict.fromkeys(PATHS[1:], float))


def distortion(found: Sequence[Arc]) -> pd.DataFrame:
    """Return the distances of the paths from their own arcs, one row per wrist, body units.

    Columns: side; n; shoulder_x, shoulder_z, radius: of the own arc; meeting_z: where it crosses
    the middle; mean_signed, mean_distance, p95_distance: of the path's points to the own arc;
    mean_off_circle: to the circle of radius 1; end_radius: distance of the last known point to the
    origin. Without arcs (`missing`) one row per wrist in which n is 0 and the rest empty.
    """
    rows: list[dict] = [] if found else [{"side": side, "n": 0} for side in SIDES]
    for arc in found:
        off, circle = (values[np.isfinite(values)] for values in (arc.off_arc, arc.off_circle))
        row = {
            "side": arc.side,
            "n": len(off),
            "shoulder_x": arc.shoulder[0],
            "shoulder_z": arc.shoulder[1],
            "radius": arc.radius,
            "meeting_z": arc.meeting[1],
        }
        if len(off):
            row |= {
                "mean_signed": off.mean(),
                "mean_distance": np.abs(off).mean(),
                "p95_distance": np.percentile(np.abs(off), 95),
                "mean_off_circle": np.abs(circle).mean(),
                "end_radius": 1.0 + circle[-1],
            }
        rows.append(row)
    return pd.DataFrame(rows, columns=DISTORTION).astype(dict.fromkeys(DISTORTION[2:], float))
