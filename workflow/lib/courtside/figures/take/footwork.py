"""Footwork of a take: where feet stood on the court, and when."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from courtside.calibration.court.court import Court
from courtside.figures.style import court_plan, style, windows
from courtside.records.footwork import FEET, Contacts
from courtside.statistics import normal_errors

ROW_MM = 105
BELOW_MM = 10.5  # from the court to the legend, for the numbers and the label of the axis
ROOM_M = 0.5  # around the feet
COLOURS = {"left": style.LEFT, "right": style.RIGHT}
MARKS = {"stand": ".", "step": "o", "lunge": "D", "split_step": "v", "jump": "^"}
TIMES = ["onset_s", "onset_sigma_s", "end_s", "end_sigma_s", "seen_from_s", "seen_until_s"]
DRAWN = ["person", "foot", "kind", *TIMES, "x_m", "y_m", "sigma_m"]


def table(steps: pd.DataFrame) -> pd.DataFrame:
    """Return the numbers drawn: the stances."""
    return steps[DRAWN]


def draw(
    contacts: Contacts, steps: pd.DataFrame, events: pd.DataFrame, court: Court | None
) -> Figure:
    """Draw each person in a row: stances from above, and contact of both feet over time.

    Of a take of minutes there are landings a minute, and the mean contact of each window.
    """
    people = contacts.person_id.tolist()
    window_s = windows.length_s(contacts.time_s)
    drawing = style.figure(ROW_MM * max(len(people), 1))
    for row, part in enumerate(drawing.subfigures(len(people), 1, squeeze=False)[:, 0]):
        grid = part.add_gridspec(2, 2, width_ratios=(1.0, 1.6))
        own = steps[steps.person == people[row]]
        own_events = events[events.person == people[row]]
        _draw_places(part.add_subplot(grid[:, 0]), own, court, people[row])
        stances = part.add_subplot(grid[0, 1])
        contact = part.add_subplot(grid[1, 1], sharex=stances)
        if window_s:
            _draw_landings(stances, contacts, row, own, window_s)
            _draw_mean_contact(contact, contacts, row, window_s)
        else:
            _draw_stances(stances, own, own_events)
            _draw_contact(contact, contacts, row)
    return drawing


def _draw_places(axis: Axes, own: pd.DataFrame, court: Court | None, person: str) -> None:
    if court is not None:
        court_plan.draw(axis, court)
    axis.plot(own.x_m, own.y_m, color="0.6", linewidth=0.5, zorder=2)  # in order of time
    for kind, mark in MARKS.items():
        at = own[own.kind == kind]
        if len(at):
            size = 3 + 2 * (kind not in ("stand", "step"))
            look: dict = {"linestyle": "", "markersize": size, "zorder": 3}
            axis.plot([], [], mark, color="0.4", label=kind.replace("_", " "), **look)
            for foot in FEET:
                mine = at[at.foot == foot]
                axis.plot(mine.x_m, mine.y_m, mark, color=COLOURS[foot], **look)
    axis.set_title(f"{person}: feet from above\nlandings: {own.onset_s.notna().sum()}")
    axis.set(xlabel="x (m)", ylabel="y (m)")
    axis.set_aspect("equal", adjustable="box" if court else "datalim")
    if len(own):
        style.legend_below(axis, BELOW_MM, ncols=5, fontsize=7)
    if len(own) and court is not None:
        axis.set_xlim(min(0, own.x_m.min()) - ROOM_M, max(court.size_m[0], own.x_m.max()) + ROOM_M)
        axis.set_ylim(min(0, own.y_m.min()) - ROOM_M, own.y_m.max() + 2 * ROOM_M)


def _draw_stances(axis: Axes, own: pd.DataFrame, events: pd.DataFrame) -> None:
    """Draw bars of both feet; one that the take or a gap cuts reaches as far as it is seen."""
    for row, foot in enumerate(reversed(FEET)):
        mine = own[own.foot == foot]
        start, stop = mine.onset_s.fillna(mine.seen_from_s), mine.end_s.fillna(mine.seen_until_s)
        axis.barh(row, stop - start, left=start, height=0.6, color=COLOURS[foot], alpha=0.7)
        for what, above in (("onset", -0.1), ("end", 0.1)):
            at = mine[f"{what}_s"]
            reach = normal_errors.WITHIN_90 * mine[f"{what}_sigma_s"]
            axis.hlines(row + above + 0 * at, at - reach, at + reach, "black", linewidth=0.8)
    shown = events[events.event != "step"]
    look: dict = {"fontsize": 6, "rotation": 90, "ha": "center", "va": "bottom"}
    for event in shown.itertuples():
        colour = COLOURS.get(event.foot, "black")  # of both feet: black
        axis.annotate(event.event.replace("_", " "), (event.stop_s, 1.45), color=colour, **look)
    axis.set_yticks(range(len(FEET)), [f"{foot} foot" for foot in reversed(FEET)])
    axis.set_ylim(-0.6, 2.3 if len(shown) else 1.6)
    axis.tick_params(labelbottom=False)


def _draw_contact(axis: Axes, contacts: Contacts, person: int) -> None:
    for at, foot in enumerate(contacts.foot.tolist()):
        own = contacts.probability[person, :, at]
        axis.plot(contacts.time_s, own, color=COLOURS[foot], linewidth=0.8, label=f"{foot} foot")
    axis.set(xlabel="time (s)", ylabel="probability of contact", ylim=(-0.03, 1.03))
    axis.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, borderaxespad=0)


def _draw_landings(
    axis: Axes, contacts: Contacts, person: int, own: pd.DataFrame, window_s: int
) -> None:
    """Draw the landings of each foot, and the lunges, of each window as a number a minute."""
    seen = np.isfinite(contacts.probability[person]).any(axis=1)
    lines = {f"{foot} foot": (own.foot == foot, colour) for foot, colour in COLOURS.items()}
    lines["lunges"] = own.kind == "lunge", "black"
    for label, (which, colour) in lines.items():
        onsets = own.onset_s[which].dropna().to_numpy()
        rate = windows.a_minute(onsets, contacts.time_s, seen, window_s)
        axis.plot(rate.index, rate, color=colour, linewidth=0.9, label=label)
    axis.set(ylabel="landings a minute")
    axis.set_ylim(bottom=0)
    axis.tick_params(labelbottom=False)
    axis.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=3, borderaxespad=0)


def _draw_mean_contact(axis: Axes, contacts: Contacts, person: int, window_s: int) -> None:
    for at, foot in enumerate(contacts.foot.tolist()):
        chance = contacts.probability[person, :, at]
        share = windows.known(contacts.time_s, chance, window_s).mean()
        axis.plot(share.index, share, color=COLOURS[foot], linewidth=0.9)
    axis.set(xlabel=f"time (s): means of each {window_s} s")
    axis.set(ylabel="share of time on the floor", ylim=(-0.03, 1.03))
