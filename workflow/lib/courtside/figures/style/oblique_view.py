"""Skeletons, paths, court and cameras seen obliquely from above, in parallel projection and to scale."""

from dataclasses import dataclass

import numpy as np

from courtside.figures.style import style

ROOM_M = 0.2  # around what is shown
FLOOR = "#bbbbbb"


@dataclass(frozen=True)
class Sight:
    """The direction from which a scene is drawn.

    Attributes
    ----------
    azimuth_deg : float
        Of the observer, from the world's x axis towards y.
    elevation_deg : float
        Of the observer above the floor.
    """

    azimuth_deg: float = -62.0
    elevation_deg: float = 16.0

    def seen(self, xyz):
        """Return where points (..., 3) m of the world lie on the drawing, (..., 2) m: right and up."""
        azimuth, elevation = np.radians([self.azimuth_deg, self.elevation_deg])
        right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
        towards = np.array(
            [
                np.cos(azimuth) * np.cos(elevation),
                np.sin(azimuth) * np.cos(elevation),
                np.sin(elevation),
            ]
        )
        return np.asarray(xyz, dtype=float) @ np.column_stack([right, np.cross(towards, right)])


def line(axis, sight, xyz, form="-", **look):
    """Draw a path.

    Parameters
    ----------
    axis : matplotlib.axes.Axes
    sight : Sight
    xyz : (n, 3) float
        Metres.
    form : str
        As matplotlib has it.
    **look
        Of `matplotlib.lines.Line2D`.
    """
    axis.plot(*sight.seen(xyz).T, form, **look)


def figures(axis, sight, xyz, stick, width=1.4, opacity=1.0):
    """Draw stick figures, each line in the colour of its side of the body.

    Parameters
    ----------
    axis : matplotlib.axes.Axes
    sight : Sight
    xyz : (P, K, 3) float
        Metres; NaN where missing.
    stick : courtside.figures.style.stick_figure.Stick
    width : float
        Points.
    opacity : float
    """
    for person in xyz:
        for start, stop in stick.bones:
            colours = {style.side_colour(stick.joints[at]) for at in (start, stop)}
            colour = colours.pop() if len(colours) == 1 else style.MIDDLE
            look = {"color": colour, "linewidth": width, "alpha": opacity}
            line(axis, sight, person[[start, stop]], solid_capstyle="round", zorder=3, **look)


def floor(axis, sight, low, high, court=None):
    """Draw the floor: the part of the court's lines in a rectangle, or a grid of 1 m where there is no court.

    Parameters
    ----------
    axis : matplotlib.axes.Axes
    sight : Sight
    low, high : (2,) or (3,) float
        Corners of the rectangle, metres.
    court : courtside.calibration.court.court.Court, optional
    """
    low, high = np.asarray(low)[:2], np.asarray(high)[:2]
    corners = [low, (high[0], low[1]), high, (low[0], high[1]), low]
    for x, y in [np.transpose(corners), *_painted(low, high, court)]:
        x, y = np.clip(x, low[0], high[0]), np.clip(y, low[1], high[1])
        line(axis, sight, np.column_stack([x, y, 0 * x]), color=FLOOR, linewidth=0.6, zorder=1)


def _painted(low, high, court):
    """Return the middles of painted lines, (2, 2) each: x of both ends, y of both ends."""
    if court is None:
        xs, ys = (np.arange(np.ceil(a), b + 1e-9) for a, b in zip(low, high, strict=True))
        lines = [((x, x), (low[1], high[1])) for x in xs] + [
            ((low[0], high[0]), (y, y)) for y in ys
        ]
        return np.array(lines)
    x0, y0, x1, y1 = np.asarray(court.lines_m).T
    across = x1 - x0 > y1 - y0
    middle_x, middle_y = (x0 + x1) / 2, (y0 + y1) / 2
    x = np.where(across, [x0, x1], middle_x)
    y = np.where(across, middle_y, [y0, y1])
    lines = np.stack([x.T, y.T], axis=1)
    inside = [
        (ends.max(axis=1) >= low).all() and (ends.min(axis=1) <= high).all() for ends in lines
    ]
    return lines[inside]


def net(axis, sight, court):
    """Draw the outline of a court's net, where it has one.

    Parameters
    ----------
    axis : matplotlib.axes.Axes
    sight : Sight
    court : courtside.calibration.court.court.Court or None
    """
    if court is None or court.net is None:
        return
    (x0, x1), y, top = court.net["x_m"], court.net["y_m"], court.net["post_height_m"]
    x, z = [x0, x0, (x0 + x1) / 2, x1, x1], [0, top, court.net["mid_height_m"], top, 0]
    xyz = np.column_stack([x, np.full(5, y), z])
    line(axis, sight, xyz, color="#999999", linewidth=0.8, zorder=2)


def camera(axis, sight, one, depth_m, colour="black"):
    """Draw a camera as the pyramid of what it sees, with its name.

    Parameters
    ----------
    axis : matplotlib.axes.Axes
    sight : Sight
    one : courtside.geometry.camera.Camera
    depth_m : float
        Height of the pyramid.
    colour : str
    """
    width, height = one.size
    pixels = np.array([[0, 0], [width, 0], [width, height], [0, height]], dtype=float)
    in_cam = np.column_stack([(pixels - one.K[:2, 2]) / np.diag(one.K)[:2], np.ones(4)]) * depth_m
    corners = one.centre_in_world + in_cam @ one.cam_from_world[:, :3]
    look = {"color": colour, "linewidth": 0.7, "zorder": 4}
    for corner in corners:
        line(axis, sight, np.stack([one.centre_in_world, corner]), **look)
    line(axis, sight, corners[[0, 1, 2, 3, 0]], **look)
    place = sight.seen(one.centre_in_world)
    look = {"textcoords": "offset points", "ha": "center", "va": "top", "fontsize": 7}
    axis.annotate(one.name, place, (0, -4), color=colour, **look)


def limits(xyz):
    """Return the corners (3,), (3,) m of the box on half metres that holds points, NaN ignored."""
    known = np.reshape(xyz, (-1, 3))
    known = known[np.isfinite(known).all(axis=1)]
    if not len(known):
        known = np.zeros((1, 3))
    low, high = known.min(axis=0) - ROOM_M, known.max(axis=0) + ROOM_M
    return np.floor(2 * low) / 2, np.ceil(2 * high) / 2


def finish(axis, sight, corner, length_m=0.5):
    """Make a drawing to scale without a frame, with a length along each axis of the world at a point.

    Parameters
    ----------
    axis : matplotlib.axes.Axes
    sight : Sight
    corner : (2,) or (3,) float
        On the floor, metres.
    length_m : float
    """
    origin = np.array([*np.asarray(corner, dtype=float)[:2], 0.0])
    for name, along in zip("xyz", np.eye(3), strict=True):
        ends = np.stack([origin, origin + length_m * along])
        line(axis, sight, ends, color="black", linewidth=1.0, zorder=4)
        words = f"z ({length_m:g} m)" if name == "z" else name
        place = sight.seen(origin + 1.25 * length_m * along)
        axis.text(*place, words, fontsize=6, ha="center", va="center")
    axis.set_aspect("equal")
    axis.set_axis_off()
