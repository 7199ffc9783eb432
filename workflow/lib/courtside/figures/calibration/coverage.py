"""Coverage of the uncertainty that a calibration states."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from courtside.evaluation.joints import WANTED_90
from courtside.evaluation.tables import calibration
from courtside.figures.style import bars, style

METHOD = {"method": "sfm", "mapper": "global"}
LEVELS = {
    "coverage50": (50, style.CYCLE[5], "v"),
    "coverage90": (90, style.CYCLE[0], "o"),
    "coverage95": (95, style.CYCLE[1], "s"),
}
ACROSS = 4  # sessions in a row


def table(rows: pd.DataFrame) -> pd.DataFrame:
    """Compare stated with true errors, of rows of `calibration.tidy` of any number of sessions.

    One row per session and number of bridging images, method `sfm` with all clicks; coverages are
    means over trials.
    """
    of = calibration.pick(rows, in_sample=True, **METHOD)
    of = of[of["n_clicks"] == of.groupby("session")["n_clicks"].transform("max")]
    found = []
    for (session, count), group in of.groupby(["session", "n_bridging"]):
        row = {"session": session, "n_bridging": int(count), "n_clicks": group["n_clicks"].iloc[0]}
        row["n"] = int(group["volume_rms_cm"].notna().sum())
        row["n_failed"] = len(group) - row["n"]
        row |= {name: 100 * group[name].mean() for name in LEVELS}
        for name in ("volume_rms_cm", "predicted_volume_cm"):
            spread = calibration.spread(group[name])
            row |= {f"{name}_{part}": spread[part] for part in ("p05", "median", "p95")}
        found.append(row)
    return pd.DataFrame(found)


def draw(numbers: pd.DataFrame) -> Figure:
    """Draw the table of `table`: coverage above expected and true errors, a column per session."""
    sessions = list(dict.fromkeys(numbers["session"]))
    across = min(ACROSS, len(sessions))
    deep = -(-len(sessions) // across)
    drawing = style.figure(18 + 105 * deep)
    axes = drawing.subplots(2 * deep, across, squeeze=False)
    for axis in axes.flat[:]:
        axis.set_visible(False)
    for at, session in enumerate(sessions):
        row, column = 2 * (at // across), at % across
        part = numbers[numbers["session"] == session].sort_values("n_bridging")
        _draw_shares(axes[row, column], part)
        _draw_sizes(axes[row + 1, column], part)
        most, failed = (part["n"] + part["n_failed"]).max(), part["n_failed"].sum()
        trial = f"up to {most} trials per N; {failed} of {part['n'].sum() + failed} failed"
        axes[row, column].set_title(f"{session}\n{trial}")
        if column == 0:
            axes[row, column].set_ylabel("true positions inside (%)")
            axes[row + 1, column].set_ylabel("error over the volume, RMS (cm)")
    shares, sizes = (axes[n, 0].get_legend_handles_labels() for n in (0, 1))
    handles, labels = shares[0] + sizes[0], shares[1] + sizes[1]
    drawing.legend(handles, labels, loc="outside lower center", ncols=5)
    return drawing


def _draw_shares(axis: Axes, part: pd.DataFrame) -> None:
    axis.set_visible(True)
    axis.axhspan(*WANTED_90, color=LEVELS["coverage90"][1], alpha=0.1, linewidth=0)
    for name, (level, colour, marker) in LEVELS.items():
        axis.axhline(level, color=colour, linestyle="--", linewidth=0.8)
        look = {"marker": marker, "color": colour, "markersize": 4, "linewidth": 1}
        axis.plot(part["n_bridging"], part[name], label=f"{level} % ellipsoids", **look)
    _by_count(axis, part)
    axis.set(ylim=(0, 103))


def _draw_sizes(axis: Axes, part: pd.DataFrame) -> None:
    axis.set_visible(True)
    looks = (
        ("volume_rms_cm", "true", style.CYCLE[6], "o"),
        ("predicted_volume_cm", "expected", style.CYCLE[2], "D"),
    )
    for at, (name, label, colour, marker) in enumerate(looks):
        columns = {f"{name}_{key}": key for key in ("p05", "median", "p95")}
        rows = part[list(columns)].rename(columns=columns)
        x = part["n_bridging"] * np.exp(0.08 * (at - 0.5))
        bars.draw(
            axis, x, rows, colour=colour, marker=marker, filled=at == 0, label=f"{label} error"
        )
    _by_count(axis, part)
    axis.set(xlabel="bridging images N", ylim=(0, None))


def _by_count(axis: Axes, part: pd.DataFrame) -> None:
    counts = part["n_bridging"].tolist()
    bars.ticks_at(axis, counts)
    axis.set_xlim(counts[0] / 1.3, counts[-1] * 1.3)
