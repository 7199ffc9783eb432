"""T-pose and clap: straight arms out to the sides, to the front until the palms meet, and down."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from virtualgym.body.stance import Proportions
from virtualgym.movement import easing, two_bone_ik

# ASSUME: durations and speeds chosen to look natural; no source is recorded.
RAISE_S, STILL_S = (0.8, 1.1), (1.2, 1.8)
CLOSE_S, HOLD_S, LOWER_S = (0.45, 0.65), (0.27, 0.38), (0.8, 1.1)
CONTACT_M_S = (1.0, 1.6)  # speed of each wrist when the palms touch
GIVE_S = 0.008  # from first touch until the palms are at rest
REBOUND = (0.55, 0.7)  # speed after a contact over that before it
OUT_S = (0.13, 0.18), (0.08, 0.12)  # between contacts
OPEN_RAD, OPEN_S = 0.5, 0.35
OUT_TO_SIDE = {"left": 1.0, "right": -1.0}


@dataclass(frozen=True, eq=False)
class Clap:
    """One T-pose and clap.

    Attributes
    ----------
    raise_s, still_s, close_s, lower_s, end_s : float
        The arms begin to rise; are out and still; begin to close; begin to drop; hang.
    contacts_s : tuple of float
        Times of the palms' first touch, and of one after each rebound.
    azimuth : easing.Glide
        Of the arms, from the side (0) to the front (pi / 2) and beyond, radians.
    """

    raise_s: float
    still_s: float
    close_s: float
    lower_s: float
    end_s: float
    contacts_s: tuple[float, ...]
    azimuth: easing.Glide

    def weight(self, time_s: float) -> float:
        """Return the weight 0..1 of this clap in the arms' pose."""
        rise = easing.step((time_s - self.raise_s) / (self.still_s - self.raise_s))
        return rise - easing.step((time_s - self.lower_s) / (self.end_s - self.lower_s))


@dataclass(frozen=True, eq=False)
class Arms:
    """Both arms during claps, in the axes of the thorax."""

    claps: tuple[Clap, ...]

    def blend(self, rows: dict[str, NDArray], time_s: float) -> dict[str, NDArray]:
        """Return rows (4, 3) of both arms (see `upper_body.ARM_ROWS`), blended with the claps'."""
        for clap in self.claps:
            weight = clap.weight(time_s)
            if weight > 0:
                own = straight(clap.azimuth.at(time_s))
                rows = {side: _mixed(rows[side], own[side], weight) for side in rows}
        return rows


def straight(azimuth: float) -> dict[str, NDArray]:
    """Return rows (4, 3) of both arms, level and straight, at an angle from side to front, radians.

    The palms face down in the T-pose, and each other where the arms are in front.
    """
    rows = {}
    turn = easing.step(2 * azimuth / np.pi) * np.pi / 2
    for side, sign in OUT_TO_SIDE.items():
        way = np.array([sign * np.cos(azimuth), 0.0, np.sin(azimuth)])
        closing = np.array([-sign * np.sin(azimuth), 0.0, np.cos(azimuth)])
        palm = np.sin(turn) * closing - np.cos(turn) * np.array([0.0, 1.0, 0.0])
        rows[side] = np.array([way, way, way, palm])
    return rows


def perform(
    start_s: float, proportions: Proportions, rng: np.random.Generator, *, bouncing: bool = False
) -> Clap:
    """Schedule a T-pose and clap from `start_s`; if bouncing, the hands touch three times."""
    still_s = start_s + rng.uniform(*RAISE_S)
    close_s = still_s + rng.uniform(*STILL_S)
    times, speeds, contacts = _closing(close_s, proportions, rng)
    if bouncing:
        _rebound(times, speeds, contacts, rng)
    times.append(contacts[-1] + GIVE_S)
    speeds.append(0.0)
    open_s = contacts[-1] + rng.uniform(*HOLD_S)
    times += [open_s, open_s + OPEN_S / 2, open_s + OPEN_S]
    speeds += [0.0, -2 * OPEN_RAD / OPEN_S, 0.0]
    lower_s = open_s + 0.1
    return Clap(
        raise_s=start_s,
        still_s=still_s,
        close_s=close_s,
        lower_s=lower_s,
        end_s=lower_s + rng.uniform(*LOWER_S),
        contacts_s=tuple(contacts),
        azimuth=easing.Glide(times, speeds),
    )


def events(clap: Clap, number: int) -> dict[str, float]:
    """Return the true times of a clap by name: the T-pose's start and stop, and each contact."""
    named = {f"tpose_{number}_start": clap.still_s, f"tpose_{number}_stop": clap.close_s}
    named[f"clap_{number}"] = clap.contacts_s[0]
    for k, time_s in enumerate(clap.contacts_s[1:], 1):
        named[f"clap_{number}_rebound_{k}"] = time_s
    return named


def closed(proportions: Proportions) -> float:
    """Return the angle from the side, radians, at which the palms of straight arms meet."""
    arm = proportions.upper_arm + proportions.forearm
    return np.pi / 2 + np.arcsin((proportions.shoulder_width / 2 - proportions.palm) / arm)


def _closing(
    close_s: float, proportions: Proportions, rng: np.random.Generator
) -> tuple[list[float], list[float], list[float]]:
    """Return times and speeds of the arms up to the first contact, and that contact's time."""
    lasts = rng.uniform(*CLOSE_S)
    touching = rng.uniform(*CONTACT_M_S) / (proportions.upper_arm + proportions.forearm)
    way = closed(proportions) - touching * GIVE_S / 2
    fastest = 2 * (way / lasts - touching / 4)
    contact = close_s + lasts
    return [close_s, close_s + lasts / 2, contact], [0.0, fastest, touching], [contact]


def _rebound(
    times: list[float], speeds: list[float], contacts: list[float], rng: np.random.Generator
) -> None:
    """Add rebounds in place: stop, apart, together until the next contact."""
    for out_s in OUT_S:
        speed = speeds[-1]
        stop = contacts[-1] + GIVE_S
        slower = speed * rng.uniform(*REBOUND)
        contacts.append(stop + GIVE_S + rng.uniform(*out_s))
        times += [stop, stop + GIVE_S, contacts[-1]]
        speeds += [0.0, -slower, slower]


def _mixed(rows: NDArray, own: NDArray, weight: float) -> NDArray:
    mixed = (1 - weight) * rows + weight * own
    return np.array([two_bone_ik.unit(row) for row in mixed])
