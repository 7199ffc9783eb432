"""A court from above, to scale."""

from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from courtside.calibration.court.court import Court

PAINT = "#777777"


def draw(axis: Axes, court: Court, colour: str = PAINT, least_pt: float = 0.0) -> None:
    """Draw the painted lines at their true width, and the net as a dashed line.

    The axis is in metres. An outline of `least_pt` keeps lines visible on plans at a small scale.
    """
    edge = colour if least_pt else "none"
    for x0, y0, x1, y1 in court.lines_m:
        look = {"facecolor": colour, "edgecolor": edge, "linewidth": least_pt}
        axis.add_patch(Rectangle((x0, y0), x1 - x0, y1 - y0, zorder=1, snap=False, **look))
    if court.net is not None:
        axis.plot(court.net["x_m"], [court.net["y_m"]] * 2, "--", color=colour, linewidth=0.9)
    axis.set_aspect("equal")
