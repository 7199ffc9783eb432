"""A court from above, to scale."""

from matplotlib.patches import Rectangle

PAINT = "#777777"


def draw(axis, court, colour=PAINT):
    """Draw the painted lines at their true width, and the net as a dashed line.

    Parameters
    ----------
    axis : matplotlib.axes.Axes
        In metres; its aspect becomes equal.
    court : courtside.geometry.courts.Court
    colour : str
    """
    for x0, y0, x1, y1 in court.lines_m:
        axis.add_patch(
            Rectangle((x0, y0), x1 - x0, y1 - y0, facecolor=colour, edgecolor="none", zorder=1)
        )
    if court.net is not None:
        axis.plot(court.net["x_m"], [court.net["y_m"]] * 2, "--", color=colour, linewidth=0.9)
    axis.set_aspect("equal")
