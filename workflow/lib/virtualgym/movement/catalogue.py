"""The motions of a virtual player: functions (proportions, court, rng, **options) -> Motion.

Parameters of all motions
-------------------------
proportions : Proportions
    Of the body for which the feet are planted.
court : Court
rng : numpy.random.Generator
hand : str
    "right" or "left", which holds the racket.
half : str
    Half of the court: "near" (y below the net's) or "far".
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from courtside.calibration.court.court import Court
from virtualgym.body.stance import Proportions
from virtualgym.movement import badminton, exchange, upper_body, walking
from virtualgym.movement import player as performance
from virtualgym.movement import single_view as free_motion
from virtualgym.movement import tpose_clap as clapping
from virtualgym.movement.player import Motion

REST_S = (0.5, 0.8)  # ASSUME: standing before and after; no source is recorded


def six_corners(
    proportions: Proportions,
    court: Court,
    rng: np.random.Generator,
    *,
    hand: str = "right",
    half: str = "near",
    seconds: float = 21.0,
) -> Motion:
    """Run from the base to the corners of the own half, in random order; indicate strokes there.

    The motion lasts at least `seconds`. Events: hit_1, hit_1_start, hit_1_stop, hit_2 ...
    """
    player = performance.Player(proportions, court, rng, hand, half)
    return badminton.rounds(player, seconds, swing=1.7)


def rally(
    proportions: Proportions,
    court: Court,
    rng: np.random.Generator,
    *,
    hand: str = "right",
    half: str = "near",
    seconds: float = 21.0,
) -> Motion:
    """Do the same as `six_corners`, with strokes at full speed."""
    return badminton.rounds(performance.Player(proportions, court, rng, hand, half), seconds)


def exchange_of_shots(
    proportions: Proportions,
    court: Court,
    rng: np.random.Generator,
    *,
    hand: str = "right",
    half: str = "near",
    seconds: float = 21.0,
    script_rng: np.random.Generator | None = None,
) -> Motion:
    """Play one side of a rally of two for at least `seconds`.

    Parameters
    ----------
    script_rng : numpy.random.Generator or None
        Who hits when and where; the same for both players. None: of `rng`.

    Returns
    -------
    motion : Motion
        Events: see `exchange.perform`.
    """
    player = performance.Player(proportions, court, rng, hand, half)
    fed_s, shots = exchange.script(script_rng or rng.spawn(1)[0], seconds)
    return exchange.perform(player, fed_s, shots)


def shot(
    proportions: Proportions,
    court: Court,
    rng: np.random.Generator,
    *,
    hand: str = "right",
    half: str = "near",
    corner: str = "rear_right",
) -> Motion:
    """Run to one of `badminton.CORNERS`, play its stroke (default: an overhead clear), and return.

    Events: hit, hit_start, hit_stop (17 frames at 30 fps from start to stop).
    """
    player = performance.Player(proportions, court, rng, hand, half)
    motion = badminton.visits(player, [corner])
    events = {name.replace("_1", ""): time_s for name, time_s in motion.events.items()}
    return replace(motion, events=events)


def lunge(
    proportions: Proportions,
    court: Court,
    rng: np.random.Generator,
    *,
    hand: str = "right",
    half: str = "near",
) -> Motion:
    """Lunge to the net on either side, and return.

    Events: hit_1 and hit_2 at the furthest reach, with _start and _stop.
    """
    player = performance.Player(proportions, court, rng, hand, half)
    return badminton.visits(player, rng.permutation(["front_right", "front_left"]).tolist())


def tpose_clap(
    proportions: Proportions,
    court: Court,
    rng: np.random.Generator,
    *,
    hand: str = "right",
    half: str = "near",
    between_s: float = 6.0,
    bouncing: bool = False,
) -> Motion:
    """Stand, T-pose, clap; walk about; T-pose and clap again, without a racket.

    Parameters
    ----------
    between_s : float
        Approximate duration of the walk.
    bouncing : bool
        The hands rebound from each clap and touch again.

    Returns
    -------
    motion : Motion
        Events: tpose_1_start, tpose_1_stop, clap_1 (first touch), clap_1_rebound_1 ...,
        tpose_2_start ...
    """
    player = performance.Player(proportions, court, rng, hand, half)
    first = clapping.perform(rng.uniform(*REST_S), proportions, rng, bouncing=bouncing)
    start = first.end_s + rng.uniform(0.1, 0.4)
    lap = walking.small_round(player, start, between_s * rng.uniform(0.95, 1.1))
    second = clapping.perform(
        lap.stop_s + rng.uniform(*REST_S), proportions, rng, bouncing=bouncing
    )
    return walking.along(
        player,
        lap,
        second.end_s + rng.uniform(*REST_S),
        upper_body.FREE_WALK,
        scatter=0.0,  # level arms and an upright trunk
        events=clapping.events(first, 1) | clapping.events(second, 2),
        arms=clapping.Arms((first, second)),
        racket=False,
        reach=performance.STANDING_REACH,
    )


def tpose_clap_bouncing(
    proportions: Proportions, court: Court, rng: np.random.Generator, **options: Any
) -> Motion:
    """Do the same as `tpose_clap`, with hands that rebound."""
    return tpose_clap(proportions, court, rng, bouncing=True, **options)


def single_view(
    proportions: Proportions,
    court: Court,
    rng: np.random.Generator,
    *,
    hand: str = "right",
    half: str = "near",
    free_s: float = 20.0,
    claps: int = 2,
    bouncing: bool = False,
) -> Motion:
    """Stand facing the net, T-pose, clap; move freely on the spot; T-pose, clap, without a racket.

    Parameters
    ----------
    free_s : float
        Longest duration of free motion: raised arms, bent elbows, twists and turns, squats, steps
        in place and aside. Each clap adds about 6 s.
    claps : int
        T-poses with a clap: one first, one last, others evenly between; 1: only the first.
    bouncing : bool
        The hands rebound from each clap and touch again.

    Returns
    -------
    motion : Motion
        Events: tpose_1_start, tpose_1_stop, clap_1 (first touch), clap_1_rebound_1 ...,
        tpose_2_start ...
    """
    player = performance.Player(proportions, court, rng, hand, half)
    return free_motion.perform(player, free_s=free_s, claps=claps, bouncing=bouncing)


def walk(
    proportions: Proportions,
    court: Court,
    rng: np.random.Generator,
    *,
    hand: str = "right",
    half: str = "near",
) -> Motion:
    """Walk a round of the own half, racket in hand."""
    return walking.large_round(performance.Player(proportions, court, rng, hand, half))


def crossing(
    proportions: Proportions,
    court: Court,
    rng: np.random.Generator,
    *,
    hand: str = "right",
    half: str = "near",
    lane: int = 0,
    n_turns: int = 1,
) -> Motion:
    """Walk past another player, turn, and walk back; the other uses the other lane, the other way.

    The lanes are oblique to the court, so that the players occlude each other in views along either
    side.

    Parameters
    ----------
    lane : int
        0 or 1.
    n_turns : int
        The players cross once more than that.
    """
    if lane not in (0, 1):
        raise ValueError(f"expected lane 0 or 1, found {lane}")
    return walking.up_and_down(
        performance.Player(proportions, court, rng, hand, half), lane, n_turns
    )


def stand(
    proportions: Proportions,
    court: Court,
    rng: np.random.Generator,
    *,
    hand: str = "right",
    half: str = "near",
    seconds: float = 21.0,
) -> Motion:
    """Stand beside the lanes of `crossing`, facing the net, swaying a little."""
    return walking.stand(performance.Player(proportions, court, rng, hand, half), seconds)


def stroll(
    proportions: Proportions,
    court: Court,
    rng: np.random.Generator,
    *,
    hand: str = "right",
    half: str = "near",
    seconds: float = 21.0,
) -> Motion:
    """Walk up and down outside of the court, beside its long side, as bystanders do."""
    return walking.stroll(performance.Player(proportions, court, rng, hand, half), seconds)


MOTIONS: dict[str, Callable[..., Motion]] = {
    "footwork": six_corners,
    "shot": shot,
    "lunge": lunge,
    "tpose_clap": tpose_clap,
    "tpose_clap_bouncing": tpose_clap_bouncing,
    "crossing": crossing,
    "rally": rally,
    "exchange": exchange_of_shots,
    "single_view": single_view,
    "stand": stand,
    "stroll": stroll,
    "walk": walk,
}
