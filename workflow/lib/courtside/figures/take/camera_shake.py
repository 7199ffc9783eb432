"""Shake of fixed cameras during a take: in pixels, and in millimetres at the player."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from courtside.figures.style import style
from courtside.geometry.camera import Camera
from courtside.reconstruction import camera_shake

PANEL_MM, MARGIN_MM = 38, 8
LEAST_RANGE_PX = 0.5  # of an axis: a camera that stands still is drawn so
NAMED = 2  # knocks in a panel's title
AXES = {"shift_x_px": (style.CYCLE[0], "right"), "shift_y_px": (style.CYCLE[1], "down")}


def table(
    cameras: dict[str, Camera], shakes: dict[str, pd.DataFrame], xyz: NDArray
) -> pd.DataFrame:
    """Return the numbers drawn, one row per camera and frame.

    `shift_mm` is at the player `xyz`, (3,) m in the world, NaN if unknown. `shakes` are of
    `courtside.records.cameras.shake_table`, for each camera to draw.
    """
    parts = []
    for name, shake in shakes.items():
        part = shake.assign(camera=name, shift_mm=camera_shake.mm_at(cameras[name], xyz, shake))
        part[["knock_px", "knock_deg"]] = np.nan
        for knock in camera_shake.find(cameras[name], shake):
            values = np.hypot(*knock.shift_px), knock.turn_deg
            part.loc[part.time_s == knock.time_s, ["knock_px", "knock_deg"]] = values
        parts.append(part)
    rows = pd.concat(parts, ignore_index=True)
    first = ["camera", "frame_idx", "time_s", "shift_x_px", "shift_y_px", "rotation_deg"]
    last = ["sigma_px", "n_matches", "shift_mm", "knock_px", "knock_deg"]
    return rows[[*first, "zoom_percent", *last]]


def draw(rows: pd.DataFrame) -> Figure:
    """Draw the shift of each camera's picture over time, in px (left) and mm at the player."""
    groups = list(rows.groupby("camera", sort=False))
    drawing = style.figure(PANEL_MM * len(groups) + MARGIN_MM)
    panels = drawing.subplots(len(groups), 1, sharex=True, squeeze=False)[:, 0]
    for panel, (name, part) in zip(panels, groups, strict=True):
        _draw_panel(panel, name, part)
    panels[0].legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, borderaxespad=0)
    panels[-1].set_xlabel("time on the camera's own clock (s)")
    return drawing


def _draw_panel(axis: Axes, name: str, part: pd.DataFrame) -> None:
    for column, (colour, label) in AXES.items():
        axis.plot(part.time_s, part[column], color=colour, linewidth=0.8, label=label)
    known = part[list(AXES)].to_numpy()
    known = known[np.isfinite(known)]
    low, high = (known.min(), known.max()) if known.size else (0.0, 0.0)
    room = max(LEAST_RANGE_PX - (high - low), 0.15 * (high - low)) / 2
    axis.set_ylim(low - room, high + room)
    axis.set(ylabel="shift (px)")
    axis.set_title(f"{name}: {_summary(part, known)}", loc="left")
    for _, knock in part[part.knock_px.notna()].iterrows():
        axis.axvline(knock.time_s, color=style.MIDDLE, linewidth=0.8, linestyle="--")
    _draw_mm(axis, part)


def _draw_mm(axis: Axes, part: pd.DataFrame) -> None:
    """Give the panel a right axis in mm at the player."""
    shift_px = np.hypot(part.shift_x_px, part.shift_y_px)
    seen = np.isfinite(part.shift_mm) & (shift_px > 0)
    if not seen.any():
        return
    scale = part.shift_mm[seen].sum() / shift_px[seen].sum()
    right = axis.secondary_yaxis("right", functions=(lambda px: px * scale, lambda mm: mm / scale))
    right.set_ylabel("at the player (mm)")


def _summary(part: pd.DataFrame, known: NDArray) -> str:
    if not known.size:
        return "too little background seen"
    spells = part.groupby(part.knock_px.notna().cumsum())[list(AXES)]
    off = spells.transform(lambda x: x - x.median()).to_numpy()
    words = [f"{np.sqrt(np.nanmean(off**2)):.2f} px rms"]
    missing = int(part.shift_x_px.isna().sum())
    if missing:
        words.append(f"{missing} of {len(part)} frames unknown")
    hits = part[part.knock_px.notna()]
    for _, knock in hits[:NAMED].iterrows():
        size = f"{knock.knock_px:.2g} px, {knock.knock_deg:.2g}°"
        words.append(f"knocked at {knock.time_s:.1f} s ({size})")
    if len(hits) > NAMED:
        words.append(f"and {len(hits) - NAMED} more times")
    return "; ".join(words)
