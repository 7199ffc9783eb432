"""The paper's table 1 as it was measured, and what its protocol misses: four rows per joint."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from courtside.figures.style import bars, style

ALL = "all"
PANELS = (  # rows of the table, title
    (("rounded", "rounded_published"), "B  round trip, rounded (mm)"),
    (("reprojection", "left_out"), "C  detection to reprojection (px)"),
    (("truth",), "D  distance to the truth (mm)"),
)
HOLLOW = ("rounded_published", "left_out")
COLOURS = style.CYCLE[:5]
SPREAD = 0.62  # of the distance between joints that the marks of one joint share
WIDE = 20.0  # a panel whose means differ by more is logarithmic
LEGEND = (
    "filled: the picture's own pixels (B), views used (C); "
    "hollow: pixels of the published width (B), views left out (C)"
)


def table(rows: pd.DataFrame, published: pd.DataFrame) -> pd.DataFrame:
    """Put the published values beside the rows of the first person.

    The columns stay the same; published rows have `published` as row, no person and 2 cameras.
    Joints are in the published order, others follow, and `all` is last. `rows` are of
    `courtside.evaluation.round_trip.table`, for one or more sets of cameras; `published` has joint,
    mean_mm, sd_mm, n_frames, source.
    """
    own = rows[rows["person"] == rows["person"].iloc[0]]
    names = {"source": "cameras", "mean_mm": "mean", "sd_mm": "sd", "n_frames": "n"}
    theirs = published.rename(columns=names)[["joint", *names.values()]]
    theirs = theirs.assign(person="", n_cameras=2, row="published", unit="mm")
    theirs["over"] = theirs["n"].map("{} frames".format)
    means = theirs.iloc[:1].assign(
        joint=ALL,
        mean=theirs["mean"].mean(),
        sd=theirs["sd"].mean(),
        n=len(theirs),
        over=f"joints, each: {theirs['over'].iloc[0]}",
    )
    whole = pd.concat([own, theirs, means], ignore_index=True)
    order = [*published["joint"], *(j for j in own["joint"].unique() if j != ALL), ALL]
    place = whole["joint"].map({joint: at for at, joint in reversed(list(enumerate(order)))})
    return whole.iloc[np.argsort(place, kind="stable")].reset_index(drop=True)


def draw(rows: pd.DataFrame, title: str = "") -> Figure:
    """Draw the table of `table`: means with standard deviations, a panel for each row B, C, D."""
    joints = list(dict.fromkeys(rows["joint"]))
    sets = rows.loc[rows["row"] == "exact", ["n_cameras", "cameras"]].drop_duplicates()
    sets = list(sets.sort_values("n_cameras", kind="stable").itertuples(index=False, name=None))
    drawing = style.figure(42 + 5.6 * len(joints))
    axes = drawing.subplots(1, len(PANELS), sharey=True)
    for axis, (names, heading) in zip(axes, PANELS, strict=True):
        for name in names:
            for at, (_, cameras) in enumerate(sets):
                part = rows[(rows["row"] == name) & (rows["cameras"] == cameras)]
                shift = SPREAD * ((at + 0.5) / len(sets) - 0.5)
                _marks(axis, part, joints, shift, COLOURS[at % len(COLOURS)], name not in HOLLOW)
        axis.set_title(heading)
        axis.grid(axis="x")
    theirs = rows[rows["row"] == "published"].set_index("joint").reindex(joints)
    place = np.arange(len(joints)) - SPREAD / 2 - 0.08
    look = {"fmt": "*", "color": "black", "markersize": 5, "linewidth": 0.8}
    axes[0].errorbar(theirs["mean"], place, xerr=theirs["sd"], **look)
    for axis, (names, _) in zip(axes, PANELS, strict=True):
        _scale(axis, rows.loc[rows["row"].isin(names), "mean"])
    if rows.loc[rows["row"] == "truth", "mean"].isna().all():
        words = "no truth:\na real session"
        axes[-1].text(0.5, 0.5, words, transform=axes[-1].transAxes, ha="center")
        axes[-1].set_xticks([])
    bars.name_rows(axes[0], joints)
    _explain(drawing, axes[0], sets)
    exact = rows.loc[(rows["row"] == "exact") & (rows["joint"] != ALL), "mean"].max()
    identity = f"0 mm (largest mean of a joint {exact:.0e} mm): it is an identity"
    drawing.suptitle(f"{title}\nA  exact round trip: {identity}".strip(), fontsize=8)
    return drawing


def _marks(
    axis: Axes, part: pd.DataFrame, joints: list[str], shift: float, colour: str, filled: bool
) -> None:
    part = part.set_index("joint").reindex(joints)
    look = {"fmt": "o", "color": colour, "markersize": 3, "linewidth": 0.8 if filled else 0.4}
    look["markerfacecolor"] = colour if filled else "white"
    place = np.arange(len(joints)) + shift + (0.0 if filled else 0.07)
    axis.errorbar(part["mean"], place, xerr=part["sd"], **look)


def _scale(axis: Axes, means: pd.Series) -> None:
    if means.max() > WIDE * means[means > 0].min():
        axis.set_xlim(left=0.5 * means[means > 0].min())
        bars.plain_log(axis, "x")
    else:
        axis.set_xlim(left=0)


def _explain(drawing: Figure, axis: Axes, sets: list[tuple[int, str]]) -> None:
    marks = [
        axis.errorbar([], [], xerr=[], fmt="o", color=COLOURS[at % len(COLOURS)], markersize=3)
        for at in range(len(sets))
    ]
    names = [f"{count} cameras: {cameras.replace('+', ', ')}" for count, cameras in sets]
    marks.append(axis.errorbar([], [], xerr=[], fmt="*", color="black", markersize=5))
    names.append("published, 2 cameras")
    look = {"title": LEGEND, "title_fontsize": 7, "fontsize": 7}
    drawing.legend(marks, names, loc="outside lower center", ncols=2, **look)
