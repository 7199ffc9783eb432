"""A court from above, to scale, and what stands around it."""

from matplotlib.patches import Rectangle

from courtside.figures import style

PAINT = "#777777"
ARROW = 0.09  # of the axis's longer side


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


def draw_camera(axis, camera, length_m, *, label=True):
    """Mark where a camera stands and where it looks.

    Parameters
    ----------
    axis : matplotlib.axes.Axes
    camera : courtside.geometry.cameras.Camera
    length_m : float
        Of the arrow.
    label : bool
    """
    x, y, _ = camera.centre_in_world
    forward = camera.cam_from_world[2, :2] * length_m
    arrow = {"arrowstyle": "-|>", "color": style.CYCLE[-1], "linewidth": 1, "shrinkA": 0, "shrinkB": 0}
    axis.plot(x, y, "s", color=style.CYCLE[-1], markersize=4, clip_on=False, zorder=4)
    axis.annotate("", (x + forward[0], y + forward[1]), (x, y), arrowprops=arrow, annotation_clip=False)
    if label:
        axis.annotate(camera.name, (x, y), (4, -9), textcoords="offset points", fontsize=7)
