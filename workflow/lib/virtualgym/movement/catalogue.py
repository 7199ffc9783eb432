"""The motions of a virtual player: functions (player, **options) -> Motion.

Options that the take gives where a motion has them: `seconds`, the least duration; `lane`, 0 or 1,
of players who cross; `script_rng`, random numbers that all players share.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from virtualgym.movement import badminton, exchange, single_view, upper_body, walking
from virtualgym.movement import player as performance
from virtualgym.movement import tpose_clap as clapping
from virtualgym.movement.player import Motion, Player

REST_S = (0.5, 0.8)  # ASSUME: standing before and after; no source is recorded


def exchange_of_shots(
    player: Player, *, seconds: float = 21.0, script_rng: np.random.Generator | None = None
) -> Motion:
    """Play one side of a rally of two for at least `seconds`.

    Parameters
    ----------
    player : Player
    seconds : float
    script_rng : numpy.random.Generator or None
        Who hits when and where; the same for both players. None: of the player's.

    Returns
    -------
    motion : Motion
        Events: see `exchange.perform`.
    """
    fed_s, shots = exchange.script(script_rng or player.rng.spawn(1)[0], seconds)
    return exchange.perform(player, fed_s, shots)


def shot(player: Player, *, corner: str = "rear_right") -> Motion:
    """Run to one of `badminton.CORNERS`, play its stroke (default: an overhead clear), and return.

    Events: hit, hit_start, hit_stop (16 or 17 frames at 30 fps from start to stop).
    """
    if corner not in badminton.CORNERS:
        raise ValueError(f"expected a corner of {list(badminton.CORNERS)}, found {corner!r}")
    motion = badminton.visits(player, [corner])
    events = {name.replace("_1", ""): time_s for name, time_s in motion.events.items()}
    return replace(motion, events=events)


def lunge(player: Player) -> Motion:
    """Lunge to the net on either side, and return.

    Events: hit_1 and hit_2 at the furthest reach, with _start and _stop.
    """
    corners = player.rng.permutation(["front_right", "front_left"]).tolist()
    return badminton.visits(player, corners)


def tpose_clap(player: Player, *, between_s: float = 6.0, bouncing: bool = False) -> Motion:
    """Stand, T-pose, clap; walk about; T-pose and clap again, without a racket.

    Parameters
    ----------
    player : Player
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
    rng, body = player.rng, player.proportions
    first = clapping.perform(rng.uniform(*REST_S), body, rng, bouncing=bouncing)
    start = first.end_s + rng.uniform(0.1, 0.4)
    lap = walking.small_round(player, start, between_s * rng.uniform(0.95, 1.1))
    second = clapping.perform(lap.stop_s + rng.uniform(*REST_S), body, rng, bouncing=bouncing)
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


MOTIONS: dict[str, Callable[..., Motion]] = {
    "footwork": partial(badminton.rounds, swing=1.7),  # strokes are only indicated
    "shot": shot,
    "lunge": lunge,
    "tpose_clap": tpose_clap,
    "tpose_clap_bouncing": partial(tpose_clap, bouncing=True),
    "crossing": walking.up_and_down,
    "rally": badminton.rounds,
    "exchange": exchange_of_shots,
    "single_view": single_view.perform,
    "stand": walking.stand,
    "stroll": walking.stroll,
    "walk": walking.large_round,
}
