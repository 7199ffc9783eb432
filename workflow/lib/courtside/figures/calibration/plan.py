"""Expected error of a planned session by number of bridging images."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from courtside.calibration.planning.prediction import Prediction
from courtside.figures.style import bars, style

COLUMNS = (
    "n_images", "neighbour_deg", "n_ties", "least_ties", "error_median_cm", "error_p05_cm",
    "error_p95_cm", "enough", "fault",
)  # fmt: skip
ERROR = "RMS 3D error\nover the court (cm)"


def table(predictions: list[Prediction], chosen: Prediction | None) -> pd.DataFrame:
    """Return one row per number of bridging images; `chosen` has the fewest images that suffice."""
    rows = []
    for p in sorted(predictions, key=lambda p: p.n_images):
        low, middle, high = p.error_cm
        enough = int(chosen is not None and p.n_images >= chosen.n_images)
        walk = p.n_images, p.neighbour_deg, p.n_ties, p.least_ties
        rows.append((*walk, middle, low, high, enough, p.fault))
    return pd.DataFrame(rows, columns=list(COLUMNS))


def draw(
    rows: pd.DataFrame,
    title: str,
    *,
    min_points: int,
    widest_deg: float,
    target_cm: float | None = None,
) -> Figure:
    """Draw the table of `table`: error above, widest angle between neighbours, fewest ties below.

    Of a plan without a walk, the error alone.

    `min_points` are the fewest ties of a fixed camera, `widest_deg` is the widest angle between
    neighbouring views that keeps a model connected.
    """
    if not rows["n_images"].any():
        return _draw_alone(rows.iloc[0], title, target_cm)
    drawing = style.figure(110)
    above, angle, ties = drawing.subplots(3, 1, sharex=True, height_ratios=[2.2, 1, 1])
    walked, alone = rows[rows["n_images"] > 0], rows[rows["n_images"] == 0]
    n = walked["n_images"]
    band = n, walked["error_p05_cm"], walked["error_p95_cm"]
    above.fill_between(*band, color=style.CYCLE[5], alpha=0.4)
    look = {"color": style.CYCLE[0], "label": "median; band: 90 % of sessions"}
    above.plot(n, walked["error_median_cm"], "o-", **look)
    if alone["error_median_cm"].notna().any():
        label, value = "court points alone", alone["error_median_cm"].iloc[0]
        above.axhline(value, color="#777777", linestyle="--", linewidth=0.9, label=label)
    if target_cm is not None:
        above.axhline(target_cm, color=style.CYCLE[1], linewidth=0.9, label="wanted")
    _mark_enough(above, walked)
    above.set(ylabel=f"expected {ERROR}", ylim=(0, 1.35 * rows["error_p95_cm"].max()))
    above.legend(loc="upper right", ncols=2)
    _draw_limit(angle, n, walked["neighbour_deg"], widest_deg, "neighbours\n(degrees)")
    _draw_limit(ties, n, walked["least_ties"], min_points, "fewest ties")
    bars.ticks_at(ties, n)
    ties.set_xlabel("bridging images")
    drawing.suptitle(title, fontsize=8)
    return drawing


def _draw_alone(row: pd.Series, title: str, target_cm: float | None) -> Figure:
    drawing = style.figure(45)
    axis = drawing.subplots()
    middle, low, high = (row[f"error_{part}_cm"] for part in ("median", "p05", "p95"))
    label = "median; bar: 90 % of sessions"
    axis.errorbar(
        middle, 0, xerr=[[middle - low], [high - middle]], fmt="o", capsize=4, label=label
    )
    if target_cm is not None:
        axis.axvline(target_cm, color=style.CYCLE[1], linewidth=0.9, label="wanted")
    axis.set(yticks=[0], yticklabels=["court points\nalone"], ylim=(-1, 1))
    axis.set(xlabel=f"expected {ERROR}".replace("\n", " "), xlim=(0, 1.2 * high))
    axis.legend(loc="upper right")
    drawing.suptitle(title, fontsize=8)
    return drawing


def _draw_limit(axis: Axes, n: pd.Series, values: pd.Series, limit: float, label: str) -> None:
    axis.plot(n, values, "s-", color=style.CYCLE[0], markersize=3.5)
    axis.axhline(limit, color=style.CYCLE[1], linewidth=0.9)
    top = np.nanmax([limit, *values]) if len(values) else limit
    axis.set(ylabel=label, ylim=(0, 1.15 * top))


def _mark_enough(axis: Axes, walked: pd.DataFrame) -> None:
    enough = walked[walked["enough"] == 1]
    if len(enough):
        first = enough.iloc[0]
        label = f"enough: {first['n_images']:.0f} images"
        look = {"color": style.CYCLE[1], "markersize": 11, "label": label}
        axis.plot(first["n_images"], first["error_median_cm"], "*", **look)
