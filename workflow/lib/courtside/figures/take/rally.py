"""A timeline of a rally: strokes and steps of each player, and the speeds of trunk and wrist."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from courtside.figures.style import bars, style, windows
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.statistics.normal_errors import WITHIN_90
from courtside.strokes import signals

HEAD_MM, ROW_MM, STRIP_MM = 22, 45, 25
LIVELIEST_S = 30.0  # of a take of minutes, which are drawn
HATCHED = "hatched: seen for less than half"
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
    Of a take of minutes there are the strokes a minute of each window, and the half minute with the
    most strokes of all.
    """
    if window_s := windows.length_s(points.time_s):
        return _draw_long(strokes, events, points, window_s)
    drawing = style.figure(HEAD_MM + ROW_MM * max(len(points.person_id), 1))
    rows = drawing.subplots(len(points.person_id), 1, sharex=True, squeeze=False)[:, 0]
    _draw_rows(rows, strokes, events, points)
    _name(drawing, rows)
    return drawing


def _draw_long(
    strokes: pd.DataFrame, events: pd.DataFrame, points: Keypoints3D, window_s: int
) -> Figure:
    start_s = liveliest(strokes.time_s.to_numpy(), points.time_s)
    part = start_s, start_s + LIVELIEST_S
    n_people = len(points.person_id)
    drawing = style.figure(HEAD_MM + (STRIP_MM + ROW_MM) * max(n_people, 1))
    above, below = drawing.subfigures(2, 1, height_ratios=(STRIP_MM, ROW_MM))
    strips = above.subplots(n_people, 1, sharex=True, squeeze=False)[:, 0]
    for at, (axis, person) in enumerate(zip(strips, points.person_id, strict=True)):
        own = strokes[strokes.person == str(person)]
        seen = np.isfinite(points.xyz[at, :, :, 0]).any(axis=1)
        _draw_strip(axis, own, points.time_s, seen, window_s)
        axis.axvspan(*part, color="0.8", linewidth=0, zorder=0)
        axis.set_title(f"{person}: {_counted(own)}", loc="left")
    strips[-1].set_xlabel(f"time (s): each {window_s} s; grey: drawn below; {HATCHED}")
    rows = below.subplots(n_people, 1, sharex=True, squeeze=False)[:, 0]
    frames = slice(*np.searchsorted(points.time_s, part).tolist())
    strokes, events = strokes[strokes.time_s.between(*part)], events[events.stop_s.between(*part)]
    _draw_rows(rows, strokes, events, points.frames(frames))
    _name(drawing, rows)
    return drawing


def liveliest(at_s: NDArray, time_s: NDArray) -> float:
    """Return when the part of a take with the most of the events at `at_s` (N,) begins, s."""
    starts = np.concatenate([time_s[:1], np.clip(np.sort(at_s) - 1, *_within(time_s))])
    n_events = [np.count_nonzero((at_s >= one) & (at_s <= one + LIVELIEST_S)) for one in starts]
    return float(starts[np.argmax(n_events)])


def _within(time_s: NDArray) -> tuple[float, float]:
    return time_s[0], max(time_s[0], time_s[-1] - LIVELIEST_S)


def _draw_strip(
    axis: Axes, own: pd.DataFrame, time_s: NDArray, seen: NDArray, window_s: int
) -> None:
    """Draw the strokes a minute of each window, low ones below overhead ones.

    A window in which the person is seen for less than half of it has no rate, and is hatched.
    """
    bottom: pd.Series | float = 0.0
    for overhead in (False, True):
        at_s = own.time_s[own.overhead.astype(bool) == overhead].to_numpy()
        rate = windows.a_minute(at_s, time_s, seen, window_s)
        look: dict = {"color": KINDS[overhead][1], "alpha": 0.7}
        axis.bar(rate.index, rate, 0.9 * window_s, bottom, **look)
        bottom = bottom + rate
    for middle_s in rate.index[rate.isna()]:
        ends_s = middle_s - window_s / 2, middle_s + window_s / 2
        axis.axvspan(*ends_s, facecolor="none", edgecolor="0.6", hatch="////", linewidth=0)
    axis.set(ylabel="strokes\na minute", xlim=(time_s[0], time_s[-1]))


def _draw_rows(
    rows: NDArray, strokes: pd.DataFrame, events: pd.DataFrame, points: Keypoints3D
) -> None:
    people = list(map(str, points.person_id))
    for at, (axis, person) in enumerate(zip(rows, people, strict=True)):
        own = strokes[strokes.person == person]
        _draw_person(axis, own, signals.of_person(points, at))
        _draw_steps(axis, events[events.person == person])
        hands = ", ".join(f"{hand} hand ({source})" for hand, source in _hands(own))
        title = f"{person}: {_counted(own)}{', ' if hands else ''}{hands}"
        axis.set_title(title, loc="left", pad=11)
    rows[-1].set_xlabel("time (s)")


def _counted(own: pd.DataFrame) -> str:
    return "1 stroke" if len(own) == 1 else f"{len(own)} strokes"


def _name(drawing: Figure, rows: NDArray) -> None:
    named = bars.named(rows)
    drawing.legend(named.values(), named, loc="outside upper right", ncols=min(len(named), A_ROW))


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
