"""The network's confidence over time, and the number of views behind each joint."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from numpy.typing import NDArray

from courtside.figures.style import style, windows
from courtside.records.cameras.footage import Footage
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.records.keypoints.skeleton import Skeleton

A_ROW = 6  # cameras in the legend


def scores(one: Footage, time_s: NDArray) -> NDArray:
    """Return a camera's scores (P, T, J) in the frames nearest to times (T,) of a take.

    NaN where the camera does not film.
    """
    at = one.frames_at(time_s)
    return np.where((at >= 0)[:, None], one.view.score[:, at], np.nan)


def table(points: Keypoints3D, scores: Mapping[str, NDArray]) -> pd.DataFrame:
    """Return scores and numbers of views over time; empty if a camera saw nothing.

    `scores` (P, T, J) are of each camera at the times of the points. Of a take of minutes, all are
    means of windows.
    """
    time_s, drawn = points.time_s, {"n_views": points.n_views}
    drawn |= {f"score_{camera}": score for camera, score in scores.items()}
    if window_s := windows.length_s(time_s):
        by = windows.middles(time_s, time_s[0], window_s)
        time_s = np.unique(by)
        drawn = {name: _means(values, by == time_s[:, None]) for name, values in drawn.items()}
    n_persons, n_frames, n_joints = drawn["n_views"].shape
    columns = {
        "time_s": np.tile(np.repeat(time_s, n_joints), n_persons),
        "person": np.repeat(points.person_id, n_frames * n_joints),
        "joint": np.tile(points.joints, n_persons * n_frames),
    }
    columns |= {name: values.ravel() for name, values in drawn.items()}
    return pd.DataFrame(columns)


def _means(values: NDArray, inside: NDArray) -> NDArray:
    """Return the means (P, W, J) of what is known of values (P, T, J) in windows (W, T)."""
    each = np.ma.masked_invalid(values)
    return np.ma.stack([each[:, at].mean(axis=1) for at in inside], axis=1).filled(np.nan)


def draw(rows: pd.DataFrame, skeleton: Skeleton) -> Figure:
    """Draw the table of `table`: one line panel of scores, one picture of view counts."""
    joints = list(skeleton.joints)
    drawing = style.figure(60 + 3.0 * len(joints))
    upper, lower = drawing.subplots(2, 1, sharex=True, height_ratios=[1, 0.07 * len(joints) + 0.6])
    limbs = rows[rows.joint.isin(skeleton.groups["limbs"])]
    names = [name for name in rows.columns if name.startswith("score_")]
    for at, name in enumerate(names):
        mean = limbs.groupby("time_s")[name].mean()
        label = name.removeprefix("score_")
        upper.plot(mean.index, mean, **style.line_look(at), linewidth=1, label=label)
    upper.set(ylabel="mean score", ylim=(0, 1.02))
    upper.set_title("Confidence of the network, mean over the 12 limb joints")
    drawing.legend(loc="outside upper right", ncols=min(len(names), A_ROW))
    counts = rows.groupby(["joint", "time_s"]).n_views.min().unstack().loc[joints]
    times = counts.columns.to_numpy()
    step = np.median(np.diff(times)) if len(times) > 1 else 1.0
    extent = (times[0] - step / 2, times[-1] + step / 2, len(joints) - 0.5, -0.5)
    look = {"aspect": "auto", "cmap": "viridis", "interpolation": "nearest"}
    image = lower.imshow(counts, extent=extent, vmin=0, vmax=len(names), **look)
    lower.set(yticks=range(len(joints)), yticklabels=[joint.replace("_", " ") for joint in joints])
    lower.tick_params(axis="y", labelsize=6)
    least = "" if rows.person.nunique() < 2 else ", least of all persons"
    means = f": means of each {step:g} s" if step >= windows.LENGTHS_S[0] else ""
    lower.set_title(f"Views that each joint rests on (0: missing){least}")
    lower.set_xlabel(f"time (s){means}")
    drawing.colorbar(image, ax=lower, ticks=range(len(names) + 1), label="views", pad=0.01)
    return drawing
