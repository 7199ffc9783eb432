"""The motions a virtual player can perform: each a function (proportions, court, rng, **options) -> Motion.

Options of all: hand ("right" or "left") that holds the racket, half ("near": y below the net's, or "far").
"""

from dataclasses import replace

from virtualgym.movement import badminton, upper_body, walking
from virtualgym.movement import player as performance
from virtualgym.movement import single_view as free_motion
from virtualgym.movement import tpose_clap as clapping

REST_S = (0.5, 0.8)


def six_corners(proportions, court, rng, *, hand="right", half="near", seconds=21.0):
    """Run from the base to the corners of the own half, in random order, and show strokes there.

    Parameters
    ----------
    proportions : virtualgym.body.stance.Proportions
        Of the body for which the feet are planted.
    court : courtside.calibration.court.court.Court
    rng : numpy.random.Generator
    hand, half : str
    seconds : float
        It lasts at least that long.

    Returns
    -------
    motion : virtualgym.movement.player.Motion
        Events: hit_1, hit_1_start, hit_1_stop, hit_2 ...
    """
    player = performance.Player(proportions, court, rng, hand, half)
    return badminton.rounds(player, seconds, swing=1.7)


def rally(proportions, court, rng, *, hand="right", half="near", seconds=21.0):
    """Do the same as `six_corners`, with strokes at full speed.

    Parameters
    ----------
    proportions : virtualgym.body.stance.Proportions
    court : courtside.calibration.court.court.Court
    rng : numpy.random.Generator
    hand, half : str
    seconds : float
        It lasts at least that long.

    Returns
    -------
    motion : virtualgym.movement.player.Motion
        Events: hit_1, hit_1_start, hit_1_stop, hit_2 ...
    """
    return badminton.rounds(performance.Player(proportions, court, rng, hand, half), seconds)


def shot(proportions, court, rng, *, hand="right", half="near", corner="rear_right"):
    """Go back, hit one overhead clear, and return.

    Parameters
    ----------
    proportions : virtualgym.body.stance.Proportions
    court : courtside.calibration.court.court.Court
    rng : numpy.random.Generator
    hand, half : str
    corner : str
        One of drills.CORNERS.

    Returns
    -------
    motion : virtualgym.movement.player.Motion
        Events: hit, hit_start, hit_stop (17 frames at 30 fps from start to stop).
    """
    player = performance.Player(proportions, court, rng, hand, half)
    motion = badminton.visits(player, [corner])
    events = {name.replace("_1", ""): time_s for name, time_s in motion.events.items()}
    return replace(motion, events=events)


def lunge(proportions, court, rng, *, hand="right", half="near"):
    """Lunge to the net on either side, and come back.

    Parameters
    ----------
    proportions : virtualgym.body.stance.Proportions
    court : courtside.calibration.court.court.Court
    rng : numpy.random.Generator
    hand, half : str

    Returns
    -------
    motion : virtualgym.movement.player.Motion
        Events: hit_1 and hit_2, the furthest reach, with _start and _stop.
    """
    player = performance.Player(proportions, court, rng, hand, half)
    return badminton.visits(player, rng.permutation(["front_right", "front_left"]).tolist())


def tpose_clap(
    proportions, court, rng, *, hand="right", half="near", between_s=6.0, bouncing=False
):
    """Stand, T-pose, clap; walk about; and once more T-pose and clap, without a racket.

    Parameters
    ----------
    proportions : virtualgym.body.stance.Proportions
    court : courtside.calibration.court.court.Court
    rng : numpy.random.Generator
    hand, half : str
    between_s : float
        Of walking, about.
    bouncing : bool
        The hands rebound from each clap and touch again.

    Returns
    -------
    motion : virtualgym.movement.player.Motion
        Events: tpose_1_start, tpose_1_stop, clap_1 (first touch), clap_1_rebound_1 ..., tpose_2_start ...
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
        scatter=0.0,  # level arms: nothing leans
        events=clapping.events(first, 1) | clapping.events(second, 2),
        arms=clapping.Arms((first, second)),
        racket=False,
        reach=performance.STANDING_REACH,
    )


def tpose_clap_bouncing(proportions, court, rng, **options):
    """Do the same as `tpose_clap`, with hands that rebound.

    Parameters
    ----------
    proportions : virtualgym.body.stance.Proportions
    court : courtside.calibration.court.court.Court
    rng : numpy.random.Generator
    **options
        Of `tpose_clap`.

    Returns
    -------
    motion : virtualgym.movement.player.Motion
    """
    return tpose_clap(proportions, court, rng, bouncing=True, **options)


def single_view(
    proportions,
    court,
    rng,
    *,
    hand="right",
    half="near",
    free_s=20.0,
    claps=2,
    bouncing=False,
):
    """Stand facing the net, T-pose, clap; move freely on the spot; T-pose, clap, without a racket.

    Parameters
    ----------
    proportions : virtualgym.body.stance.Proportions
    court : courtside.calibration.court.court.Court
    rng : numpy.random.Generator
    hand, half : str
    free_s : float
        Of free motion at most: raised arms, bent elbows, twists and turns, squats, steps in place and aside.
        All lasts about 6 s more for each clap.
    claps : int
        T-poses with a clap, the first before and the last after all, others evenly between; 1: only before.
    bouncing : bool
        The hands rebound from each clap and touch again.

    Returns
    -------
    motion : virtualgym.movement.player.Motion
        Events: tpose_1_start, tpose_1_stop, clap_1 (first touch), clap_1_rebound_1 ..., tpose_2_start ...
    """
    player = performance.Player(proportions, court, rng, hand, half)
    return free_motion.perform(player, free_s=free_s, claps=claps, bouncing=bouncing)


def walk(proportions, court, rng, *, hand="right", half="near"):
    """Walk a round of the own half, racket in hand.

    Parameters
    ----------
    proportions : virtualgym.body.stance.Proportions
    court : courtside.calibration.court.court.Court
    rng : numpy.random.Generator
    hand, half : str

    Returns
    -------
    motion : virtualgym.movement.player.Motion
    """
    return walking.large_round(performance.Player(proportions, court, rng, hand, half))


def crossing(proportions, court, rng, *, hand="right", half="near", lane=0, n_turns=1):
    """Walk past another player, turn, and walk back; the other walks the other lane the other way.

    The lanes run askew to the court, so that the players hide one another in views along either side.

    Parameters
    ----------
    proportions : virtualgym.body.stance.Proportions
    court : courtside.calibration.court.court.Court
    rng : numpy.random.Generator
    hand, half : str
    lane : int
        0 or 1.
    n_turns : int
        The players cross once more than that.

    Returns
    -------
    motion : virtualgym.movement.player.Motion
    """
    if lane not in (0, 1):
        raise ValueError(f"expected lane 0 or 1, found {lane}")
    return walking.up_and_down(
        performance.Player(proportions, court, rng, hand, half), lane, n_turns
    )


MOTIONS = {
    "footwork": six_corners,
    "shot": shot,
    "lunge": lunge,
    "tpose_clap": tpose_clap,
    "tpose_clap_bouncing": tpose_clap_bouncing,
    "crossing": crossing,
    "rally": rally,
    "single_view": single_view,
    "walk": walk,
}
