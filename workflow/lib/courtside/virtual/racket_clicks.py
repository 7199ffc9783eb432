"""Simulated clicks of the ends of rackets in the frames of a take, as a table."""

import csv

import numpy as np

from courtside.study.files import atomic
from courtside.virtual import clicking, mesh, onscreen

COLUMNS = ("take", "camera", "frame_idx", "end", "x_px", "y_px")
ENDS = ("top", "butt")


class _Ends:
    """The ends of an athlete's racket, as a surface without triangles."""

    def __init__(self, athlete):
        self.athlete = athlete

    def mesh(self, time_s):
        none = np.zeros((0, 3))
        return mesh.Mesh(self.athlete.racket(time_s), none.astype(np.int32), none.astype(np.uint8))


def of_camera(athletes, cameras, times_s, preset, rng):
    """Click both ends of every racket in every frame of a camera, also where a body hides one.

    Parameters
    ----------
    athletes : list of athlete.Athlete
    cameras : list of Camera, length T
        The camera as it stands at each frame.
    times_s : (T,) float
        Mid-exposure of each frame's middle row, on the athletes' clock.
    preset : courtside.virtual.presets.Preset
    rng : numpy.random.Generator
        For the person's habit in this camera, and each click.

    Returns
    -------
    clicks : list of (str, int, str, (2,) float)
        Camera, frame_idx, end, px; without those beside the picture.
    """
    per_px = cameras[0].size[0] / clicking.FULL_WIDTH_PX
    habit = rng.standard_normal(2) * preset.click_bias_px_at_3840
    holders = [athlete for athlete in athletes if athlete.has_racket]
    clicks = []
    for index, (camera, time_s) in enumerate(zip(cameras, times_s, strict=True)):
        for athlete in holders:
            shutter = time_s, preset.readout_s, 0.0
            moving = onscreen.follow(_Ends(athlete), camera, *shutter)
            shown = onscreen.Screen(moving, camera, *shutter).at(0.0)[:, :2]
            error = habit + rng.standard_normal((2, 2)) * preset.click_sigma_px_at_3840
            for end, xy in zip(ENDS, shown + error * per_px, strict=True):
                if ((xy >= -0.5) & (xy <= np.array(camera.size) - 0.5)).all():
                    clicks.append((camera.name, index, end, xy))
    return clicks


def write(path, take, clicks):
    """Write clicked ends of rackets as a CSV file, whole or not at all.

    Parameters
    ----------
    path : str or Path
    take : str
    clicks : iterable of (str, int, str, (2,) float)
        As `of_camera` returns them.
    """
    with atomic(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(COLUMNS)
        for camera, frame_idx, end, (x, y) in clicks:
            table.writerow([take, camera, frame_idx, end, f"{x:.3f}", f"{y:.3f}"])
