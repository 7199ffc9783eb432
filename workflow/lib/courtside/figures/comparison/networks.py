"""Networks on the same frames: each measure with its interval, network by network."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from courtside.figures.style import bars, style

DRAWN = {  # measure: title of its panel
    "error_median": "2D error, median (px)",
    "error_p95": "2D error, 95 % (px)",
    "pck": "PCK@0.2 (%)",
    "exchanged": "sides exchanged (%)",
    "jitter": "2D jitter (px)",
    "error_3d_median": "3D error, median (mm)",
    "error_3d_p95": "3D error, 95 % (mm)",
}
MARKERS = "os^Dv"  # one for each session
PER_LINE = 4
SPREAD = 0.5  # of the distance between networks, for the sessions' marks


def table(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of `evaluation.tables.networks.table` that are drawn."""
    return rows[rows["measure"].isin(DRAWN)].reset_index(drop=True)


def draw(rows: pd.DataFrame) -> Figure:
    """Draw the rows of `table`: a panel for each measure, a line for each network."""
    titles = {name: title for name, title in DRAWN.items() if name in set(rows["measure"])}
    networks = list(dict.fromkeys(rows["network"]))
    against = list(rows.groupby(["session", "against"], sort=False).groups)
    n_lines = -(-len(titles) // PER_LINE)
    drawing = style.figure(n_lines * (24 + 7 * len(networks)) + 6 * len(against))
    axes = drawing.subplots(n_lines, PER_LINE, sharey=True, squeeze=False).ravel()
    for axis, (measure, title) in zip(axes, titles.items(), strict=False):
        _panel(axis, rows[rows["measure"] == measure], networks, against)
        axis.set_title(title)
    for axis in axes[len(titles) :]:
        axis.set_visible(False)
    handles = [
        bars.mark(style.CYCLE[at % len(style.CYCLE)], marker=MARKERS[at % len(MARKERS)],
                  label=f"{session}, against {what}")
        for at, (session, what) in enumerate(against)
    ]  # fmt: skip
    drawing.legend(handles=handles, loc="outside lower center", ncols=2)
    return drawing


def _panel(
    axis: Axes, rows: pd.DataFrame, networks: list[str], against: list[tuple[str, str]]
) -> None:
    for at, key in enumerate(against):
        own = rows[(rows["session"] == key[0]) & (rows["against"] == key[1])]
        own = own.set_index("network").reindex(networks)
        place = np.arange(len(networks)) + SPREAD * ((at + 0.5) / len(against) - 0.5)
        colour = style.CYCLE[at % len(style.CYCLE)]
        axis.hlines(place, own["value_from"], own["value_to"], color=colour, linewidth=1.2)
        axis.plot(own["value"], place, MARKERS[at % len(MARKERS)], color=colour, markersize=4)
    bars.name_rows(axis, networks)
    axis.grid(axis="x")
