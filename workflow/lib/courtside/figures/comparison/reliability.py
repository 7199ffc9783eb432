"""Reliability of the stated errors of joints: nominal share against held share."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from courtside.evaluation import reliability
from courtside.evaluation.tables import players
from courtside.figures.style import style

ROWS = {"joint": "by joint", "views": "by number of views", "error": "by size of the error (mm)"}
WORDS = {"0": "below 50", "50": "50 to 100", "100": "100 to 300", "300": "above 300"}
WAY = ["calibration", "model"]
EVERY = "all"  # the label of all sessions together


def table(rows: pd.DataFrame) -> pd.DataFrame:
    """Add up the tables of `evaluate_reliability` by session and way, and over all sessions.

    A way is a calibration and a network. Shares in percent (`evaluation.reliability.pooled`), by
    session, way, stage and group. The session `EVERY`, without a way, counts each session by the
    way of its first row: the others are of the same joints.
    """
    one = reliability.pooled(rows, ["session", *WAY, "stage"])
    first = (rows[WAY] == rows.groupby("session")[WAY].transform("first")).all(axis=1)
    together = reliability.pooled(rows[first].assign(session=EVERY), ["session", "stage"])
    return pd.concat([together, one], ignore_index=True)


def draw(rows: pd.DataFrame) -> Figure:
    """Draw the table of `table`: a column for each stage, a row for each way to group."""
    stages = [stage for stage in players.STAGES if stage in set(rows["stage"])]
    drawing = style.figure(175)
    axes = drawing.subplots(len(ROWS), len(stages), sharex=True, sharey=True, squeeze=False)
    for (by, words), line in zip(ROWS.items(), axes, strict=True):
        for stage, axis in zip(stages, line, strict=True):
            _panel(axis, rows[rows["stage"] == stage], by)
            if by == "joint":
                axis.set_title(_title(rows[rows["stage"] == stage], stage))
            if by == "error":
                axis.set_xlabel("nominal share (%)")
        line[0].set_ylabel(f"{words}\nheld share (%)")
        line[-1].legend(loc="upper left", fontsize=6, bbox_to_anchor=(1, 1))
    return drawing


def _panel(axis: Axes, rows: pd.DataFrame, by: str) -> None:
    together = rows[rows["session"] == EVERY]
    axis.plot([0, 100], [0, 100], color="#999999", linewidth=0.6)
    if by == "joint":
        single = rows[(rows["session"] != EVERY) & (rows["by"] == "all")]
        for _, whole in single.groupby(["session", *WAY]):
            axis.plot(reliability.LEVELS, _held(whole), color="#cccccc", linewidth=0.8)
    axis.plot(reliability.LEVELS, _held(together[together["by"] == "all"]), "k-", label="all")
    groups = together[together["by"] == by].sort_values("group", key=_order)
    for colour, (_, row) in zip(style.CYCLE, groups.iterrows(), strict=False):
        label = f"{WORDS.get(row['group'], row['group']) if by == 'error' else row['group']}"
        held = _held(row.to_frame().T)
        axis.plot(reliability.LEVELS, held, color=colour, linewidth=0.9, label=label)
    axis.set(xlim=(0, 100), ylim=(0, 100))
    axis.grid()


def _order(names: pd.Series) -> pd.Series:
    return pd.to_numeric(names, errors="coerce").fillna(0)


def _held(rows: pd.DataFrame) -> np.ndarray:
    names = [f"{name}_percent" for name in reliability.HELD]
    return rows[names].to_numpy(dtype=float).reshape(-1, len(names))[:1].T


def _title(rows: pd.DataFrame, stage: str) -> str:
    whole = rows[(rows["session"] == EVERY) & (rows["by"] == "all")].iloc[0]
    held = f"90 % ellipsoids hold {whole['held_90_percent']:.0f} %"
    words = f"{players.STAGES[stage]}\n{held}"
    precision, recall = (whole[f"{name}_percent"] for name in ("precision", "recall"))
    if np.isnan([precision, recall]).any():
        return words
    flags = f"{precision:.0f} % of flags are right"
    return f"{words}\n{flags},\n{recall:.0f} % of large errors flagged"
