"""T-poses and claps before a single camera, and free motion on the spot between them."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from virtualgym.movement import footwork, tpose_clap, upper_body
from virtualgym.movement import player as performance
from virtualgym.movement.footwork import Station
from virtualgym.movement.player import Motion, Player
from virtualgym.movement.upper_body import Pose

# ASSUME: durations and amplitudes of the figures were chosen to look natural; no source is
# recorded.
PLACE = -0.65  # of half the court's length from the net: room for a camera before the player
REST_S, PAUSE_S = (0.8, 1.2), (0.15, 0.4)
PACE = 0.85, 1.2  # factor on a figure's duration
STAND = upper_body.STAND


@dataclass(frozen=True, eq=False)
class Figure:
    """One exercise.

    Attributes
    ----------
    moves : tuple of (float, Pose)
        Times, s from the start, and poses; it ends standing.
    steps : tuple of (float, float, float, float, float, int)
        Times at which the feet leave and arrive, s; left and forward of the start, m; turn to the
        left, deg; number of steps.
    lasts_s : float
    """

    moves: tuple[tuple[float, Pose], ...]
    steps: tuple[tuple[float, float, float, float, float, int], ...]
    lasts_s: float


def perform(
    player: Player, *, free_s: float = 20.0, claps: int = 2, bouncing: bool = False
) -> Motion:
    """Stand facing the net, T-pose, clap; move freely on the spot; T-pose, clap; and so on.

    Without a racket.

    Parameters
    ----------
    player : Player
    free_s : float
        Longest total duration of free motion, which the claps divide evenly: raised arms, bent
        elbows, twists and turns, squats, steps in place and aside. Each clap adds about 6 s.
    claps : int
        One or more; free motion comes after a single one.
    bouncing : bool
        The hands rebound from each clap and touch again.

    Returns
    -------
    motion : Motion
        Events as `tpose_clap.events` names them, numbered from 1.

    Raises
    ------
    ValueError
        If there is no clap.
    """
    if claps < 1:
        raise ValueError(f"expected claps >= 1, found {claps}")
    rng, script = player.rng, _Script(player)
    time_s, done = rng.uniform(*REST_S), []
    events: dict[str, float] = {}
    for number in range(1, claps + 1):
        done.append(tpose_clap.perform(time_s, player.proportions, rng, bouncing=bouncing))
        events |= tpose_clap.events(done[-1], number)
        time_s = done[-1].end_s + rng.uniform(*PAUSE_S)
        if number < max(claps, 2):
            time_s = script.fill(time_s, free_s / max(claps - 1, 1))
    end_s = time_s + rng.uniform(*REST_S)
    stations = script.stations(end_s)
    route, feet = footwork.plan(stations, player.proportions, rng, cadence_hz=2.0, air=0.78)
    keys = [(0.0, STAND), *script.keys, (end_s, STAND)]
    return player.motion(
        end_s,
        route,
        feet,
        upper_body.course(keys, rng, scatter=0.0),  # level arms and an upright trunk
        events=events,
        arms=tpose_clap.Arms(tuple(done)),
        racket=False,
        reach=performance.STANDING_REACH,
    )


class _Script:
    """The poses and steps so far, to which figures are added."""

    def __init__(self, player: Player) -> None:
        self.rng = player.rng
        self.keys: list[tuple[float, Pose]] = []
        self.place = np.array([0.0, PLACE * player.half_m[1]]) + self.rng.uniform(-0.2, 0.2, 2)
        self._gone: list[Station] = []
        self._now: tuple[float, NDArray, float, int | None] = (0.0, self.place, 0.0, None)

    def fill(self, time_s: float, lasts_s: float) -> float:
        """Add figures while there is time for one; return the time after the last."""
        end_s, left_out = time_s + lasts_s, 0
        waiting: list[str] = []
        while left_out < len(FIGURES):
            waiting = waiting or self.rng.permutation(sorted(FIGURES)).tolist()
            name, side = waiting.pop(), self.rng.choice([-1.0, 1.0])
            figure, pace = FIGURES[name](side, self.rng), self.rng.uniform(*PACE)
            if time_s + pace * figure.lasts_s > end_s:
                left_out += 1
                continue
            self._add(figure, time_s, pace)
            time_s += pace * figure.lasts_s + self.rng.uniform(*PAUSE_S)
        return time_s

    def stations(self, end_s: float) -> list[Station]:
        """Return all stations, the last one until the end."""
        return [*self._gone, self._station(end_s)]

    def _add(self, figure: Figure, start_s: float, pace: float) -> None:
        self.keys.append((start_s, STAND))
        self.keys += [(start_s + pace * at_s, pose) for at_s, pose in figure.moves]
        self.keys.append((start_s + pace * figure.lasts_s, STAND))
        for leave_s, arrive_s, left, forward, turned_deg, steps in figure.steps:
            self._gone.append(self._station(start_s + pace * leave_s))
            place = self.place + np.array([-left, forward])  # looking along y, left is -x
            arrive_s = start_s + pace * arrive_s
            self._now = arrive_s, place, np.radians(turned_deg), steps

    def _station(self, leave_s: float) -> Station:
        arrive_s, place, heading, steps = self._now
        return Station(
            arrive_s, leave_s, place, heading, feet=footwork.UPRIGHT, settle_s=0.1, steps=steps
        )


def _both(
    upper_arm: upper_body.Vector,
    forearm: upper_body.Vector,
    palm: upper_body.Vector,
    **changes: Any,
) -> Pose:
    """Return a pose with both arms alike; the vectors are those of the left arm."""
    left = upper_body.Arm(upper_arm, forearm, palm)
    return STAND.but(left=left, right=upper_body.mirror(left), **changes)


def _one(side: float, pose: Pose) -> Pose:
    """Return the pose of one arm only, 1: left, -1: right; the other hangs."""
    return pose.but(right=STAND.right) if side > 0 else pose.but(left=STAND.left)


OUT = _both((1.0, 0.05, 0.1), (1.0, 0.1, 0.12), (0.1, -1.0, 0.1))
UP = _both((0.2, 0.97, 0.1), (0.05, 1.0, 0.05), (-1.0, 0.0, 0.1))
FRONT = _both((0.1, 0.0, 1.0), (0.02, 0.05, 1.0), (0.0, -1.0, 0.1))
CURL = _both((0.16, -0.97, 0.1), (0.1, 0.62, 0.78), (-0.1, 0.78, -0.62))
LEVEL = _both((0.2, -0.97, 0.1), (0.1, 0.05, 1.0), (-1.0, 0.0, 0.1))
BEFORE_CHEST = _both((0.25, -0.55, 0.8), (-0.75, 0.5, 0.4), (-0.3, -0.1, -0.9))
SQUAT = FRONT.but(height=0.68, lean=30.0, look=(0.0, 4.0))


def _arms_up(side: float, rng: np.random.Generator) -> Figure:
    return Figure(((0.9, OUT), (1.7, UP), (2.2, UP), (3.0, OUT)), (), 3.9)


def _arms_front(side: float, rng: np.random.Generator) -> Figure:
    return Figure(((0.9, FRONT), (1.3, FRONT), (2.1, OUT), (2.5, OUT)), (), 3.4)


def _elbows(side: float, rng: np.random.Generator) -> Figure:
    moves = ((0.6, LEVEL), (1.1, CURL), (1.6, LEVEL), (2.1, CURL), (2.7, LEVEL))
    return Figure(moves, (), 3.3)


def _reach_across(side: float, rng: np.random.Generator) -> Figure:
    crossed = _one(side, BEFORE_CHEST)
    return Figure(((0.9, crossed), (1.4, crossed)), (), 2.3)


def _twist(side: float, rng: np.random.Generator) -> Figure:
    turned = rng.uniform(20, 35)
    moves = [
        (at_s, LEVEL.but(twist=sign * turned, look=(sign * 0.6 * turned, 0.0)))
        for at_s, sign in ((0.9, side), (2.1, -side))
    ]
    return Figure((*moves, (2.8, LEVEL)), (), 3.4)


def _squats(side: float, rng: np.random.Generator) -> Figure:
    deep = SQUAT.but(height=rng.uniform(0.64, 0.76))
    return Figure(((0.9, deep), (1.2, deep), (2.1, FRONT), (3.0, deep)), (), 4.0)


def _one_arm_up(side: float, rng: np.random.Generator) -> Figure:
    out, up = _one(side, OUT), _one(side, UP)
    return Figure(((0.8, out), (1.5, up), (1.9, up), (2.6, out)), (), 3.4)


def _turn(side: float, rng: np.random.Generator) -> Figure:
    turned = side * rng.uniform(35, 75)
    steps = ((0.1, 1.3, 0.0, 0.0, turned, 4), (2.4, 3.6, 0.0, 0.0, 0.0, 4))
    return Figure(((1.6, LEVEL), (2.2, CURL)), steps, 3.8)


def _steps_in_place(side: float, rng: np.random.Generator) -> Figure:
    return Figure((), ((0.1, 3.1, 0.0, 0.0, 0.0, 6),), 3.3)


def _side_step(side: float, rng: np.random.Generator) -> Figure:
    aside = side * rng.uniform(0.25, 0.4)
    ahead = rng.uniform(-0.25, 0.25)
    steps = ((0.1, 1.0, aside, ahead, 0.0, 2), (1.9, 2.8, 0.0, 0.0, 0.0, 2))
    return Figure(((1.4, OUT),), steps, 3.1)


FIGURES = {
    "arms_up": _arms_up,
    "arms_front": _arms_front,
    "elbows": _elbows,
    "reach_across": _reach_across,
    "twist": _twist,
    "squats": _squats,
    "one_arm_up": _one_arm_up,
    "turn": _turn,
    "steps_in_place": _steps_in_place,
    "side_step": _side_step,
}
