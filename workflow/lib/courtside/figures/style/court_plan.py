"""A court from above, to scale."""

from matplotlib.patches import Rectangle

PAINT = "#777777"


def draw(axis, court, colour=PAINT, least_pt=0.0):
    """Draw the painted lines at their true width, and the net as a dashed line.

    Parameters
    ----------
    axis : matplotlib.axes.Axes
        In metres; its aspect becomes equal.
    court : courtside.calibration.court.court.Court
    colour : str
    least_pt : float
        Drawn around each line, for plans on which the true width would vanish.
    """
    edge = colour if least_pt else "none"
    for x0, y0, x1, y1 in court.lines_m:
        look = {"facecolor": colour, "edgecolor": edge, "linewidth": least_pt}
        axis.add_patch(Rectangle((x0, y0), x1 - x0, y1 - y0, zorder=1, snap=False, **look))
    if court.net is not None:
        axis.plot(court.net["x_m"], [court.net["y_m"]] * 2, "--", color=colour, linewidth=0.9)
    axis.set_aspect("equal")
