"""Walking: a round, or up and down a lane past another player; standing beside the lanes."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from virtualgym.movement import footwork, upper_body
from virtualgym.movement.footwork import Lap, Station
from virtualgym.movement.player import STANDING_REACH, Motion, Player
from virtualgym.movement.upper_body import Pose

# ASSUME: usual walking speeds and durations; no source is recorded.
WALK_M_S = (1.0, 1.25)
WALK_HZ, WALK_AIR = 2.0, 0.78
REST_S = (0.5, 0.8)
LANE_M = 0.5  # of each of two crossing players from the line between them
# End of a lane, as fractions of half the court's width and of a quarter of its length.
LANE_SHARE = 0.6, 0.5
LANE_M_S = (0.98, 1.06)  # a narrow range, so that the players keep meeting
TURN_S, TURN_STEPS = 2.2, 4
ASIDE_M = 1.6  # of who stands from the line between the lanes
SWAY_S, SWAY = 1.5, 0.3  # who stands sways: between poses, by this share of the usual deviations
BESIDE_M = 1.0, 2.0  # of who strolls from a side line
STROLL_SHARE = 0.9  # of half the court's length: where a stroll turns


def large_round(player: Player) -> Motion:
    """Walk round the player's half, racket in hand."""
    rng, half_m = player.rng, player.half_m
    angles = rng.uniform(-0.3, 0.3) + np.linspace(-0.42, 0.42, 7) * 2 * np.pi
    reach = rng.uniform(0.5, 0.65, len(angles))[:, None]
    wide = np.array([half_m[0], 0.48 * half_m[1]])
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    corners = np.array([0.0, -0.5 * half_m[1]]) + reach * wide * circle
    rest = rng.uniform(*REST_S, 2)
    walking_s = footwork.RAMP_S + Lap(corners, 0.0, 1.0).length_m / rng.uniform(*WALK_M_S)
    lap = Lap(corners, rest[0], rest[0] + walking_s)
    return along(player, lap, lap.stop_s + rest[1], upper_body.WALK, scatter=0.6)


def small_round(player: Player, start_s: float, lasts_s: float) -> Lap:
    """Plan a round in the middle of the player's half; it ends where it began, facing the net."""
    rng = player.rng
    middle = np.array([0.0, -0.55 * player.half_m[1]]) + rng.uniform(-0.4, 0.4, 2)
    side = rng.choice([-1.0, 1.0])
    round_m = rng.uniform(0.8, 1.0)
    shape = [
        (0, 0),
        (0, 0.35),
        (0.15, 0.9),
        (0.9, 1.4),
        (1.6, 0.4),
        (0.95, -0.8),
        (0.2, -0.9),
        (0, -0.35),
        (0, 0),
    ]
    return Lap(middle + round_m * np.array(shape) * [side, 1.0], start_s, start_s + lasts_s)


def along(
    player: Player, lap: Lap, stop_s: float, walking: Pose, *, scatter: float, **options: Any
) -> Motion:
    """Walk along a curve.

    Parameters
    ----------
    player : Player
    lap : Lap
    stop_s : float
        End of the motion; from the lap's end until then the player stands.
    walking : Pose
    scatter : float
        See `upper_body.course`.
    **options
        Of `player.Motion`.
    """
    return _walk(player, lap.ends(0.0, stop_s), walking, scatter, lap, **options)


def up_and_down(player: Player, lane: int = 0, n_turns: int = 1) -> Motion:
    """Walk past another player, turn, and walk back; the other uses the other lane, the other way.

    The lanes are oblique to the court, so that the players occlude each other in views along either
    side.

    Parameters
    ----------
    player : Player
    lane : int
        0 or 1.
    n_turns : int
        The players cross once more than that.
    """
    if lane not in (0, 1):
        raise ValueError(f"expected lane 0 or 1, found {lane}")
    middle, end = _lanes(player)
    end = end if lane == 0 else -end
    return _to_and_fro(player, middle + _aside(end, LANE_M), end, n_turns)


def stroll(player: Player, seconds: float = 21.0) -> Motion:
    """Walk up and down outside of the court, beside the side line on the right of the half."""
    (wide, long), beside = player.half_m, player.rng.uniform(*BESIDE_M)
    end = np.array([0.0, STROLL_SHARE * long])
    n_turns = int(seconds * LANE_M_S[1] / (2 * end[1]))
    return _to_and_fro(player, np.array([wide + beside, 0.0]), end, n_turns)


def stand(player: Player, seconds: float = 21.0) -> Motion:
    """Stand beside the lanes, facing the net, and sway a little."""
    middle, end = _lanes(player)
    place = middle + _aside(end, ASIDE_M) + player.rng.uniform(-0.2, 0.2, 2)
    stations = [_stand(0.0, seconds, place, 0.0)]
    route, feet = footwork.plan(stations, player.proportions, player.rng)
    # Each key is a pose of its own: those that are the same object are held without a sway.
    times = np.arange(0.0, seconds + SWAY_S, SWAY_S)
    keys = [(float(time_s), upper_body.STAND.but()) for time_s in times]
    course = upper_body.course(keys, player.rng, scatter=SWAY)
    return player.motion(seconds, route, feet, course, reach=STANDING_REACH)


def _lanes(player: Player) -> tuple[NDArray, NDArray]:
    """Return the middle (2,) of the line between the lanes and the way (2,) to its end, metres."""
    end = np.array(LANE_SHARE) * player.half_m * [1.0, 0.5]
    return np.array([0.0, -0.5 * player.half_m[1]]), end


def _aside(way: NDArray, by_m: float) -> NDArray:
    """Return a step (2,) m to the right of a way."""
    return by_m * np.array([way[1], -way[0]]) / np.linalg.norm(way)


def _to_and_fro(player: Player, middle: NDArray, end: NDArray, n_turns: int) -> Motion:
    """Walk from `middle - end` to `middle + end`, turn on the spot, walk back, and so on."""
    rng = player.rng
    length_m = float(2 * np.linalg.norm(end))
    heading = np.arctan2(-end[0], end[1])
    places = [middle - end, middle + end]
    stations = [_stand(0.0, rng.uniform(*REST_S), places[0], heading)]
    for k in range(n_turns + 1):
        time_s = stations[-1].leave_s + length_m / rng.uniform(*LANE_M_S)
        place = places[(k + 1) % 2] + rng.normal(0, 0.03, 2)
        stations.append(_stand(time_s, time_s + rng.uniform(0.1, 0.2), place, heading))
        if k < n_turns:
            heading = heading + np.pi * rng.choice([-1, 1])
            turned = stations[-1].leave_s + TURN_S
            stay = rng.uniform(0.1, 0.2)
            stations.append(_stand(turned, turned + stay, place, heading, steps=TURN_STEPS))
    last = stations[-1]
    stations[-1] = _stand(last.arrive_s, last.arrive_s + 0.8, last.place, last.heading)
    return _walk(player, stations, upper_body.WALK, 0.6, None)


def _stand(
    arrive_s: float, leave_s: float, place: NDArray, heading: float, steps: int | None = None
) -> Station:
    return Station(
        arrive_s, leave_s, place, heading, feet=footwork.UPRIGHT, settle_s=0.0, steps=steps
    )


def _walk(
    player: Player,
    stations: Sequence[Station],
    walking: Pose,
    scatter: float,
    lap: Lap | None,
    **options: Any,
) -> Motion:
    route, feet = footwork.plan(
        stations, player.proportions, player.rng, cadence_hz=WALK_HZ, air=WALK_AIR, route=lap
    )
    start_s, stop_s, end_s = stations[0].leave_s, stations[-1].arrive_s, stations[-1].leave_s
    standing = walking.but(lean=0.0, height=upper_body.STAND.height)
    keys = [(0.0, standing), (start_s, standing), (start_s + 0.6, walking)]
    keys += [(stop_s - 0.5, walking), (stop_s + 0.2, standing), (end_s, standing)]
    course = upper_body.course(keys, player.rng, scatter=scatter)
    return player.motion(end_s, route, feet, course, **options)
