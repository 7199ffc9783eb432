"""Rackets: their swings in the published scene, and clicks of their ends."""

import csv
import zlib
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.geometry import camera as camera_models
from courtside.geometry.camera import Camera
from courtside.study.execution.files import atomic
from virtualgym import presets
from virtualgym.body import mesh
from virtualgym.body.athlete import Athlete
from virtualgym.rendering import rolling_shutter
from virtualgym.session import click_model
from virtualgym.session.clicks import click_points

COLUMNS = ("take", "camera", "frame_idx", "end", "x_px", "y_px")
ENDS = ("top", "butt")


class _Ends:
    """The ends of an athlete's racket, as a surface without triangles."""

    def __init__(self, athlete: Athlete) -> None:
        self.athlete = athlete

    def mesh(self, time_s: float) -> mesh.Mesh:
        none = np.zeros((0, 3))
        return mesh.Mesh(self.athlete.racket(time_s), none.astype(np.int32), none.astype(np.uint8))


def of_camera(
    athletes: Iterable[Athlete],
    cameras: Sequence[Camera],
    times_s: NDArray,
    preset: presets.Preset,
    rng: np.random.Generator,
) -> list[tuple[str, int, str, NDArray]]:
    """Click both ends of every racket in every frame of a camera, also where a body hides them.

    Parameters
    ----------
    athletes : iterable of Athlete
    cameras : sequence of Camera, length T
        The camera at each frame.
    times_s : (T,) float
        Mid-exposure of each frame's middle row, on the athletes' clock.
    preset : Preset
    rng : numpy.random.Generator
        For the person's bias in this camera, and each click.

    Returns
    -------
    clicks : list of (str, int, str, (2,) float)
        Camera, frame_idx, end, px; without those outside of the picture.
    """
    per_px = cameras[0].size[0] / click_model.FULL_WIDTH_PX
    habit = rng.standard_normal(2) * preset.click_bias_px_at_3840
    holders = [athlete for athlete in athletes if athlete.has_racket]
    clicks = []
    for index, (camera, time_s) in enumerate(zip(cameras, times_s, strict=True)):
        for athlete in holders:
            shutter = time_s, preset.readout_s, 0.0
            moving = rolling_shutter.follow(_Ends(athlete), camera, *shutter)
            shown = rolling_shutter.Screen(moving, camera, *shutter).at(0.0)[:, :2]
            error = habit + rng.standard_normal((2, 2)) * preset.click_sigma_px_at_3840
            for end, xy in zip(ENDS, shown + error * per_px, strict=True):
                if camera_models.in_picture(camera, xy).all():
                    clicks.append((camera.name, index, end, xy))
    return clicks


def write(path: str | Path, take: str, clicks: Iterable[tuple[str, int, str, NDArray]]) -> None:
    """Write clicks from `of_camera` as a CSV file, atomically."""
    with atomic(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(COLUMNS)
        for camera, frame_idx, end, (x, y) in clicks:
            table.writerow([take, camera, frame_idx, end, f"{x:.3f}", f"{y:.3f}"])


# Of the published scene: number of frames, and how many of them are below the net's height.
FRAMES, BELOW = 21, 10
# ASSUME: ranges of a stroke's geometry, from a low to a high racket; no source is recorded.
START_M, END_M = (0.75, 1.1), (2.1, 2.6)  # height of the racket's middle, first and last frame
REACH_M = (0.4, 0.8)  # horizontal distance of the racket's middle from the player's axis
MARGIN_M = (1.0, 1.5)  # of the player from the edges of the court, and from the net
TURN_DEG = (30.0, 120.0)  # about the player's axis, to either side, from first to last frame
RISE_DEG = ((-60.0, 0.0), (20.0, 100.0))  # of the racket above the horizontal, first and last frame


def swing_of_run(court: Court, length_m: float, *, seed: int, run: int) -> NDArray:
    """Return the `swing` of one run, the same for every session."""
    return swing(court, length_m, _generator(seed, run, "swing"))


def click_racket(
    cameras: Iterable[Camera],
    ends: NDArray,
    *,
    sigma_px_at_3840: float,
    again: bool,
    seed: int,
    run: int,
) -> dict[str, NDArray]:
    """Click both ends of a racket in every frame of every camera.

    Parameters
    ----------
    cameras : list of Camera
    ends : (F, 2, 3) float
        Top and butt, m.
    sigma_px_at_3840 : float
        Standard deviation per axis of one click, px, in a picture of 3840 px. The errors of one
        run differ only by this factor. There is no bias, which would shift both ends alike.
    again : bool
        Whether these are repeated clicks, with new errors.
    seed, run : int

    Returns
    -------
    seen : dict of str to (2 F, 2) float
        Top and butt, frame after frame, px; NaN outside the picture.
    """
    rng = _generator(seed, run, "tips again" if again else "tips")
    return click_points(
        cameras,
        np.reshape(ends, (-1, 3)),
        sigma_px_at_3840=sigma_px_at_3840,
        bias_px_at_3840=0.0,
        rng=rng,
    )


def _generator(seed: int, run: int, what: str) -> np.random.Generator:
    return np.random.default_rng([seed, zlib.crc32(f"racket {what}".encode()), run])


def swing(court: Court, length_m: float, rng: np.random.Generator) -> NDArray:
    """Move a racket as in a part of a stroke, in the half of the court at y = 0.

    Parameters
    ----------
    court : Court
        With a net: the racket passes its `mid_height_m` between frames `BELOW` and `BELOW` + 1.
    length_m : float
        From top to butt.
    rng : numpy.random.Generator

    Returns
    -------
    ends : (FRAMES, 2, 3) float
        Top and butt in the world, m.

    Notes
    -----
    The player's place in that half is random. The racket's middle rises steadily and moves round
    the player, while the racket turns from hanging or level to raised. Directions are random, as
    the error of a measured length depends on its angle to the lines of sight.
    """
    if court.net is None:
        raise ValueError("expected a court with a net, found one without")
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
    yaw = heading + rng.uniform(-np.pi / 2, np.pi / 2)  # of the wrist, about the vertical
    along = np.stack([np.cos(rise) * np.cos(yaw), np.cos(rise) * np.sin(yaw), np.sin(rise)], axis=1)
    half = length_m / 2 * along
    return np.stack([middle + half, middle - half], axis=1)
