"""A timeline of a rally: strokes and steps of each player, and the speeds of trunk and wrist."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from courtside.figures.style import bars, style
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.statistics.normal_errors import WITHIN_90
from courtside.strokes import signals

HEAD_MM, ROW_MM = 22, 45
A_ROW = 4  # entries of the legend
KINDS = {True: ("overhead stroke", style.RIGHT), False: ("low stroke", style.LEFT)}
STEPS = {"split_step": ("split step", "v", 5), "step": ("step", "|", 4), "lunge": ("lunge", "D", 3)}
STROKE = ["sigma_s", "hand", "overhead", "speed_m_s"]


def table(strokes: pd.DataFrame, events: pd.DataFrame) -> pd.DataFrame:
    """Return the numbers drawn: `what` happened when, and of a stroke the columns `STROKE`."""
    hits = strokes.assign(what="stroke")[["person", "what", "time_s", *STROKE]]
    feet = events.rename(columns={"event": "what", "stop_s": "time_s", "stop_sigma_s": "sigma_s"})
    feet = feet[feet.what.isin(list(STEPS))][["person", "what", "time_s", "sigma_s"]]
    rows = pd.concat([part for part in (hits, feet) if len(part)] or [hits], ignore_index=True)
    return rows.sort_values(["time_s", "person"], ignore_index=True)


def draw(strokes: pd.DataFrame, events: pd.DataFrame, points: Keypoints3D) -> Figure:
    """Draw each person in a row: strokes as bars as wide as their 90 % interval, landings of feet.

    `strokes` are of `courtside.strokes.detect.table`, `events` of `courtside.records.footwork`.
    """
    people = list(map(str, points.person_id))
    drawing = style.figure(HEAD_MM + ROW_MM * max(len(people), 1))
    rows = drawing.subplots(len(people), 1, sharex=True, squeeze=False)[:, 0]
    for at, (axis, person) in enumerate(zip(rows, people, strict=True)):
        own = strokes[strokes.person == person]
        counted = "1 stroke" if len(own) == 1 else f"{len(own)} strokes"
        _draw_person(axis, own, signals.of_person(points, at))
        _draw_steps(axis, events[events.person == person])
        hands = ", ".join(f"{hand} hand ({source})" for hand, source in _hands(own))
        axis.set_title(f"{person}: {counted}{', ' if hands else ''}{hands}", loc="left", pad=11)
    rows[-1].set_xlabel("time (s)")
    named = bars.named(rows)
    drawing.legend(named.values(), named, loc="outside upper right", ncols=min(len(named), A_ROW))
    return drawing


def _hands(own: pd.DataFrame) -> list[tuple[str, str]]:
    return list(dict.fromkeys(zip(own.hand, own.hand_from, strict=True)))


def _draw_person(axis: Axes, own: pd.DataFrame, found: signals.Signals) -> None:
    axis.plot(found.time_s, found.trunk.speed, color=style.MIDDLE, linewidth=0.9, label="trunk")
    hand = own.hand.iloc[0] if len(own) else None
    if hand:
        speed = found.arms[hand].speed(found.rate_hz)
        axis.plot(found.time_s, speed, color="#bbbbbb", linewidth=0.7, label="wrist that plays")
    for stroke in own.itertuples():
        words, colour = KINDS[bool(stroke.overhead)]
        reach = WITHIN_90 * stroke.sigma_s
        axis.axvspan(stroke.time_s - reach, stroke.time_s + reach, color=colour, alpha=0.35, lw=0)
        axis.axvline(stroke.time_s, color=colour, linewidth=1.2, label=words)
        axis.annotate(
            f"{stroke.time_s:.2f} s",
            (stroke.time_s, 1.0),
            xycoords=("data", "axes fraction"),
            ha="center",
            va="bottom",
            fontsize=6,
            color=colour,
        )
    first_s, last_s = found.time_s[[0, -1]]
    axis.set(ylabel="speed (m/s)", xlim=(first_s, last_s) if last_s > first_s else None)
    axis.set_ylim(bottom=0)


def _draw_steps(axis: Axes, own: pd.DataFrame) -> None:
    """Mark when the feet landed, below the speeds."""
    for event, (words, mark, size) in STEPS.items():
        landed = own.stop_s[own.event == event].dropna()
        if len(landed):
            place = np.full(len(landed), -0.07)
            look: dict = {"transform": axis.get_xaxis_transform(), "clip_on": False}
            axis.plot(landed, place, mark, color="0.2", markersize=size, label=words, **look)
    axis.tick_params(axis="x", pad=8)
