"""Footwork: where and when the feet are planted, and how they move in between."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from virtualgym.body.stance import OTHER, Proportions
from virtualgym.movement import easing, two_bone_ik

Footfall = tuple[float, NDArray, float, bool]  # time of landing, place (2,) m, yaw, after a hop
OWN = {"left": 1.0, "right": -1.0}  # side on the body's x axis
# ASSUME: gait values chosen to look natural and to keep the legs apart; no source is recorded.
HALF_TRACK_M = 0.11  # of a foot from the pelvis's path, walking
GAP_M = 0.13  # a landing foot stays at least this far on its own side of the other
FURTHEST_M = 0.32  # but is moved no further than this to do so
ROLL_SHARE = 0.45  # share of a stance phase, at its end, on the toes
RAMP_S = 0.9  # longest time to reach walking speed
HOP_APART_S = 0.03  # both feet leave, and land, in a hop within this
HOP_ROLL_S = 0.08  # before a hop the heels rise
TURN_SHARE = 0.7  # share of a trip in which the body turns
# Feet at a station: left, forward (m) of the pelvis, yaw (rad).
WIDE = {"left": (0.24, 0.05, 0.25), "right": (-0.24, -0.03, -0.25)}
UPRIGHT = {"left": (0.10, 0.0, 0.12), "right": (-0.10, 0.0, -0.12)}
LUNGE = {"left": (0.10, -0.55, 0.75), "right": (-0.10, 0.37, 0.0)}


@dataclass(frozen=True)
class Station:
    """A stop: the pelvis rests, both feet stand.

    Attributes
    ----------
    arrive_s, leave_s : float
        The last foot lands; the first foot leaves.
    place : (2,) float
        Of the pelvis, metres.
    heading : float
        Radians, anticlockwise from above; 0 looks along y.
    feet : dict of str to (left, forward, yaw)
        Of each foot relative to the pelvis and the heading, metres and radians.
    lead : str
        The foot that lands last.
    settle_s : float
        Time after the landing in which the pelvis still moves.
    steps : int or None
        Number of steps on the way here; None: from the duration.
    hop : bool
        Both feet come here at once: the last leaves when the station before is left, the first
        lands at `arrive_s`.
    """

    arrive_s: float
    leave_s: float
    place: np.ndarray
    heading: float
    feet: dict = field(default_factory=lambda: WIDE)
    lead: str = "right"
    settle_s: float = 0.12
    steps: int | None = None
    hop: bool = False


@dataclass(frozen=True, eq=False)
class Route:
    """The pelvis over the floor: at rest at each station, one smooth move to the next."""

    stations: tuple[Station, ...]
    _table: dict[str, NDArray] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        pairs = list(pairwise(self.stations))
        lasts = np.array([b.arrive_s + b.settle_s - a.leave_s for a, b in pairs])
        table = {
            "start": np.array([a.leave_s for a, _ in pairs]),
            "lasts": lasts,
            "ramp": np.minimum(easing.RAMP, RAMP_S / lasts),
            "moves": np.array([b.place - a.place for a, b in pairs]).reshape(-1, 2),
            "turns": np.array([b.heading - a.heading for a, b in pairs]),
            "late": np.array([_turns_late(a, b) for a, b in pairs]),
        }
        object.__setattr__(self, "_table", table)

    def at(self, time_s: float) -> tuple[NDArray, float]:
        """Return place (2,) m and heading (radians) at a time."""
        table, first = self._table, self.stations[0]
        x = (time_s - table["start"]) / table["lasts"]
        moved = easing.ease(x, table["ramp"])
        turned = easing.ease((x - table["late"]) / TURN_SHARE)
        return first.place + moved @ table["moves"], first.heading + turned @ table["turns"]


def _turns_late(before: Station, after: Station) -> float:
    """Return the share of the trip after which the turn begins: the body faces its way longest."""
    way = after.place - before.place
    if np.linalg.norm(way) < 0.1:
        return (1 - TURN_SHARE) / 2
    headings = before.heading, after.heading
    along = [abs(way @ two_bone_ik.facing(heading)[:2, 2]) for heading in headings]
    return 0.0 if along[1] >= along[0] else 1 - TURN_SHARE


@dataclass(frozen=True, eq=False)
class Lap:
    """The pelvis along a curve, facing forwards, from rest to rest.

    Attributes
    ----------
    corners : (n, 2) float
        The curve passes through them, metres.
    start_s, stop_s : float
    length_m : float
        Of the curve.
    """

    corners: np.ndarray
    start_s: float
    stop_s: float
    length_m: float = field(init=False)
    _curve: CubicSpline = field(init=False, repr=False)
    _heading: CubicSpline = field(init=False, repr=False)

    def __post_init__(self) -> None:
        chords = np.linalg.norm(np.diff(self.corners, axis=0), axis=1)
        rough = CubicSpline(np.append(0.0, chords.cumsum()), self.corners)
        fine = np.linspace(0, chords.sum(), 100 * len(self.corners))
        along = np.append(0.0, np.linalg.norm(np.diff(rough(fine), axis=0), axis=1).cumsum())
        object.__setattr__(self, "_curve", CubicSpline(along, rough(fine)))
        slopes = self._curve(along, 1)
        headings = np.unwrap(np.arctan2(-slopes[:, 0], slopes[:, 1]))
        object.__setattr__(self, "_heading", CubicSpline(along, headings))
        object.__setattr__(self, "length_m", along[-1])

    def at(self, time_s: float) -> tuple[NDArray, float]:
        """Return place (2,) m and heading (radians) at a time."""
        lasts = self.stop_s - self.start_s
        ramp = min(0.5, RAMP_S / lasts)
        along = self.length_m * easing.ease((time_s - self.start_s) / lasts, ramp)
        return self._curve(along), float(self._heading(along))

    def ends(self, arrive_s: float, leave_s: float) -> list[Station]:
        """Return the stations, standing, before its start (from `arrive_s`) and after its end."""
        stations = []
        for time_s, start_s, stop_s in (
            (self.start_s, arrive_s, self.start_s),
            (self.stop_s, self.stop_s, leave_s),
        ):
            place, heading = self.at(time_s)
            stations.append(Station(start_s, stop_s, place, heading, feet=UPRIGHT, settle_s=0.0))
        return stations


def plan(
    stations: Sequence[Station],
    proportions: Proportions,
    rng: np.random.Generator,
    *,
    cadence_hz: float = 3.4,
    air: float = 0.95,
    route: Lap | None = None,
) -> tuple[Route | Lap, dict[str, "Foot"]]:
    """Plan the steps from station to station.

    Parameters
    ----------
    stations : sequence of Station
        In order of time.
    proportions : Proportions
    rng : numpy.random.Generator
        Footfalls scatter by centimetres.
    cadence_hz : float
        Steps per second on the way.
    air : float
        Duration of a swing over that of a step: below 1 both feet stand in between, above 1
        neither.
    route : Lap or None
        The path of the pelvis; None: straight from station to station.

    Returns
    -------
    route : Route or Lap
    feet : dict of str to Foot
    """
    path = route or Route(tuple(stations))
    first = stations[0]
    falls: dict[str, list[Footfall]]
    falls = {side: [(first.arrive_s, *_beside(first, side), False)] for side in OTHER}
    offs: dict[str, list[tuple[float, float]]] = {side: [] for side in OTHER}
    for before, after in pairwise(stations):
        if after.hop:
            _hop(before, after, (falls, offs), rng)
        else:
            _trip(path, before, after, (cadence_hz, air), (falls, offs), rng)
    plants, rolls = {}, {}
    for side in OTHER:
        ends = [*(off for off, _ in offs[side]), stations[-1].leave_s]
        plants[side] = [
            Plant(land, off, place, yaw, hop)
            for (land, place, yaw, hop), off in zip(falls[side], ends, strict=True)
        ]
        rolls[side] = [roll for _, roll in offs[side]]
    return path, walk(plants, proportions, rolls=rolls)


def _trip(
    route: Route | Lap,
    before: Station,
    after: Station,
    gait: tuple[float, float],
    record: tuple[dict[str, list[Footfall]], dict[str, list[tuple[float, float]]]],
    rng: np.random.Generator,
) -> None:
    """Add the footfalls and toe-offs of one trip to the record."""
    cadence_hz, air = gait
    falls, offs = record
    lasts = after.arrive_s - before.leave_s
    n_steps = after.steps or max(2, round(lasts * cadence_hz))
    beat = lasts / (n_steps - 1 + air)
    for k in range(n_steps):
        side = after.lead if (n_steps - 1 - k) % 2 == 0 else OTHER[after.lead]
        off = before.leave_s + k * beat
        land = off + air * beat
        if k >= n_steps - 2:
            place, yaw = _beside(after, side)
        else:
            place, yaw = _below(route, (land, off + 2 * beat), side, rng)
            place = _own_side(place, yaw, side, falls[OTHER[side]][-1][1])
        stood = off - falls[side][-1][0]
        stretched = k < 2 and before.feet is LUNGE and side != before.lead
        roll = off - before.arrive_s if stretched else ROLL_SHARE * min(stood, 0.5)
        offs[side].append((off, roll))
        falls[side].append((land, place, yaw, False))


def _hop(
    before: Station,
    after: Station,
    record: tuple[dict[str, list[Footfall]], dict[str, list[tuple[float, float]]]],
    rng: np.random.Generator,
) -> None:
    """Add the footfalls of a hop to the record: one foot leaves last, one lands first."""
    falls, offs = record
    early, late = rng.permutation([0.0, rng.uniform(0, HOP_APART_S)]), rng.uniform(0, HOP_APART_S)
    for side, sooner, later in zip(OTHER, early, rng.permutation([0.0, late]), strict=True):
        offs[side].append((before.leave_s - sooner, HOP_ROLL_S))
        falls[side].append((after.arrive_s + later, *_beside(after, side), True))


def _beside(station: Station, side: str) -> tuple[NDArray, float]:
    """Return place and yaw of a foot at a station."""
    left, forward, yaw = station.feet[side]
    axes = two_bone_ik.facing(station.heading)[:2]
    return station.place + left * axes[:, 0] + forward * axes[:, 2], station.heading + yaw


def _below(
    route: Route | Lap, stand_s: tuple[float, float], side: str, rng: np.random.Generator
) -> tuple[NDArray, float]:
    """Return place and yaw of a foot that stands between two times: below the pelvis's mean."""
    (first, _), (last, _) = (route.at(time_s) for time_s in stand_s)
    _, heading = route.at(sum(stand_s) / 2)
    left = two_bone_ik.facing(heading)[:2, 0]
    aside = OWN[side] * HALF_TRACK_M * left + rng.normal(0, 0.015, 2)
    return (first + last) / 2 + aside, heading + 0.12 * OWN[side]


def _own_side(place: NDArray, yaw: float, side: str, other: NDArray) -> NDArray:
    """Move a footfall so that the legs do not cross in sideways steps."""
    own = OWN[side] * two_bone_ik.facing(yaw)[:2, 0]
    return place + np.clip(GAP_M - (place - other) @ own, 0.0, FURTHEST_M) * own


# ASSUME: chosen to look natural, as above.
SLAP_S = 0.07  # from heel strike until the toes are down
CLEARANCE_M = 0.19  # between the centres of a swinging and a standing foot


@dataclass(frozen=True)
class Plant:
    """One stance phase of one foot.

    Attributes
    ----------
    land_s, off_s : float
        Landing, and toe-off.
    place : (2,) float
        Of the ankle while the foot is flat, metres.
    yaw : float
        Heading of the toes, radians.
    hop : bool
        The foot comes here in a hop of both: it flies as the body does, and lands without slowing.
    """

    land_s: float
    off_s: float
    place: np.ndarray
    yaw: float
    hop: bool = False


@dataclass(frozen=True, eq=False)
class Foot:
    """The path of one foot, from its plants.

    Attributes
    ----------
    plants : tuple of Plant
    roll_s : (n - 1,) float
        Time before each toe-off at which the heel begins to rise.
    aside : (n - 1, 2) float
        Detour of each swing round the standing foot, metres.
    ankle_m, length_m, toe_m : float
        Height of the ankle, length from ankle to the joint of the toes, height of that joint.
    """

    plants: tuple[Plant, ...]
    roll_s: np.ndarray
    aside: np.ndarray
    ankle_m: float
    length_m: float
    toe_m: float
    _table: dict[str, NDArray] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        before, after = self.plants[:-1], self.plants[1:]
        steps = np.array([b.place - a.place for a, b in zip(before, after, strict=True)])
        steps = steps.reshape(-1, 2)
        length = np.linalg.norm(steps, axis=1)
        off, land = (
            np.array(times)
            for times in ([p.off_s for p in before], [plant.land_s for plant in after])
        )
        hop = np.array([plant.hop for plant in after], bool)
        lift = np.clip(0.04 + 0.08 * length, 0.04, 0.12)
        table = {
            "off": off,
            "land": land,
            "hop": hop,
            "steps": steps,
            "turns": np.array([b.yaw - a.yaw for a, b in zip(before, after, strict=True)]),
            "lift": np.where(hop, easing.flight_m(land - off), lift),
            "heel": np.clip(0.15 + 0.6 * length, 0.15, 0.75),
            "toe": np.clip(0.3 * (length - 0.2), 0.0, 0.3),
        }
        object.__setattr__(self, "_table", table)

    def at(self, time_s: float) -> tuple[NDArray, NDArray, float]:
        """Return the ankle (3,) m, the direction to the toes (3,) and the lift m at a time."""
        table = self._table
        first, swing = self.plants[0], table["land"] - table["off"]
        x = (time_s - table["off"]) / swing if len(swing) else swing
        moved = easing.ease(x)
        place = first.place + moved @ table["steps"] + easing.bump(x) @ self.aside
        yaw = first.yaw + moved @ table["turns"]
        rise = np.where(table["hop"], easing.arc(x), easing.bump(x))
        lift = float(table["lift"] @ rise)
        heel = float(table["heel"] @ self._heel(time_s, x, swing))
        toe = float(table["toe"] @ self._toe(time_s, x, swing))
        forward, flat = np.array([-np.sin(yaw), np.cos(yaw)]), self._flat_slope()
        ball = np.append(place + self.length_m * np.cos(flat) * forward, self.toe_m)
        raised = two_bone_ik.facing(yaw) @ [0.0, np.sin(flat + heel), -np.cos(flat + heel)]
        ankle = ball + self.length_m * raised + [0.0, 0.0, lift]
        down = flat + heel - toe
        return ankle, np.append(np.cos(down) * forward, -np.sin(down)), lift

    def standing(self) -> NDArray:
        """Return the intervals (n, 2) s in which the foot is flat and its ankle still."""
        early = [
            *(plant.off_s - roll for plant, roll in zip(self.plants, self.roll_s, strict=False))
        ]
        stops = [*early, self.plants[-1].off_s]
        return np.array([(p.land_s, stop) for p, stop in zip(self.plants, stops, strict=True)])

    def _flat_slope(self) -> float:
        """Return the angle by which a flat foot points down, radians."""
        return np.arcsin((self.ankle_m - self.toe_m) / self.length_m)

    def _heel(self, time_s: float, x: NDArray, swing: NDArray) -> NDArray:
        """Return the heel's rise 0..1 at each step: up round the toes, down in the swing."""
        start = self._table["off"] - self.roll_s
        rise = easing.step((time_s - start) / (self.roll_s + 0.25 * swing))
        return rise * (1 - easing.step((x - 0.25) / 0.6))

    def _toe(self, time_s: float, x: NDArray, swing: NDArray) -> NDArray:
        """Return the rise 0..1 of the toes about the ankle at each step: the heel lands first."""
        fall = easing.step((time_s - self._table["land"]) / SLAP_S)
        return easing.step((x - 0.5) / 0.45) * (1 - fall)


def walk(
    plants: dict[str, list[Plant]], proportions: Proportions, *, rolls: dict[str, list[float]]
) -> dict[str, Foot]:
    """Make both feet from their plants.

    Parameters
    ----------
    plants : dict of str to list of Plant
        For "left" and "right", in order of time.
    proportions : Proportions
    rolls : dict of str to list of float
        Time before each swing at which the heel begins to rise, s; limited by the stance phase.
    """
    feet = {}
    for side, other in (("left", "right"), ("right", "left")):
        mine = plants[side]
        roll = [
            max(0.02, min(wanted, plant.off_s - plant.land_s - SLAP_S))
            for wanted, plant in zip(rolls[side], mine[:-1], strict=True)
        ]
        aside = [_detour(a, b, plants[other], side) for a, b in pairwise(mine)]
        feet[side] = Foot(
            plants=tuple(mine),
            roll_s=np.array(roll),
            aside=np.array(aside).reshape(-1, 2),
            ankle_m=proportions.ankle_height,
            length_m=proportions.foot,
            toe_m=proportions.toe_height,
        )
    return feet


def _detour(before: Plant, after: Plant, others: list[Plant], side: str) -> NDArray:
    """Return the detour (2,) m of a swing to its own side, past the standing leg."""
    middle = (before.off_s + after.land_s) / 2
    standing = min(others, key=lambda plant: abs((plant.land_s + plant.off_s) / 2 - middle))
    way = after.place - before.place
    share = np.clip((standing.place - before.place) @ way / max(way @ way, 1e-9), 0, 1)
    yaw = (before.yaw + after.yaw) / 2
    left = np.array([-np.cos(yaw), -np.sin(yaw)])
    own = left if side == "left" else -left
    gap = (before.place + share * way - standing.place) @ own
    return own * np.clip(CLEARANCE_M - gap, 0.0, 0.25) * easing.bump(np.clip(share, 0.2, 0.8))
