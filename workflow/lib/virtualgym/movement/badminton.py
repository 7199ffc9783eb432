"""Badminton drills: run to a corner of the own half, play a stroke, return to the base."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from virtualgym.movement import footwork, upper_body
from virtualgym.movement.footwork import Station
from virtualgym.movement.player import Motion, Player

# ASSUME: places, speeds and durations of a club player's drill; no source is recorded.
BASE = (0.0, -0.53)  # as fractions of half the court's width, and of half its length from the net
REAR_FEET = {"left": (0.27, 0.02, 0.35), "right": (-0.29, -0.02, -0.2)}
SPEED_M_S = (1.35, 1.7)  # mean speed of a trip; the highest is 1.5 times that
LEAST_S = 0.75  # of a trip
PLACE_M = 0.12  # scatter of the corners: two standard deviations
PREPARED_S = 0.2  # before the arrival the arm is raised for an overhead stroke
SWING_S = (0.13, 0.15)  # from the cocked arm to the hit
FOLLOW_SWINGS = 1.75  # from the hit to the end of the follow-through, in swing durations
HALF_WINDOW_S = 8 / 30  # half of a hit's 16 or 17 frames at 30 fps
CADENCE_HZ = 3.8


@dataclass(frozen=True)
class Corner:
    """Where a stroke is played: place in the units of BASE, heading in degrees, kind of stroke."""

    place: tuple
    heading_deg: float
    stroke: str


CORNERS = {
    "front_right": Corner((0.50, -0.29), -40, "net"),
    "front_left": Corner((-0.50, -0.29), 40, "net"),
    "mid_right": Corner((0.52, -0.52), -62, "side"),
    "mid_left": Corner((-0.52, -0.52), 66, "side"),
    "rear_right": Corner((0.48, -0.80), -72, "overhead"),
    "rear_left": Corner((-0.42, -0.80), -58, "overhead"),
}


class Drill:
    """A player's stations, poses and events, added one after another.

    Parameters
    ----------
    player : Player
    swing : float
        Duration of strokes over that of real ones; above 1 they are only indicated.
    """

    cadence_hz = CADENCE_HZ

    def __init__(self, player: Player, swing: float = 1.0) -> None:
        rng, self.half_m = player.rng, player.half_m
        self.player, self.rng, self.swing = player, rng, swing
        base = self._at(BASE)
        self.stations = [Station(0.0, rng.uniform(0.6, 0.9), base, rng.normal(0, 0.05))]
        self.keys = [(0.0, upper_body.READY), (self.time_s - 0.1, low(rng))]
        self.events: dict[str, float] = {}

    @property
    def time_s(self) -> float:
        """Time at which the player leaves the last station."""
        return self.stations[-1].leave_s

    def visit(self, name: str) -> None:
        """Go to a corner, play the stroke there, and come back to the base."""
        corner = CORNERS[name]
        heading = np.radians(corner.heading_deg + self.rng.normal(0, 4))
        place, start = self._at(corner.place), self.time_s
        arrive = start + self._lasts(place)
        self.keys.append((start + 0.35 * (arrive - start), upper_body.RUN))
        play = {"net": self._net, "side": self._side, "overhead": self._overhead}
        play[corner.stroke](arrive, place, heading)
        self._return()

    def finish(self, **options: Any) -> Motion:
        """Return the motion, which ends with a rest at the base; `options` of `Player.motion`."""
        last = self.stations[-1]
        stop = last.arrive_s + 0.9
        self.stations[-1] = replace(last, leave_s=stop)
        self.keys[-1] = (stop, upper_body.READY)
        route, feet = footwork.plan(
            self.stations, self.player.proportions, self.rng, cadence_hz=self.cadence_hz
        )
        course = upper_body.course(self.keys, self.rng)
        return self.player.motion(stop, route, feet, course, events=self.events, **options)

    def _net(
        self,
        arrive: float,
        place: NDArray,
        heading: float,
        pose: upper_body.Pose = upper_body.NET_REACH,
    ) -> None:
        self._reach(arrive, arrive + self.rng.uniform(0.12, 0.2), place, heading, pose)

    def _side(self, arrive: float, place: NDArray, heading: float) -> None:
        self._net(arrive, place, heading, upper_body.SIDE_REACH)

    def _overhead(self, arrive: float, place: NDArray, heading: float) -> None:
        swing = self.swing * self.rng.uniform(*SWING_S)
        hit = max(arrive + 0.32, arrive - PREPARED_S + 2.6 * swing) + self.rng.uniform(0, 0.12)
        self._strike(arrive, hit, place, heading, swing)

    def _reach(
        self, arrive: float, hit: float, place: NDArray, heading: float, pose: upper_body.Pose
    ) -> None:
        """Arrive in a lunge and reach for the shuttle."""
        leave = hit + self.rng.uniform(0.1, 0.2)
        self._stay(arrive, leave, place, heading, feet=footwork.LUNGE, settle_s=0.24)
        self.keys += [(arrive - 0.06, pose.but(height=0.82, lean=20)), (hit, pose), (leave, pose)]
        self._hit(hit)

    def _strike(
        self, arrive: float, hit: float, place: NDArray, heading: float, swing: float
    ) -> None:
        """Arrive sideways and strike above the head."""
        prepared = arrive - PREPARED_S
        self._stay(arrive, hit + 0.05, place, heading, feet=REAR_FEET, settle_s=0.2)
        self.keys += [
            (prepared, upper_body.PREPARE),
            (hit - 1.9 * swing, upper_body.PREPARE),
            (hit - swing, upper_body.COCKED),
            (hit, upper_body.IMPACT),
            (hit + FOLLOW_SWINGS * swing, upper_body.FOLLOW),
        ]
        self._hit(hit)

    def _stay(
        self, arrive: float, leave: float, place: NDArray, heading: float, **options: Any
    ) -> None:
        self.stations.append(Station(arrive, leave, place, heading, lead="right", **options))

    def _hit(self, time_s: float) -> None:
        hits = [name for name in self.events if name.startswith("hit_")]
        number = 1 + sum(name.endswith("_start") for name in hits)
        self.events[f"hit_{number}"] = time_s
        self.events[f"hit_{number}_start"] = time_s - HALF_WINDOW_S
        self.events[f"hit_{number}_stop"] = time_s + HALF_WINDOW_S

    def _return(self) -> None:
        """Return to the base, the right foot first, and get ready."""
        place, start = self._at(BASE, 0.08), self.time_s
        arrive = start + self._lasts(place)
        steps = max(2, round((arrive - start) * self.cadence_hz))
        leave = arrive + self.rng.uniform(0.3, 0.5)
        lead = "right" if steps % 2 else "left"
        heading = self.rng.normal(0, 0.05)
        self.stations.append(Station(arrive, leave, place, heading, lead=lead, steps=steps))
        run = max(start + 0.5 * (arrive - start), self.keys[-1][0] + 0.25)
        self.keys += [
            (run, upper_body.RUN),
            (max(arrive, run + 0.1), upper_body.READY),
            (leave - 0.05, low(self.rng)),
        ]

    def _at(self, share: tuple[float, float], scatter_m: float = PLACE_M) -> NDArray:
        return np.array(share) * self.half_m + self.rng.normal(0, scatter_m / 2, 2)

    def _lasts(self, place: NDArray) -> float:
        """Return the duration of the trip from the last station."""
        way = float(np.linalg.norm(place - self.stations[-1].place))
        return max(LEAST_S, way / self.rng.uniform(*SPEED_M_S))


def rounds(player: Player, seconds: float = 21.0, swing: float = 1.0) -> Motion:
    """Visit all corners in random order, again and again, for at least `seconds`.

    `swing` is as of `Drill`. Events: hit_1, hit_1_start, hit_1_stop, hit_2 ...
    """
    drill = Drill(player, swing)
    names: list[str] = []
    while drill.time_s < seconds:
        names = names or player.rng.permutation(list(CORNERS)).tolist()
        drill.visit(names.pop())
    return drill.finish()


def visits(player: Player, names: Iterable[str]) -> Motion:
    """Visit corners in this order, with strokes at full speed."""
    drill = Drill(player)
    for name in names:
        drill.visit(name)
    return drill.finish()


def low(rng: np.random.Generator) -> upper_body.Pose:
    """Return the crouch from which a player starts."""
    return upper_body.READY.but(height=0.83 + rng.normal(0, 0.01), lean=25)
