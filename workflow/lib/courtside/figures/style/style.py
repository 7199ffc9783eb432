"""One look for all figures, and saving them with the numbers drawn."""

from typing import Any

import matplotlib
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.transforms import ScaledTranslation

from courtside.study.errors import StrPath
from courtside.study.execution.files import atomic

WIDTH_MM = 180
DOTS_PER_INCH = 150
MM_PER_INCH = 25.4
# Okabe & Ito 2008: told apart with any colour vision.
CYCLE = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]
LINES = ("-", "--", "-.", ":")
A_ROW = 4  # panels of cameras: more are too narrow for their words and for people
LEFT, RIGHT, MIDDLE = "#0072B2", "#D55E00", "#666666"
DETECTED_BGR, REPROJECTED_BGR, REJECTED_BGR = (0, 255, 255), (255, 120, 0), (0, 0, 255)
SETTINGS = {
    "font.family": "DejaVu Sans",
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.5,
    "legend.frameon": False,
    "pdf.fonttype": 42,
    "svg.hashsalt": "courtside",
}


class RoundedLayout(ConstrainedLayoutEngine):
    """Matplotlib's layout, rounded: its solver's last digits depend on addresses in memory."""

    DECIMALS = 6  # of the width and height of a page

    def execute(self, drawing: Figure) -> None:
        """Lay a figure out; Matplotlib calls it whenever it draws."""
        super().execute(drawing)
        for part in drawing.subfigs:
            self._round_subfigure(part)
        for axes in drawing.axes:
            for which in ("original", "active"):
                bounds = axes.get_position(original=which == "original").bounds
                axes._set_position(np.round(bounds, self.DECIMALS), which=which)

    def _round_subfigure(self, part) -> None:
        box = part.bbox_relative
        box.p0, box.p1 = np.round(box.p0, self.DECIMALS), np.round(box.p1, self.DECIMALS)
        for inner in part.subfigs:
            self._round_subfigure(inner)


def figure(height_mm: float) -> Figure:
    """Return an empty figure of page width, made without pyplot: no window, no global state."""
    matplotlib.rcParams.update(SETTINGS)
    size = (WIDTH_MM / MM_PER_INCH, height_mm / MM_PER_INCH)
    return Figure(figsize=size, dpi=DOTS_PER_INCH, layout=RoundedLayout())


def legend_below(axis: Axes, below_mm: float, **look: Any) -> None:
    """Draw a legend so far below the panel, whatever its height: under ticks and label."""
    inches = axis.get_figure(root=True).dpi_scale_trans
    below = axis.transAxes + ScaledTranslation(0, -below_mm / MM_PER_INCH, inches)
    axis.legend(loc="upper center", bbox_to_anchor=(0.5, 0), bbox_transform=below, **look)


def wrapped(count: int) -> tuple[int, int]:
    """Return rows and columns of so many panels: at most four in a row, about as many in each."""
    rows = -(-count // A_ROW)
    return rows, -(-count // rows)


def line_look(at: int) -> dict[str, str]:
    """Return colour and line style of the line of an index: 28 that differ, then these again."""
    again, colour = divmod(at, len(CYCLE))
    return {"color": CYCLE[colour], "linestyle": LINES[again % len(LINES)]}


def side_colour(*joints: str) -> str:
    """Return the colour of the body side that all joints are on, else that of the middle."""
    sides = {joint.partition("_")[0] for joint in joints}
    return {"left": LEFT, "right": RIGHT}.get(sides.pop(), MIDDLE) if len(sides) == 1 else MIDDLE


def save(drawing: Figure, table: pd.DataFrame, pdf: StrPath, png: StrPath, csv: StrPath) -> None:
    """Write a figure and its numbers (floats to 4 decimals), the same bytes each time."""
    with atomic(pdf) as temporary:
        drawing.savefig(
            temporary, metadata={"CreationDate": None, "Producer": None, "Creator": None}
        )
    with atomic(png) as temporary:
        drawing.savefig(temporary, metadata={"Software": None})
    with atomic(csv) as temporary:
        table.to_csv(temporary, index=False, float_format="%.4f", lineterminator="\n")
