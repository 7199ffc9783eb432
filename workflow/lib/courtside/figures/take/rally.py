"""A timeline of a rally: the strokes of each player over the speeds of trunk and wrist."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from courtside.calibration.point_covariance import WITHIN_90
from courtside.figures.style import style
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.strokes import signals

HEAD_MM, ROW_MM = 18, 45
KINDS = {True: ("overhead stroke", style.RIGHT), False: ("low stroke", style.LEFT)}
DRAWN = ["person", "time_s", "sigma_s", "hand", "overhead", "speed_m_s", "x_m", "y_m"]


def table(strokes: pd.DataFrame) -> pd.DataFrame:
    """Return the numbers drawn: some columns of `courtside.strokes.detect.table`."""
    return strokes[DRAWN]


def draw(strokes: pd.DataFrame, points: Keypoints3D) -> Figure:
    """Draw each person in a row: strokes as bars as wide as their 90 % interval, two speeds."""
    people = list(map(str, points.person_id))
    drawing = style.figure(HEAD_MM + ROW_MM * max(len(people), 1))
    rows = drawing.subplots(len(people), 1, sharex=True, squeeze=False)[:, 0]
    for at, (axis, person) in enumerate(zip(rows, people, strict=True)):
        own = strokes[strokes.person == person]
        _draw_person(axis, own, signals.of_person(points, at))
        hands = ", ".join(f"{hand} hand ({source})" for hand, source in _hands(own))
        axis.set_title(
            f"{person}: {len(own)} strokes{', ' if hands else ''}{hands}", loc="left", pad=11
        )
    rows[-1].set_xlabel("time (s)")
    handles, labels = rows[0].get_legend_handles_labels()
    named = dict(zip(labels, handles, strict=True))
    drawing.legend(named.values(), named, loc="outside upper right", ncols=len(named))
    return drawing


def _hands(own: pd.DataFrame) -> list[tuple[str, str]]:
    return list(dict.fromkeys(zip(own.hand, own.hand_from, strict=True)))


def _draw_person(axis: Axes, own: pd.DataFrame, found: signals.Signals) -> None:
    axis.plot(found.time_s, found.trunk.speed, color=style.MIDDLE, linewidth=0.9, label="trunk")
    hand = own.hand.iloc[0] if len(own) else None
    if hand:
        speed = found.arms[hand].wrist.speed
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
    axis.set(ylabel="speed (m/s)", xlim=tuple(np.asarray(found.time_s)[[0, -1]]))
    axis.set_ylim(bottom=0)
