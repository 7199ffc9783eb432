"""Measures of footwork: counts, stance, swing and flight times, steps per corner, rallies."""

from collections.abc import Iterator

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.footwork.kinds import LEAST_FLIGHT_S
from courtside.records import footwork

COLUMNS = ("person", "measure", "value", "sigma", "unit", "n", "definition")
PAUSE_S = 3.0  # ASSUME: a rally is over when no foot is seen to land for longer
# ASSUME: in this time out of sight and `PAUSE_S` seen, nobody ends a rally, fetches the shuttle and
# serves again.
MOST_UNSEEN_S = 5.0
LEAST_LANDINGS = 3  # of a rally: fewer say nothing of a path or a rate
COUNTED = {"step": "steps", "lunge": "lunges", "split_step": "split_steps", "jump": "jumps"}
DEPTHS, SIDES = ("front", "mid", "rear"), ("left", "right")
Row = tuple[str, float, float, str, int, str]  # measure, value, sigma, unit, n, definition
NAN = float("nan")


def summary(steps: pd.DataFrame, events: pd.DataFrame, court: Court | None) -> pd.DataFrame:
    """Return the measures of a take, rows of `COLUMNS`; `steps` and `events` of `records.footwork`.

    Sigma is a standard deviation from those of onsets, ends and places; NaN where nothing is known,
    as of counts. Mean times have that of one of them: how a person sets down and lifts the feet
    shifts the times of all of them alike.
    """
    rows = []
    for person, own in steps.groupby("person", sort=False):
        mine = events[events.person == person]
        found = [*_counts(own, mine), *_times(own), *_corners(own, court), *_rallies(own)]
        rows += [(person, *row) for row in found]
    return pd.DataFrame(rows, columns=list(COLUMNS))


def _counts(steps: pd.DataFrame, events: pd.DataFrame) -> Iterator[Row]:
    landings = int(steps.onset_s.notna().sum())
    yield "steps", float(landings), NAN, "", landings, "landings of a foot, of every kind"
    for kind in ("lunge", "split_step", "jump"):
        n = int((events.event == kind).sum())
        yield COUNTED[kind], float(n), NAN, "", n, f"events {kind}"


def _times(steps: pd.DataFrame) -> Iterator[Row]:
    feet = dict(iter(steps.groupby("foot")))  # in order of time
    sets = {"": list(feet.values())} | {f"_{foot}": [own] for foot, own in feet.items()}
    for name, own in sets.items():
        stood = pd.concat(own).dropna(subset=["onset_s", "end_s"])
        yield _mean(f"stance_time{name}", stood.onset_s, stood.end_s, *_sigmas(stood))
    for name, own in sets.items():
        both = pd.concat([_swings(each) for each in own])
        yield _mean(f"swing_time{name}", both.end_s, both.onset_s, *_sigmas(both))
    yield _flights(steps)


def _swings(foot: pd.DataFrame) -> pd.DataFrame:
    """Return the swings of one foot that are seen whole, as `end_s` to `onset_s`, with sigmas."""
    left, landed = foot[["end_s", "end_sigma_s"]].shift(1), foot[["onset_s", "onset_sigma_s"]]
    seen = foot.seen_from_s == foot.seen_from_s.shift(1)
    return pd.concat([left, landed], axis=1)[seen].dropna()


def _sigmas(rows: pd.DataFrame) -> tuple[pd.Series, pd.Series]:
    return rows.onset_sigma_s, rows.end_sigma_s


def _mean(name: str, start: pd.Series, stop: pd.Series, *sigmas: pd.Series) -> Row:
    n, words = len(start), name.split("_")[0] + " of a foot, mean of those that are seen whole"
    spread = np.sqrt(sum((one**2).mean() for one in sigmas)) if n else NAN
    return name, float((stop - start).mean()) if n else NAN, float(spread), "s", n, words


def _flights(steps: pd.DataFrame) -> Row:
    """Return the mean time in which neither foot stands, from the last end to the next landing.

    Both feet are seen all this time. A landing of both at one time, as of a hop, is one.
    """
    lasts, variances = [], []
    since_s, until_s = (
        steps[f"{known}_s"].fillna(steps[f"seen_{cut}_s"])
        for known, cut in (("onset", "from"), ("end", "until"))
    )
    for row in steps.dropna(subset=["onset_s"]).drop_duplicates("onset_s").itertuples():
        stands = (since_s < row.onset_s) & (until_s > row.onset_s)
        before = steps[until_s <= row.onset_s].groupby("foot").tail(1)  # in order of time
        seen = before.end_s.notna() & (before.seen_until_s >= row.onset_s)
        if stands.any() or seen.sum() < len(footwork.FEET):
            continue
        last = before.loc[before.end_s.idxmax()]
        if row.onset_s - last.end_s >= LEAST_FLIGHT_S:
            lasts.append(row.onset_s - last.end_s)
            variances.append(row.onset_sigma_s**2 + last.end_sigma_s**2)
    n, words = len(lasts), f"neither foot stands, mean of those of {LEAST_FLIGHT_S:g} s and more"
    spread = np.sqrt(np.mean(variances)) if n else NAN
    return "flight_time", float(np.mean(lasts)) if n else NAN, float(spread), "s", n, words


def corner(xy: NDArray, court: Court) -> NDArray:
    """Return the sixth (N,) of its half of the court in which each place (N, 2) lies, as a word.

    Front, mid and rear thirds from the net to the base line, left and right as seen by a player who
    faces the net.
    """
    assert court.net is not None
    ahead = court.net["y_m"] - xy[:, 1]  # positive in the near half
    third = np.clip(3 * np.abs(ahead) / (court.size_m[1] / 2), 0, 2.999).astype(int)
    right = ((xy[:, 0] > court.size_m[0] / 2) == (ahead > 0)).astype(int)
    return np.array([f"{DEPTHS[d]}_{SIDES[r]}" for d, r in zip(third, right, strict=True)])


def _corners(steps: pd.DataFrame, court: Court | None) -> Iterator[Row]:
    if court is None or not court.net:
        return
    landed = steps[steps.onset_s.notna()]
    words = "landings in this sixth of the own half: thirds from the net, sides as facing it"
    found = corner(landed[["x_m", "y_m"]].to_numpy(), court) if len(landed) else np.array([])
    for depth in DEPTHS:
        for side in SIDES:
            n = int((found == f"{depth}_{side}").sum())
            yield f"steps_{depth}_{side}", float(n), NAN, "", n, words


def _rallies(steps: pd.DataFrame) -> Iterator[Row]:
    landed = steps[steps.onset_s.notna()].sort_values("onset_s")
    unseen_s = pd.Series(_unseen(steps, landed.onset_s.to_numpy()), landed.index).diff()
    pause = (landed.onset_s.diff() - unseen_s > PAUSE_S) | (unseen_s > MOST_UNSEEN_S)
    rallies = [own for _, own in landed.groupby(pause.cumsum()) if len(own) >= LEAST_LANDINGS]
    for at, own in enumerate(rallies, start=1):
        lasts = own.onset_s.iloc[-1] - own.onset_s.iloc[0]
        spread = float(np.hypot(own.onset_sigma_s.iloc[-1], own.onset_sigma_s.iloc[0]))
        n, name = len(own), f"rally_{at}"
        words = f"from its first to its last landing, no pause over {PAUSE_S:g} s seen in between"
        yield f"{name}_time", float(lasts), spread, "s", n, words
        hidden_s = float(unseen_s[own.index[1:]].sum())
        words = "part of this time in which neither foot is seen; the path is straight meanwhile"
        yield f"{name}_unseen", hidden_s, NAN, "s", n, words
        length, error = _path(own)
        words = "path of the midpoints between each landing and the one before"
        yield f"{name}_distance", length, error, "m", n, words
        yield f"{name}_step_rate", *_rate(steps, own)


def _unseen(steps: pd.DataFrame, at_s: NDArray) -> NDArray:
    """Return how long neither foot has been seen before each time (N,), s."""
    seen = steps[["seen_from_s", "seen_until_s"]].drop_duplicates().sort_values("seen_from_s")
    since_s = np.maximum.accumulate(seen.seen_until_s.to_numpy())[:-1]
    until_s = seen.seen_from_s.to_numpy()[1:]
    return np.maximum(np.minimum(at_s[:, None], until_s) - since_s, 0.0).sum(axis=1)


def _rate(steps: pd.DataFrame, landed: pd.DataFrame) -> tuple[float, float, str, int, str]:
    """Return the landings per second of the time in which both feet are seen.

    A landing counts if both are seen from the one before: in a gap nobody knows of landings.
    """
    feet = len(footwork.FEET)
    spans = zip(landed.onset_s, landed.onset_s.shift(1), strict=True)
    seen = np.array(
        [
            steps.foot[(steps.seen_from_s < since) & (steps.seen_until_s >= at)].nunique() == feet
            for at, since in spans
        ]
    )
    n, lasts = int(seen.sum()), float(landed.onset_s.diff()[seen].sum())
    counted = seen.astype(float) - np.append(seen[1:], False)  # each onset, in the sum of times
    spread = float(np.sqrt(counted**2 @ landed.onset_sigma_s**2))
    rate = n / lasts if n else NAN
    words = "landings per second of the time in which both feet are seen"
    return rate, rate * spread / lasts if n else NAN, "1/s", n, words


def _path(steps: pd.DataFrame) -> tuple[float, float]:
    """Return the length of the path of the body, m, and its standard deviation.

    The body is between the feet: the path goes through the middle of each landing and the one
    before. An error of one place moves it by half, where the path turns.
    """
    xy, sigma = steps[["x_m", "y_m"]].to_numpy(), steps.sigma_m.to_numpy()
    middle = (xy[1:] + xy[:-1]) / 2
    legs = np.diff(middle, axis=0)
    length = np.linalg.norm(legs, axis=1)
    along = legs / np.maximum(length, 1e-9)[:, None]
    by_middle = np.zeros_like(middle)
    by_middle[1:] += along
    by_middle[:-1] -= along
    by_place = np.zeros_like(xy)
    by_place[1:] += by_middle / 2
    by_place[:-1] += by_middle / 2
    return float(length.sum()), float(np.sqrt((by_place**2).sum(axis=1) @ sigma**2))
