"""The named points of a court, numbered on its plan, with the line edges that define them."""

import textwrap

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.figures.style import court_plan, style

ROOM = 0.067  # around the plan, of its longer side
WIDE_ROOM = 0.11  # above and below a plan wider than high, of its width: for the numbers
BELOW_MM = 9.2  # from the plan to the legend, for the numbers and the label of the axis
FLOOR, BOTH, ABOVE = "on the floor", "on the floor, and one above it", "above the floor"
LEVELS = {FLOOR: style.LEFT, BOTH: style.RIGHT, ABOVE: style.CYCLE[2]}
FRAME = "origin, end of x, end of y"
DETAIL_M = 0.16  # half the side of an enlarged detail
DETAILS = 5  # enlarged, at most
LINE_LENGTH = 62  # characters of the list
AWAY_PT = 7.5  # from a point to its number
FEW = "three"  # the set that gives the frame: origin, end of x, end of y


def table(court: Court) -> pd.DataFrame:
    """Return the points: point, x_m, y_m, z_m, sigma_m, sets, edges."""
    sets = [" ".join(n for n, members in court.sets.items() if p in members) for p in court.points]
    xyz = {f"{axis}_m": court.xyz[:, at] for at, axis in enumerate("xyz")}
    rows = {"point": court.points, **xyz, "sigma_m": court.sigma_m, "sets": sets}
    return pd.DataFrame({**rows, "edges": court.edges})


def draw(court: Court) -> Figure:
    """Draw the plan, details of it, the net from the side, and the list of edges."""
    drawing = style.figure(175)
    columns = drawing.add_gridspec(1, 2, width_ratios=[1, 1.25])
    _draw_plan(drawing.add_subplot(columns[0]), court)
    right = columns[1].subgridspec(3, DETAILS, height_ratios=[1.75, 0.45, 0.62])
    _write_list(drawing.add_subplot(right[0, :]), court)
    for at, point in enumerate(_details(court)[:DETAILS]):
        _draw_detail(drawing.add_subplot(right[1, at]), court, point)
    if court.net is not None:
        _draw_net(drawing.add_subplot(right[2, :]), court, court.net)
    return drawing


def _groups(court: Court) -> list[tuple[list[str], str]]:
    """Return the points that name the same edges: list of (names, edges), in the court's order."""
    named: dict[str, list[str]] = {}
    for point, edges in zip(court.points, court.edges, strict=True):
        named.setdefault(edges, []).append(point)
    return [(points, edges) for edges, points in named.items()]


def _draw_plan(axis: Axes, court: Court) -> None:
    court_plan.draw(axis, court)
    places = np.unique(court.xyz[:, :2], axis=0)
    marks: dict[str, tuple[str, str]] = {}  # colour and sign, by words
    for place in places:
        here = [n for n in range(len(court.points)) if (court.xyz[n, :2] == place).all()]
        few = any(court.points[n] in court.sets.get(FEW, ()) for n in here)
        colour, words = _level(court.on_floor[here])
        look = {"marker": "s" if few else "o", "markersize": 5 if few else 4, "color": colour}
        axis.plot(*place, zorder=4, **look)
        marks |= {words: (colour, "o")} | ({FRAME: (colour, "s")} if few else {})
        _number(axis, court, place, ", ".join(court.points[n] for n in here))
    low, high = _extent(np.concatenate([places, court.lines_m.reshape(-1, 2)]))
    room = ROOM * (high - low).max()
    above = max(room, WIDE_ROOM * (high - low)[0])
    axis.set(xlim=(low[0] - 2.8 * room, high[0] + 2.8 * room), xlabel="x (m)", ylabel="y (m)")
    axis.set(ylim=(low[1] - above, high[1] + above), anchor="N")
    for words in (word for word in (*LEVELS, FRAME) if word in marks):
        colour, marker = marks[words]
        axis.plot([], [], marker, color=colour, markersize=4, label=words)
    style.legend_below(axis, BELOW_MM, ncols=1)
    axis.set_title(f"{court.description}\nlines {1000 * court.line_width_m:.0f} mm, to scale")


def _level(on_floor: NDArray) -> tuple[str, str]:
    """Return colour and words of points above each other, by which of them are on the floor."""
    words = FLOOR if on_floor.all() else BOTH if on_floor.any() else ABOVE
    return LEVELS[words], words


def _extent(places: NDArray) -> tuple[NDArray, NDArray]:
    """Return the least and the largest x and y."""
    return places.min(axis=0), places.max(axis=0)


def _number(axis: Axes, court: Court, place: NDArray, text: str) -> None:
    """Write a point's name beside it: outside the court, away from its neighbours.

    Where most points are not of the court's rectangle, outside of all points.
    """
    low, high = np.zeros(2), np.asarray(court.size_m, dtype=float)
    every = court.xyz[:, :2]
    if ((every >= low) & (every <= high)).all(axis=1).mean() < 0.5:
        low, high = _extent(every)
    aside = np.sign(place - (low + high) / 2)
    on_end = not low[1] < place[1] < high[1]
    right = aside[0] <= 0 if on_end and low[0] < place[0] < high[0] else aside[0] >= 0
    away = (AWAY_PT if right else -AWAY_PT, AWAY_PT * aside[1] * (1.4 if on_end else 1))
    where = {"textcoords": "offset points", "va": "center", "fontsize": 7.5, "zorder": 3}
    box = {"facecolor": "white", "edgecolor": "none", "pad": 0.6}
    axis.annotate(text, place, away, ha="left" if right else "right", bbox=box, **where)


def _write_list(axis: Axes, court: Court) -> None:
    lines = []
    for points, edges in _groups(court):
        lines += [" ".join(points)]
        lines += textwrap.wrap(edges, LINE_LENGTH, initial_indent="   ", subsequent_indent="   ")
    axis.axis("off")
    axis.set_title("Which edges meet at a point", loc="left", fontweight="bold")
    for at, line in enumerate(lines):
        weight = "normal" if line.startswith(" ") else "bold"
        look = {"va": "top", "fontsize": 7, "fontweight": weight, "transform": axis.transAxes}
        axis.text(0, 1 - (at + 0.3) / max(len(lines), 21), line, **look)


def _details(court: Court) -> list[int]:
    """Return the indices of points to enlarge, one for each wording of the edges."""
    flat = [court.points.index(points[0]) for points, _ in _groups(court)]
    near = [n for n in flat if court.on_floor[n] and _lines_at(court, n) >= 2]
    return near or flat


def _lines_at(court: Court, point: int) -> int:
    low = np.minimum(court.lines_m[:, :2], court.lines_m[:, 2:]) - 1e-6
    high = np.maximum(court.lines_m[:, :2], court.lines_m[:, 2:]) + 1e-6
    place = court.xyz[point, :2]
    return int(((place >= low) & (place <= high)).all(axis=1).sum())


def _draw_detail(axis: Axes, court: Court, point: int) -> None:
    court_plan.draw(axis, court)
    x, y = court.xyz[point, :2]
    for shift in (-1, 1):
        axis.plot([x + shift * DETAIL_M, x], [y, y], color=style.LEFT, linewidth=0.6)
        axis.plot([x, x], [y + shift * DETAIL_M, y], color=style.LEFT, linewidth=0.6)
    axis.plot(x, y, "o", color=style.LEFT, markersize=4, zorder=4)
    axis.set(xlim=(x - DETAIL_M, x + DETAIL_M), ylim=(y - DETAIL_M, y + DETAIL_M))
    axis.set(xticks=[], yticks=[])
    axis.add_patch(Rectangle((x + 0.045, y - 0.14), 0.1, 0.008, facecolor="black", zorder=5))
    box = {"facecolor": "white", "edgecolor": "none", "pad": 0.4}
    look = {"ha": "center", "va": "bottom", "fontsize": 5.5, "bbox": box, "zorder": 5}
    axis.text(x + 0.095, y - 0.125, "0.1 m", **look)
    axis.spines[:].set_visible(True)
    axis.set_title(court.points[point])


def _draw_net(axis: Axes, court: Court, net: dict) -> None:
    left, right = net["x_m"]
    post, middle = net["post_height_m"], net["mid_height_m"]
    x = np.linspace(left, right, 41)
    sag = post - (post - middle) * (1 - ((2 * x - left - right) / (right - left)) ** 2)
    axis.plot(x, sag, color=court_plan.PAINT, linewidth=1)
    axis.axhline(0, color=court_plan.PAINT, linewidth=1)
    axis.vlines([left, right], 0, post, color=court_plan.PAINT, linewidth=2)
    for n in np.flatnonzero(court.xyz[:, 1] == net["y_m"]):
        at, height = court.xyz[n, 0], court.xyz[n, 2]
        colour = style.LEFT if court.on_floor[n] else style.RIGHT
        axis.plot(at, height, "o", color=colour, markersize=4, zorder=4)
        side = -1 if at < (left + right) / 2 else 1
        where = {"textcoords": "offset points", "va": "center"}
        where["ha"] = "right" if side < 0 else "left"
        away = (AWAY_PT * side, -AWAY_PT if court.on_floor[n] else 0)
        axis.annotate(court.points[n], (at, height), away, fontsize=7.5, **where)
    axis.text((left + right) / 2, middle - 0.12, f"{middle:g} m", ha="center", va="top", fontsize=7)
    room = 0.15 * (right - left)
    axis.set(xlim=(left - room, right + room), ylim=(-0.7 * room, post + 0.3), aspect="equal")
    title = f"Net, y = {net['y_m']:g} m, posts {post:g} m"
    axis.set(xlabel="x (m)", ylabel="z (m)", title=title)
