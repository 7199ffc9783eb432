"""All sources' skeletons in the T-pose, from front and side, and one map of their joints."""

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from courtside.figures.style import joint_map, schematic_pose, source_styles, style
from courtside.records.keypoints.body_motion import BodyMotion
from courtside.records.keypoints.skeleton import Skeleton

N_COLUMNS = 2
PLATE_MM, LINE_MM = 76, 4.2
ASIDE = 1.75  # units: the side view stands that far to the right of the front view
ARM_UNITS = 0.25  # numbers of joints higher than that stand above them, of others outwards
LEFT, RIGHT, TOP = -1.3, 2.2, 1.12  # shown at least to the right
LOWEST, ROOM = -1.45, 0.25  # of the feet, at least; below them, for words
WRAP = 60  # characters of a title, in half of a page
AXES = (((0, 1), 0.0, "from the front"), ((2, 1), ASIDE, "from the right"))
TPOSE, SCHEMATIC = "T-pose", "schematic"
COLUMNS = [
    "source", "skeleton", "number", "joint", "device_name", "x", "y", "z", "stands_for", "pose",
]  # fmt: skip
WORDS = {  # of derived joints, in the table
    "head_centre": "centre of the head",
    "head_mass": "mass of the head",
    "mid_shoulder": "middle of the shoulders",
    "mid_hip": "middle of the hips",
    "pelvis_thorax": "stands for the navel",
}


@dataclass(frozen=True, eq=False)
class Plate:
    """One skeleton as it is drawn: joints (J, 3) in body axes and units, NaN where missing.

    `source` is empty without a recording, `kind` is as for `source_styles`, and `pose` says which
    pose is drawn.
    """

    source: str
    skeleton: Skeleton
    xyz: NDArray
    kind: str
    pose: str = SCHEMATIC


def plates(
    bodies: list[BodyMotion],
    skeletons: list[Skeleton],
    skeleton_of: dict[str, str],
    kinds: dict[str, str] | None = None,
) -> list[Plate]:
    """Return the plates: one for each recording, and one for each skeleton without any.

    Plates of recordings are medians over the T-pose, of those without a T-pose the frame with the
    arms furthest apart; others are schematic. `skeleton_of` is by source,
    `kinds` as for `source_styles.kind_of`.
    """
    known = {skeleton.name: skeleton for skeleton in skeletons}
    found = []
    for body in bodies:
        skeleton = known[skeleton_of[body.source]]
        still, pose = _drawn(body)
        seen = np.isfinite(still).all(axis=2).any(axis=0)
        xyz = np.full((len(skeleton.joints), 3), np.nan)
        for at, joint in enumerate(body.joints):
            if seen[at] and str(joint) in skeleton.joints:
                xyz[skeleton.index(str(joint))] = np.nanmedian(still[:, at], axis=0)
        kind = source_styles.kind_of(body.source, kinds)
        found.append(Plate(body.source, skeleton, xyz, kind, pose))
    shown = {plate.skeleton.name for plate in found}
    for name, skeleton in known.items():
        if name not in shown:
            xyz = schematic_pose.tpose(skeleton.joints)
            found.append(Plate("", skeleton, xyz, "other"))
    return found


def _drawn(body: BodyMotion) -> tuple[NDArray, str]:
    """Return the frames (T, J, 3) that a plate shows, and their pose in words."""
    start_s, stop_s = body.tpose_s
    if np.isfinite(stop_s):
        return body.fixed[(body.time_s >= start_s) & (body.time_s <= stop_s)], TPOSE
    left, right = (list(body.joints).index(f"{side}_wrist") for side in ("left", "right"))
    apart = np.linalg.norm(body.following[:, left] - body.following[:, right], axis=1)
    if not np.isfinite(apart).any():
        return body.following[:0], "no T-pose, and no frame with both arms"
    at = int(np.nanargmax(apart))
    return body.following[at : at + 1], f"no T-pose; frame at {body.time_s[at]:.2f} s"


def table(found: list[Plate], rows: pd.DataFrame) -> pd.DataFrame:
    """Return the numbers drawn, one row per joint of each plate; `rows` are of `joint_map`."""
    parts: dict[tuple[str, int], list[str]] = {}
    for _, row in rows.iterrows():
        for number, weight in zip(row["numbers"], row["weights"], strict=True):
            part = f"{row['common']} {weight:g}"
            parts.setdefault((row["skeleton"], number), []).append(part)
    lines = []
    for plate in found:
        called = plate.skeleton.device_names()
        for number, joint in enumerate(plate.skeleton.joints):
            stands_for = "; ".join(parts.get((plate.skeleton.name, number), []))
            about = plate.source or "schematic", plate.skeleton.name, number, joint, called[number]
            lines.append((*about, *plate.xyz[number], stands_for, plate.pose))
    return pd.DataFrame(lines, columns=COLUMNS)


def draw(found: list[Plate], rows: pd.DataFrame) -> Figure:
    """Draw plates above, the map of their joints (rows of `joint_map`) below."""
    n_rows = -(-len(found) // N_COLUMNS)
    heights = [PLATE_MM * n_rows, 12 + LINE_MM * rows["common"].nunique()]
    drawing = style.figure(sum(heights))
    above, below = drawing.subfigures(2, 1, height_ratios=heights)
    axes = above.subplots(n_rows, N_COLUMNS, squeeze=False).ravel()
    numbered = rows[rows["definition"] == ""].groupby("skeleton")["numbers"].sum()
    for axis in axes:
        axis.set_axis_off()
    known = [plate.xyz[np.isfinite(plate.xyz).all(axis=1)] for plate in found]
    low = min(LOWEST, *(xyz[:, 1].min(initial=0.0) for xyz in known)) - ROOM
    right = max(RIGHT, *(ASIDE + xyz[:, 2].max(initial=0.0) + ROOM / 2 for xyz in known))
    for axis, plate in zip(axes, found, strict=False):
        axis.set(xlim=(LEFT, right), ylim=(low, TOP))
        _draw_plate(axis, plate, numbered.get(plate.skeleton.name, ()))
    _draw_map(below.subplots(), rows)
    return drawing


def _draw_plate(axis: Axes, plate: Plate, numbered: Sequence[int]) -> None:
    colour = source_styles.COLOURS.get(plate.kind, source_styles.OTHER)
    for pair, aside, words in AXES:
        at = plate.xyz[:, pair] + (aside, 0)
        for start, stop in plate.skeleton.bones:
            ends = at[[plate.skeleton.index(start), plate.skeleton.index(stop)]]
            axis.plot(*ends.T, color=colour, linewidth=1.1, alpha=0.55, zorder=2)
        axis.plot(*at.T, "o", color=colour, markersize=2.6, zorder=3)
        axis.plot([aside], [0], "+", color="black", markersize=6, zorder=1)
        axis.text(aside, axis.get_ylim()[0], words, ha="center", va="bottom", fontsize=7)
    for number in numbered:
        x, y, _ = plate.xyz[number]
        if y > ARM_UNITS:
            look: dict = {"xytext": (0, 4), "ha": "center", "va": "bottom"}
        else:
            outwards, ha = (5, "left") if x > 0 else (-5, "right")
            look = {"xytext": (outwards, 0), "ha": ha, "va": "center"}
        look |= {"textcoords": "offset points", "fontsize": 6, "color": "#333333"}
        axis.annotate(f"{number}", (x, y), **look)
    axis.set_aspect("equal")
    size = f"{plate.skeleton.name}, {len(plate.skeleton.joints)} joints"
    pose = "" if plate.pose in (TPOSE, SCHEMATIC) else f"; {plate.pose}"
    title = f"{plate.source or 'no recording, schematic'}: {size}{pose}"
    axis.set_title(textwrap.fill(title, WRAP), pad=2)


def _draw_map(axis: Axes, rows: pd.DataFrame) -> None:
    names, common = (list(dict.fromkeys(rows[key])) for key in ("skeleton", "common"))
    wide = 1 / (len(names) + 0.9)
    left = {name: (at + 0.9) * wide for at, name in enumerate(names)}
    axis.set_axis_off()
    axis.set(xlim=(0, 1), ylim=(len(common) + 0.6, -1.0))
    for name in names:
        axis.text(left[name], -0.5, name, va="center", fontsize=7, fontweight="bold")
    axis.text(0, -0.5, "common joint", va="center", fontsize=7, fontweight="bold")
    axis.axhline(0, color="black", linewidth=0.6)
    for y, joint in enumerate(common):
        own = rows[rows["common"] == joint]
        words = (
            f"left, right {joint}" if (own["definition"] == "").all() else WORDS.get(joint, joint)
        )
        mark = "" if own["same"].all() else " †"
        axis.text(0, y + 0.5, words + mark, va="center", fontsize=6.5)
        for _, row in own.iterrows():
            cell = joint_map.cell(row)
            axis.text(left[row["skeleton"]], y + 0.5, cell, va="center", fontsize=6.5)
    notes = "* computed from several joints    † defined as another point in each skeleton"
    axis.text(0, len(common) + 0.4, notes, va="center", fontsize=6.5)
