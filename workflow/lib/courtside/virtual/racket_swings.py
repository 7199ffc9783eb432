"""Where a racket is while a player lifts it from below the height of the net to above, and its clicks."""

import zlib

import numpy as np

from courtside.virtual import clicking

FRAMES, BELOW = 21, 10  # of the published scene, and how many of them are below the net's height
START_M, END_M = (
    (0.75, 1.1),
    (2.1, 2.6),
)  # heights of the racket's middle in the first and last frame
REACH_M = (0.4, 0.8)  # from the player's axis to the racket's middle, on the floor
MARGIN_M = (1.0, 1.5)  # of the player from the edges of the court, and from the net
TURN_DEG = (30.0, 120.0)  # about the player's axis, to either side, from first to last frame
RISE_DEG = ((-60.0, 0.0), (20.0, 100.0))  # of the racket above the horizontal, first and last frame


def draw(court, length_m, *, seed, run):
    """Return the `swing` of one run, the same for every session.

    Parameters
    ----------
    court, length_m
        As for `swing`.
    seed, run : int
    """
    return swing(court, length_m, _generator(seed, run, "swing"))


def click(cameras, ends, *, sigma_px_at_3840, again, seed, run):
    """Click both ends of a racket in every frame of every camera.

    Parameters
    ----------
    cameras : list of Camera
    ends : (F, 2, 3) float
        Top and butt, m.
    sigma_px_at_3840 : float
        Standard deviation per axis of one click, px, in a picture 3840 px wide. The errors of one run
        are the same but for their size. A person's habit, common to all clicks, is left out: it shifts
        both ends alike.
    again : bool
        Whether this is a second time, with new errors.
    seed, run : int

    Returns
    -------
    seen : dict of str to (2 F, 2) float
        Top and butt, frame after frame, px; NaN outside the picture.
    """
    rng = _generator(seed, run, "tips again" if again else "tips")
    return clicking.simulate(
        cameras,
        np.reshape(ends, (-1, 3)),
        sigma_px_at_3840=sigma_px_at_3840,
        bias_px_at_3840=0.0,
        rng=rng,
    )


def _generator(seed, run, what):
    return np.random.default_rng([seed, zlib.crc32(f"racket {what}".encode()), run])


def swing(court, length_m, rng):
    """Move a racket as in a part of a stroke, in the half of the court at y = 0.

    Parameters
    ----------
    court : courtside.calibration.court.court.Court
        With a net: its `mid_height_m` is passed between frames `BELOW` and `BELOW` + 1.
    length_m : float
        From top to butt.
    rng : numpy.random.Generator

    Returns
    -------
    ends : (FRAMES, 2, 3) float
        Top and butt in the world, m.

    Notes
    -----
    The player stands anywhere in that half; the racket's middle rises without turning back and goes
    round the player, while the racket turns from hanging or level to raised. Directions differ from run
    to run: the error of a length depends on how it lies to the lines of sight.
    """
    at = np.arange(1, FRAMES + 1)
    part = (at - 1) / (FRAMES - 1)
    low_m, high_m = rng.uniform(*START_M), rng.uniform(*END_M)
    height_m = np.interp(at, [1, BELOW + 0.5, FRAMES], [low_m, court.net["mid_height_m"], high_m])
    edge_m, from_net_m = MARGIN_M
    stand = rng.uniform([edge_m, edge_m], [court.size_m[0] - edge_m, court.net["y_m"] - from_net_m])
    turn = np.radians(rng.uniform(*TURN_DEG)) * rng.choice([-1, 1])
    heading = rng.uniform(0, 2 * np.pi) + turn * part
    rise = np.radians([rng.uniform(*RISE_DEG[0]), rng.uniform(*RISE_DEG[1])]) @ [1 - part, part]
    reach_m = rng.uniform(*REACH_M)
    round_player = np.stack([np.cos(heading), np.sin(heading)], axis=1)
    middle = np.column_stack([stand + reach_m * round_player, height_m])
    yaw = heading + rng.uniform(-np.pi / 2, np.pi / 2)  # the wrist's, about the vertical
    along = np.stack([np.cos(rise) * np.cos(yaw), np.cos(rise) * np.sin(yaw), np.sin(rise)], axis=1)
    half = length_m / 2 * along
    return np.stack([middle + half, middle - half], axis=1)
