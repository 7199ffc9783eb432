"""Where the network places the joints: layout a against layout b, camera by camera.

The counterpart of [Shishido2020, fig 5], one picture of layout a in which the network worked.
"""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from courtside.evaluation.tables import calibration
from courtside.figures.style import bars, picture_crops, style
from courtside.records.keypoints.keypoints import Keypoints2D
from courtside.statistics import autocorrelation

# By name session, take and the cameras that reconstruct together.
Layouts = Mapping[str, tuple[str, str, Sequence[str]]]
ALL, STROKE, TOGETHER = "all joints", "all joints, stroke", "together"
POSE_S = 0.2  # ASSUME: duration of a pose, whose frames count as one trial
KEY = ["person", "camera", "frame_idx"]
COLUMNS = [
    "layout", "session", "take", "model", "camera", "joint", "n_frames", "n_effective", "share",
    "low", "high", "exchanged_share", "median_error_torso",
]  # fmt: skip
ASPECT = 0.8  # width over height of an example
SPREAD = 0.6  # of the distance between joints, for the cameras' marks
SHARES_MM, EXAMPLE_MM = 96, 56
HEAD = 0.7  # the top of the head lies above the shoulders, in lengths of the torso


def table(rows: pd.DataFrame, layouts: Layouts) -> pd.DataFrame:
    """Return the share of frames in which the joints are placed, for each camera and joint.

    Over the frames in whose picture all the person's joints lie; the 95 % interval is Wilson's, on
    the effective number of frames. Joint ALL: all joints in one frame; STROKE: the same in the
    frames of a stroke. Camera TOGETHER: all joints in all cameras of the layout at the same time.
    `rows` are of `courtside.evaluation.detection.evaluate`, with session, take and model.
    """
    found = []
    for layout, (session, take, cameras) in layouts.items():
        part = rows[(rows.session == session) & (rows["take"] == take)]
        if part.empty:
            continue
        labels = {"layout": layout, **part.iloc[0][["session", "take", "model"]]}
        part = part[part.groupby(KEY).in_picture.transform("all")]
        times_s = np.unique(part[part.camera.isin(part.camera[:1])].time_s)
        step_s = float(np.median(np.diff(times_s))) if len(times_s) > 1 else POSE_S
        spans = {ALL: part, STROKE: part[part.in_stroke]}
        for camera, own in part.groupby("camera", sort=False):
            for joint, span in spans.items():
                whole = span[span.camera == camera].groupby(KEY[::2]).placed.all()
                stats = autocorrelation.share(whole.to_numpy(), POSE_S / step_s)
                found.append({**labels, "camera": camera, "joint": joint, **stats})
            for joint, seen in own.groupby("joint", sort=False):
                stats = autocorrelation.share(seen.placed.to_numpy(), POSE_S / step_s)
                stats["exchanged_share"] = seen.exchanged.mean()
                stats["median_error_torso"] = seen.error_torso.median()
                found.append({**labels, "camera": camera, "joint": joint, **stats})
        for joint, span in spans.items():
            stats = autocorrelation.share(together(span, cameras, step_s), POSE_S / step_s)
            found.append({**labels, "camera": TOGETHER, "joint": joint, **stats})
    return pd.DataFrame(found, columns=COLUMNS)


def together(rows: pd.DataFrame, cameras: Sequence[str], step_s: float) -> NDArray:
    """Return in which frames of the first camera all cameras place all joints, (n,) bool.

    Frames of two cameras less than half of `step_s` apart are paired; others are left out. So are
    persons whom one of the cameras never shows.
    """
    whole = rows.groupby(["person", "camera", "frame_idx"]).agg(
        time_s=("time_s", "first"), placed=("placed", "all")
    )
    parts, there = [], set(whole.index.droplevel("frame_idx"))
    for person in rows.person.unique():
        if not there.issuperset((person, name) for name in cameras):
            continue
        first = whole.loc[(person, cameras[0])].sort_values("time_s")
        for name in cameras[1:]:
            other = whole.loc[(person, name)].sort_values("time_s")
            first = pd.merge_asof(
                first, other, on="time_s", direction="nearest", tolerance=step_s / 2,
                suffixes=("", "_other"),
            ).dropna()  # fmt: skip
            first["placed"] &= first.pop("placed_other").astype(bool)
        parts.append(first.placed.to_numpy(dtype=bool))
    return np.concatenate(parts) if parts else np.zeros(0, dtype=bool)


def examples(rows: pd.DataFrame, layouts: Layouts) -> list[dict]:
    """Choose for each layout a frame in which the network works and one in which it does not.

    Both are of the layout's camera that places all joints least often. Works: of the frames with
    the most joints placed, the one whose worst joint is the median one. Does not: the fewest joints
    placed, of several the largest mean error. Keys: layout, session, take, camera, person,
    frame_idx, works (bool), rows (of that frame).
    """
    found = []
    for layout, (session, take, cameras) in layouts.items():
        of_take = (rows.session == session) & (rows["take"] == take)
        part = rows[of_take & rows.camera.isin(cameras) & rows.found]
        frames = part.groupby(KEY, sort=False).agg(
            count=("placed", "sum"), worst=("error_torso", "max"), mean=("error_torso", "mean")
        )
        if not len(frames):
            continue
        full = frames["count"] == frames["count"].max()
        camera = full.groupby("camera").mean().reindex(cameras).idxmin()
        frames = frames.xs(camera, level="camera")
        best = frames[frames["count"] == frames["count"].max()].sort_values("worst")
        bad = frames[frames["count"] == frames["count"].min()].sort_values("mean")
        for works, (person, frame) in ((True, best.index[len(best) // 2]), (False, bad.index[-1])):
            where = {"camera": camera, "person": person, "frame_idx": int(frame)}
            one = {"works": works, "rows": calibration.pick(part, **where)}
            found.append({"layout": layout, "session": session, "take": take, **where, **one})
    return found


def person_of(example: dict, view: Keypoints2D) -> NDArray:
    """Return the joints (1, J, 2) px of the tracklet that an example of `examples` shows.

    Other tracklets of its camera's `view` may be of people who did not agree to pictures.
    """
    rows, names = example["rows"], list(map(str, view.joints))
    places = [names.index(joint) for joint in rows["joint"]]
    every = view.xy[:, example["frame_idx"]]
    off = np.linalg.norm(every[:, places] - rows[["x_px", "y_px"]].to_numpy(), axis=2)
    return every[[int(np.nan_to_num(off, nan=np.inf).min(axis=1).argmin())]]


def draw(
    shares_of: pd.DataFrame,
    layouts: Layouts,
    chosen: list[dict],
    images: list[NDArray],
    bones: Sequence[tuple[str, str]],
) -> Figure:
    """Draw the shares of both layouts (`table`) above, examples (`examples`) below.

    `images` (H, W, 3) are those of the examples, BGR, with faces hidden if asked for; a line joins
    the joints of a bone.
    """
    heights = SHARES_MM, EXAMPLE_MM + 18
    drawing = style.figure(sum(heights))
    upper, lower = drawing.subfigures(2, 1, height_ratios=heights)
    axes = upper.subplots(1, len(layouts), sharex=True, sharey=True, squeeze=False)[0]
    for axis, (layout, (*_, cameras)) in zip(axes, layouts.items(), strict=True):
        _draw_shares(axis, shares_of[shares_of.layout == layout], cameras)
        axis.set_title(f"Layout {layout}")
    if chosen:
        axes = lower.subplots(1, len(chosen), squeeze=False)[0]
        for axis, example, image in zip(axes, chosen, images, strict=True):
            _draw_example(axis, example, image, bones)
        _explain(lower)
    return drawing


def _draw_shares(axis: Axes, part: pd.DataFrame, cameras: Sequence[str]) -> None:
    joints = [joint for joint in dict.fromkeys(part.joint) if joint not in (ALL, STROKE)]
    joints = [ALL, *([STROKE] if part[part.joint == STROKE].n_frames.any() else []), *joints]
    others = [c for c in dict.fromkeys(part.camera) if c not in (*cameras, TOGETHER)]
    names = [*cameras, *others, TOGETHER]
    for at, name in enumerate(names):
        own = part[part.camera == name].set_index("joint").reindex(joints)
        place = np.arange(len(joints)) + SPREAD * ((at + 0.5) / len(names) - 0.5)
        colour = "black" if name == TOGETHER else style.CYCLE[at]
        face = "white" if name in others else colour
        share = 100 * own[["low", "share", "high"]].to_numpy()
        label = " + ".join(cameras) if name == TOGETHER else name
        axis.hlines(place, share[:, 0], share[:, 2], color=colour, linewidth=1.0)
        look = {"color": colour, "markerfacecolor": face, "markersize": 3.5, "label": label}
        axis.plot(share[:, 1], place, "D" if name == TOGETHER else "o", **look)
    axis.axhspan(
        -0.5, joints.index(STROKE) + 0.5 if STROKE in joints else 0.5, color="#eeeeee", zorder=0
    )
    bars.name_rows(axis, joints)
    axis.set(xlim=(-2, 102), xlabel="placed in % of the frames (95 % interval)")
    axis.grid(axis="x")
    axis.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=3, fontsize=7)


def _draw_example(
    axis: Axes, example: dict, image: NDArray, bones: Sequence[tuple[str, str]]
) -> None:
    rows = example["rows"].set_index("joint")
    detected, true = rows[["x_px", "y_px"]].to_numpy(), rows[["true_x_px", "true_y_px"]].to_numpy()
    middle = [
        rows.loc[[f"left_{part}", f"right_{part}"], ["true_x_px", "true_y_px"]].mean().to_numpy()
        for part in ("shoulder", "hip")
    ]
    head = middle[0] + HEAD * (middle[0] - middle[1])
    part = picture_crops.box(np.vstack([detected, true, head]), image.shape[1::-1], ASPECT)
    picture_crops.show(axis, image, part)
    at = {joint: index for index, joint in enumerate(rows.index)}
    pairs = [(at[start], at[stop]) for start, stop in bones if start in at and stop in at]
    picture_crops.sticks(axis, detected, pairs, picture_crops.DETECTED)
    missed = ~rows.placed.to_numpy()
    for ends in np.stack([detected, true], axis=1)[missed]:
        axis.plot(*ends.T, "--", color=picture_crops.MARKED, linewidth=1.0)
        axis.plot(*ends[1], "+", color="white", markersize=6, markeredgewidth=1.4, zorder=5)
    picture_crops.rings(axis, detected[missed], size=7)
    axis.set_title(f"{example['layout']}: {example['camera']}, {rows.time_s.iloc[0]:.2f} s")
    axis.set_xlabel(f"{int((~missed).sum())} of {len(rows)} placed")


def _explain(part: FigureBase) -> None:
    ring = {"marker": "o", "markerfacecolor": "none", "markersize": 7, "linestyle": "--"}
    handles = [
        Line2D([], [], color=picture_crops.DETECTED, linewidth=2.5),
        Line2D([], [], color=picture_crops.MARKED, linewidth=1.0, **ring),
        Line2D(
            [], [], color="#777777", marker="+", markersize=6, markeredgewidth=1.4, linestyle=""
        ),
    ]
    words = ["detected", "not placed", "where it really is (white)"]
    part.legend(handles, words, loc="outside lower center", ncols=3)
