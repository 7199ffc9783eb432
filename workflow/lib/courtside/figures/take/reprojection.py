"""Distances of the cameras' keypoints from the projected 3D skeleton, per joint and camera."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from courtside.figures.style import bars, style
from courtside.records.keypoints.keypoints import Keypoints3D

SMALLEST_PX = 0.1  # where the logarithmic axis begins
MOST_NUMBERS = 5  # on the axis of a narrow panel


def table(points: Keypoints3D) -> pd.DataFrame:
    """Return the statistics of reprojection errors, of all and of the accepted ones."""
    rows = []
    for at, joint in enumerate(points.joints):
        for view, camera in enumerate(points.cameras):
            error = points.reproj_error_px[:, :, at, view].ravel()
            known = np.isfinite(error)
            used = error[known & points.accepted[:, :, at, view].ravel()]
            every, accepted = pd.Series(error[known]), pd.Series(used)
            spread = *every.quantile([0.05, 0.5, 0.95]), every.mean(), accepted.median()
            rows.append((joint, camera, len(every), len(accepted), *spread))
    names = ["p05_px", "median_px", "p95_px", "mean_px", "accepted_median_px"]
    return pd.DataFrame(rows, columns=["joint", "camera", "n", "n_accepted", *names])


def draw(rows: pd.DataFrame) -> Figure:
    """Draw the table of `table`: medians with 5-95 % ranges, one panel per camera."""
    cameras, joints = list(dict.fromkeys(rows.camera)), list(dict.fromkeys(rows.joint))
    lines, columns = style.wrapped(len(cameras))
    drawing = style.figure(12 + (18 + 3.6 * len(joints)) * lines)
    axes = drawing.subplots(lines, columns, sharey=True, sharex=True, squeeze=False).ravel()
    for axis, camera in zip(axes, cameras, strict=False):
        _draw_camera(axis, camera, rows[rows.camera == camera].set_index("joint").loc[joints])
    for axis in axes[len(cameras) :]:
        axis.remove()
    for axis in axes[: len(cameras)][-columns:]:
        axis.tick_params(labelbottom=True)
        axis.set_xlabel("reprojection error (px)")
    bars.name_rows(axes[0], joints)
    bars.plain_log(axes[0], "x")
    # By its own choice matplotlib leaves out 1 and 10 px, between which most errors are.
    axes[0].xaxis.set_major_locator(LogLocator(numticks=MOST_NUMBERS))
    axes[0].xaxis.set_minor_formatter(NullFormatter())
    if rows.median_px.max() > SMALLEST_PX:
        axes[0].set_xlim(left=SMALLEST_PX)
    handles, labels = axes[0].get_legend_handles_labels()
    drawing.legend(handles, labels, loc="outside lower center", ncols=3)
    return drawing


def _draw_camera(axis: Axes, camera: str, part: pd.DataFrame) -> None:
    place = np.arange(len(part))
    share = part.n_accepted.sum() / max(part.n.sum(), 1)
    look = {"color": "#999999", "linewidth": 1.2, "label": "5-95 % of all"}
    axis.hlines(place, part.p05_px, part.p95_px, **look)
    look = {"color": style.RIGHT, "markersize": 3, "label": "median of all"}
    axis.plot(part.median_px, place, "o", **look)
    look = {"color": style.LEFT, "markersize": 7, "label": "median of accepted"}
    axis.plot(part.accepted_median_px, place, "|", **look)
    axis.set_title(f"{camera}: {100 * share:.0f} % accepted")
    axis.grid(axis="x")
