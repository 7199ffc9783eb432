"""Joints as detected and as reprojected from the 3D skeleton: where the two disagree.

The counterpart of [Shishido2020, fig 11], with the limbs that disagree marked by rule.
"""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from courtside.evaluation import detection
from courtside.figures.style import picture_crops, style
from courtside.figures.style.stick_figure import Stick
from courtside.geometry.camera import Camera
from courtside.records.cameras.footage import Footage
from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.keypoints import Keypoints3D

WIDEST_MM = 62  # of a panel
ASPECT = 0.75  # width over height of a panel
LINE = 1.4  # points, in the widest panel
LISTED = 3  # joints named below a panel
FEW = 0.5  # of the most frames with both: a joint with fewer is shown with their number
PIXELS = ("detected_x_px", "detected_y_px", "reprojected_x_px", "reprojected_y_px")


def disagreements(
    points: Keypoints3D, cameras: list[Camera], joints: Sequence[str], limit_torso: float
) -> tuple[NDArray, NDArray, NDArray]:
    """Return where a camera's keypoint does not fit the 3D joint: disagrees, known, limit.

    disagrees (P, T, K, C) bool: the reprojection error is above the limit (P, C) px; known
    (P, T, K, C) bool: both the keypoint and the 3D joint are known.

    `cameras` are those of `points`, in its order, and `joints` K of its joints. `limit_torso` is a
    share of the length of the person's torso in that camera's picture (its median over the take).
    """
    at = [list(points.joints).index(joint) for joint in joints]
    torso = [detection.torso_px(camera, points.joints, points.xyz) for camera in cameras]
    limit_px = limit_torso * np.nanmedian(torso, axis=-1).T
    error = points.reproj_error_px[:, :, at]
    with np.errstate(invalid="ignore"):
        return error > limit_px[:, None, None], np.isfinite(error), limit_px


def choose(disagrees: NDArray, frames: slice) -> int:
    """Return the frame of a slice in which most joints disagree; the first of several."""
    return frames.start + int(disagrees[:, frames].sum(axis=(0, 2, 3)).argmax())


def table(
    points: Keypoints3D,
    footage: list[Footage],
    joints: Sequence[str],
    mirror: Sequence[int],
    frame: int,
    limit: tuple[NDArray, NDArray, NDArray],
) -> pd.DataFrame:
    """Return the joints of one frame in every camera, and how often they disagree in the take.

    `footage` is of the cameras of `points`, in its order; `mirror` holds for each joint of `points`
    the index of the same one on the other body side; `limit` is of `disagreements`, for these
    joints.

    For each person, camera and joint the detected pixel in the camera's nearest frame (with sides
    as the fusion used them) and the projection of the 3D joint; error_px as the fusion measured it
    at the frame's time; then of the whole take the frames with both and the share in which they
    disagree.
    """
    disagrees, known, limit_px = limit
    at = [list(points.joints).index(joint) for joint in joints]
    parts = []
    for camera, one in enumerate(footage):
        raw, reprojected = picture_crops.joints_at(one, points, frame)
        seen = picture_crops.as_fused(points, frame, one.camera.name, raw, mirror)
        for person, name in enumerate(points.person_id):
            both = known[person, :, :, camera].sum(axis=0)
            percent = 100 * disagrees[person, :, :, camera].sum(axis=0) / np.maximum(both, 1)
            drawn = np.column_stack([seen[person], reprojected[person]])[at]
            columns = {
                "time_s": points.time_s[frame],
                "person": str(name),
                "camera": one.camera.name,
                "joint": list(joints),
                **dict(zip(PIXELS, drawn.T, strict=True)),
                "sides_exchanged": points.swapped[person, frame, at, camera],
                "error_px": points.reproj_error_px[person, frame, at, camera],
                "limit_px": limit_px[person, camera],
                "accepted": points.accepted[person, frame, at, camera],
                "disagrees": disagrees[person, frame, :, camera],
                "reason": [missing_reason.WORDS[int(c)] for c in points.reason[person, frame, at]],
                "take_frames": both,
                "take_disagree_percent": np.where(both > 0, percent, np.nan),
            }
            parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)


def draw(
    rows: pd.DataFrame,
    images: dict[str, NDArray],
    detected: dict[str, NDArray],
    reprojected: dict[str, NDArray],
    stick: Stick,
    limit_torso: float,
) -> Figure:
    """Draw every camera's picture of the persons, and below how often joints disagree in the take.

    `rows` are of `table`; `images` (H, W, 3) are BGR by camera, with faces hidden if asked for;
    `detected` and `reprojected` are the joints (P, K, 2) px of the stick figure by camera.
    """
    names, n_rows = list(images), rows.groupby(["person", "camera"], sort=False).ngroups
    width = min(style.WIDTH_MM / len(names), WIDEST_MM)
    heights = width / ASPECT + 27, 21 + 5.5 * n_rows
    drawing = style.figure(sum(heights))
    upper, lower = drawing.subfigures(2, 1, height_ratios=heights)
    axes = upper.subplots(1, len(names), squeeze=False)[0]
    line = LINE * np.sqrt(width / WIDEST_MM)
    for axis, name in zip(axes, names, strict=True):
        both, size = (detected[name], reprojected[name]), images[name].shape[1::-1]
        picture_crops.show(axis, images[name], picture_crops.box(both, size, ASPECT))
        picture_crops.compare(axis, *both, stick.bones, line)
        axis.set_title(name)
        if images[name].size:
            _mark(axis, rows[(rows.camera == name) & rows.disagrees], 7 * line)
    upper.legend(*_legend(limit_torso, line), loc="outside lower center", ncols=3)
    upper.suptitle(f"frame at {rows.time_s.iloc[0]:.2f} s", fontsize=8)
    _draw_shares(lower, rows)
    return drawing


def _mark(axis: Axes, marked: pd.DataFrame, size: float) -> None:
    for row in marked.itertuples():
        ends = np.array([[getattr(row, key) for key in PIXELS[at : at + 2]] for at in (0, 2)])
        axis.plot(*ends.T, "--", color=picture_crops.MARKED, linewidth=1.0, zorder=4)
        picture_crops.rings(axis, ends[:1], size=size)
    worst = marked.sort_values("error_px", ascending=False)
    lines = [f"{row.joint.replace('_', ' ')} {row.error_px:.0f} px" for row in worst.itertuples()]
    more = [f"and {len(lines) - LISTED} more"] if len(lines) > LISTED else []
    look = {"fontsize": 7, "color": "#c00000" if lines else "black"}
    axis.set_xlabel("\n".join([*lines[:LISTED], *more]) or "none above the limit", **look)


def _legend(limit_torso: float, line: float) -> tuple[list[Line2D], list[str]]:
    look = {"color": picture_crops.MARKED, "linestyle": "--", "marker": "o"}
    look["markerfacecolor"] = "none"
    handles = [
        Line2D([], [], color=picture_crops.DETECTED, linewidth=3),
        Line2D([], [], color=picture_crops.REPROJECTED, linewidth=1.5, marker="o", markersize=3),
        Line2D([], [], linewidth=1.0, markersize=7 * line, **look),
    ]
    limit = f"apart by more than {100 * limit_torso:.0f} % of the torso"
    return handles, ["detected", "3D skeleton, reprojected", limit]


def _draw_shares(part: FigureBase, rows: pd.DataFrame) -> None:
    axis, several = part.subplots(), rows.person.nunique() > 1
    joints = list(dict.fromkeys(rows.joint))
    rows = rows.assign(where=rows.camera + (", " + rows.person if several else ""))
    shares = rows.pivot(index="where", columns="joint", values="take_disagree_percent")
    shares = shares.loc[list(dict.fromkeys(rows["where"])), joints]
    known = rows.pivot(index="where", columns="joint", values="take_frames")
    known = known.loc[shares.index, joints].to_numpy()
    axis.imshow(shares, aspect="auto", cmap="Reds", vmin=0, vmax=100)
    for (y, x), value in np.ndenumerate(shares.to_numpy()):
        colour = "white" if value > 60 else "black"
        few = f" ({known[y, x]})" if known[y, x] < FEW * known.max() else ""
        text = "–" if np.isnan(value) else f"{value:.0f}{few}"
        axis.text(x, y, text, ha="center", va="center", fontsize=7, color=colour)
    axis.set_xticks(range(len(joints)), [name.replace("_", "\n") for name in joints], fontsize=7)
    axis.set_yticks(range(len(shares)), shares.index, fontsize=7)
    axis.tick_params(length=0)
    axis.spines[:].set_visible(False)
    words = "The whole take: of the frames with both, in how many percent they are so far apart"
    axis.set_title(words)
