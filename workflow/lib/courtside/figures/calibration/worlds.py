"""How wrong the world is: what each effect that the estimator does not know costs."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from courtside.evaluation.tables import calibration
from courtside.figures.style import bars, style

FEW = 3  # clicks, beside all of a court
SETTING = ["effect", "strength"]
COLUMNS = ["way", *SETTING, "n", "p05", "median", "p95", "n_failed", "coverage90", "n_warnings"]
NONE, TOGETHER = "none", "together"
STATED = 90.0  # percent, of the ellipsoids
TICKS_CM = (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100)
DODGE = 0.2  # of the distance between neighbouring effects
MARKERS = "os^"


def table(rows: pd.DataFrame, warnings: Mapping[str, int]) -> pd.DataFrame:
    """Return the spread of the volume error by effect and strength.

    Parameters
    ----------
    rows : pd.DataFrame
        Rows of `calibration.tidy`, with the columns `effect` and `strength`.
    warnings : dict of str to int
        For each session how many warnings its calibration by the walk raised.

    Returns
    -------
    numbers : pd.DataFrame
        With the columns `COLUMNS`: errors in cm; `coverage90`, the mean share of points inside of
        their 90 % ellipsoids, in percent; `n_warnings`, the sum over sessions, NaN without a walk.
    """
    parts, most = [], rows["n_clicks"].max()
    ways = {
        ("sfm", most): f"walk, {most:g} clicks",
        ("sfm", FEW): f"walk, {FEW} clicks",
        ("known", most): f"{most:g} clicks, no walk",
    }
    for (method, n_clicks), words in ways.items():
        of = calibration.pick(rows, method=method, n_clicks=n_clicks, in_sample=True)
        if of.empty:
            continue
        found = calibration.summary(of, SETTING, "volume_rms_cm").assign(way=words)
        groups = of.groupby(SETTING, sort=True)
        found["coverage90"] = 100 * groups["coverage90"].mean().to_numpy(dtype=float)
        sessions = groups["session"].unique()
        counts = [sum(warnings.get(name, 0) for name in names) for names in sessions]
        found["n_warnings"] = np.array(counts, float) if method == "sfm" else np.nan
        parts.append(found)
    return pd.concat(parts, ignore_index=True)[COLUMNS]


def draw(numbers: pd.DataFrame) -> Figure:
    """Draw the table of `table`: errors above, coverage below; effects from left to right."""
    drawing = style.figure(110)
    above, below = drawing.subplots(2, 1, sharex=True, height_ratios=[3, 2])
    effects = [name for name in dict.fromkeys(numbers["effect"]) if name not in (NONE, TOGETHER)]
    effects = [NONE, *effects, TOGETHER]
    ways = list(dict.fromkeys(numbers["way"]))
    for at, way in enumerate(ways):
        part = numbers[numbers["way"] == way]
        _draw_way(above, below, part, effects, at, label=way)
    bars.plain_log(above)
    low, high = above.get_ylim()
    above.set_yticks([tick for tick in TICKS_CM if low <= tick <= high])
    above.set_ylabel("error over the volume,\nRMS (cm)")
    below.axhline(STATED, color="0.5", linewidth=0.8, linestyle="--")
    below.set(ylabel="inside 90 % (%)", ylim=(0, 105), xlim=(-0.5, len(effects) - 0.5))
    below.set_xticks(range(len(effects)), effects)
    for axis in (above, below):
        axis.grid(axis="y")
    handles, labels = above.get_legend_handles_labels()
    drawing.legend(handles, labels, loc="outside lower center", ncols=len(ways))
    text = f"{bars.sizes(numbers)}; of two marks the right one is stronger"
    drawing.suptitle(text, fontsize=8)
    return drawing


def _draw_way(
    above: Axes, below: Axes, part: pd.DataFrame, effects: list[str], at: int, *, label: str
) -> None:
    strongest = max(part["strength"].max(), 1.0)
    place = np.array([effects.index(effect) for effect in part["effect"]], dtype=float)
    place += DODGE * (at - 1)
    place += (part["strength"].to_numpy(dtype=float) / strongest - 0.5) * DODGE * 0.7
    known = part["median"].notna().to_numpy()
    look: dict = {"colour": style.CYCLE[at], "marker": MARKERS[at], "line": "none"}
    bars.draw(above, place[known], part[known], label=label, **look)
    below.plot(
        place, part["coverage90"], MARKERS[at], color=style.CYCLE[at], markersize=4.5, zorder=3
    )
