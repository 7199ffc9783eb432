"""Film one virtual session: videos of the fixed cameras and of a walk, clicks, and the truth."""

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from courtside.records.cameras import clicks as click_records
from courtside.records.truth import session_truth
from courtside.study.execution import log
from courtside.video import writer
from virtualgym import presets
from virtualgym.cameras import layouts, walk_path
from virtualgym.devices import chessboard
from virtualgym.hall import bystanders, hall
from virtualgym.rendering import background
from virtualgym.rendering.hall_renderer import Renderer
from virtualgym.session import clicks, parallel

WALK = "walk"
STATIC_HZ = 5.0
TREMBLE_PX = 0.03  # of a tripod, standard deviation per axis at 1280 px width
# Independent streams of random numbers, so that a change of one part leaves the others as they are.
HALL, LENSES, STATIC, CLICKS, BOARDS = range(5)  # of the scene's seed
PATH, PEOPLE, GRAIN = range(5, 8)  # of the walk's seed


@dataclass(frozen=True)
class Settings:
    """What makes one virtual session.

    Attributes
    ----------
    preset : str
        A key of `presets.PRESETS`.
    layout : str
        A key of `layouts.LAYOUTS`.
    seed : int
        Of the hall, the fixed cameras, the clicks and the boards.
    size_px : (int, int)
        Width and height of every video, even numbers.
    walk_frames : int
        Frames that the walk's video has, at least two: no more is filmed than the study's grid needs; 0 for
        a session without a walk.
    walk_seed : int
        Of the walk, its camera, its noise, and the people.
    speed_kmh : float
        Of the walk.
    stabiliser : bool
        Whether the walked camera has one.
    static_frames : int
        Frames of each fixed camera's video.
    baseline_deg : float or None
        Angle between the fixed cameras of layout "a", if not 90.
    zoom : float
        Of the fixed cameras' lenses; the walked camera has none.
    boards : bool
        Whether each fixed camera also takes pictures of a chessboard.
    people : int or None
        How many walk about during the walk, if not the preset's number.
    """

    preset: str
    layout: str
    seed: int
    size_px: tuple
    walk_frames: int
    walk_seed: int = 0
    speed_kmh: float = walk_path.USUAL_KMH
    stabiliser: bool = True
    static_frames: int = 9
    baseline_deg: float | None = None
    zoom: float = 1.0
    boards: bool = False
    people: int | None = None

    def __post_init__(self):
        object.__setattr__(self, "size_px", tuple(self.size_px))
        if self.preset not in presets.PRESETS:
            expected = sorted(presets.PRESETS)
            raise ValueError(f"expected a preset of {expected}, found {self.preset!r}")
        if self.walk_frames == 1 or self.walk_frames < 0 or self.static_frames < 1:
            found = f"{self.walk_frames} and {self.static_frames}"
            raise ValueError(f"expected walk_frames 0 or >= 2, static_frames >= 1, found {found}")


class Studio:
    """The hall of a session and everything in it, ready for pictures.

    Parameters
    ----------
    settings : Settings
    court : courtside.calibration.court.court.Court

    Attributes
    ----------
    fixed : list of Camera
    walk : walk.Walk
    people : list of bystanders.Person
    """

    def __init__(self, settings, court):
        self.settings, self.preset = settings, presets.PRESETS[settings.preset]
        self.fixed, self.walk = plan(settings, court)
        count = self.preset.n_people if settings.people is None else settings.people
        self.people = bystanders.plan(count, court, parallel.generator(settings.walk_seed, PEOPLE))
        self._renderer = Renderer(
            hall.build(self.preset, court, parallel.stream(settings.seed, HALL))
        )

    def court_xyz(self):
        """Return where the court's points really are, (P, 3) m."""
        return self._renderer.scene.court_xyz

    def backdrop(self, index, margin_px=0):
        """Return what fixed camera `index` sees without people, and how far away that is."""
        return background.look(self._renderer, self.fixed[index], margin_px)

    def walk_picture(self, index):
        """Return frame `index` of the walk."""
        settings, preset = self.settings, self.preset
        time_s = self.walk.grid(settings.walk_frames)[index]
        return self._renderer.render(
            self.walk.camera(time_s),
            twist=self.walk.twist(time_s),
            readout_s=preset.readout_s,
            exposure_s=preset.exposure_s,
            extra=bystanders.quads(self.people, time_s),
            noise=preset.noise_sigma,
            rng=parallel.generator(settings.walk_seed, GRAIN, index),
        )


def plan(settings, court):
    """Return the fixed cameras (list of Camera) and the `walk_path.Walk` of a session, without its hall.

    Parameters
    ----------
    settings : Settings
    court : courtside.calibration.court.court.Court
    """
    preset = presets.PRESETS[settings.preset]
    fixed = layouts.fixed_cameras(
        settings.layout,
        court,
        settings.size_px,
        preset,
        parallel.generator(settings.seed, LENSES),
        baseline_deg=settings.baseline_deg,
        zoom=settings.zoom,
    )
    walked = walk_path.plan(
        fixed,
        court,
        settings.size_px,
        preset,
        parallel.generator(settings.walk_seed, PATH),
        speed_kmh=settings.speed_kmh,
        stabiliser=settings.stabiliser,
    )
    return fixed, walked


def simulate(settings, court, folder, *, backdrops_npz=None, threads=1):
    """Film a session.

    Parameters
    ----------
    settings : Settings
    court : courtside.calibration.court.court.Court
    folder : str or Path
        Gets `{camera}.mp4` for each camera of the layout, `court_points.csv`, `truth.npz`, and `walk.mp4`
        and `boards/{camera}/*.png` where asked for; each file appears under its name only when whole.
    backdrops_npz : str, Path or None
        Where to keep the empty hall for takes, `background.write`, if at all.
    threads : int
        Processes that render; the files do not depend on it.

    Raises
    ------
    InputError
        If the disk refuses a file.
    """
    folder = Path(folder)
    fixed, walked = plan(settings, court)
    with parallel.crew(Studio, (settings, court), threads) as call:
        court_xyz = next(call("court_xyz", [()]))
        empty = list(call("backdrop", [(at,) for at in range(len(fixed))]))
        for at, (camera, seen) in enumerate(zip(fixed, empty, strict=True)):
            _film_fixed(settings, folder, at, camera, seen.picture)
        if backdrops_npz is not None:
            background.write(backdrops_npz, empty)
        if settings.walk_frames:
            frames = call("walk_picture", [(at,) for at in range(settings.walk_frames)])
            _film_walk(settings, folder, walked, frames)
    preset = presets.PRESETS[settings.preset]
    marked = clicks.simulate(
        fixed,
        court_xyz,
        sigma_px_at_3840=preset.click_sigma_px_at_3840,
        bias_px_at_3840=preset.click_bias_px_at_3840,
        rng=parallel.generator(settings.seed, CLICKS),
    )
    click_records.write(folder / "court_points.csv", marked, court.points)
    walks = {WALK: _true_walk(walked, settings.walk_frames)} if settings.walk_frames else {}
    session_truth.write(folder / "truth.npz", fixed, walks, court.points, court_xyz)


def backdrops(settings, court, margins, *, kept_npz=None, threads=1):
    """Return what fixed cameras see of the empty hall, a dict of int to `background.Backdrop`.

    Parameters
    ----------
    settings : Settings
    court : courtside.calibration.court.court.Court
    margins : dict of int to int
        For each camera, by its place in the layout, how much more is needed on each side, px.
    kept_npz : str, Path or None
        What `simulate` kept of this session, which has no margins; without it the hall is built.
    threads : int
        Processes that render what is not kept.

    Raises
    ------
    InputError
        If that file is damaged or of other cameras.
    """
    kept = [at for at, margin in margins.items() if kept_npz is not None and not margin]
    seen = {}
    if kept:
        fixed = plan(settings, court)[0]
        seen = dict(zip(kept, background.read(kept_npz, [fixed[at] for at in kept]), strict=True))
    others = [(at, margin) for at, margin in margins.items() if at not in seen]
    if others:
        with parallel.crew(Studio, (settings, court), min(threads, len(others))) as call:
            looks = call("backdrop", others)
            seen |= {at: look for (at, _), look in zip(others, looks, strict=True)}
    return seen


def _film_fixed(settings, folder, at, camera, picture):
    """Write the recording of a fixed camera, and its pictures of a chessboard."""
    preset = presets.PRESETS[settings.preset]
    rng = parallel.generator(settings.seed, STATIC, at)
    count = range(settings.static_frames)
    frames = (_trembled(picture, preset.noise_sigma, rng) for _ in count)
    writer.write_video(folder / f"{camera.name}.mp4", frames, STATIC_HZ, crf=preset.crf)
    if settings.boards:
        rng = parallel.generator(settings.seed, BOARDS, at)
        place = folder / "boards" / camera.name
        chessboard.simulate(camera, place, picture, rng, noise=preset.noise_sigma)


def _film_walk(settings, folder, walked, frames):
    rate_hz = (settings.walk_frames - 1) / walked.duration_s  # frame k is at the grid's time k
    frames = log.progress(frames, settings.walk_frames, f"{WALK}: frames")
    crf = presets.PRESETS[settings.preset].crf
    writer.write_video(folder / f"{WALK}.mp4", frames, rate_hz, crf=crf)


def _trembled(picture, noise, rng):
    shift_px = rng.standard_normal(2) * TREMBLE_PX * picture.shape[1] / 1280
    moved = cv2.warpAffine(
        picture.astype(np.float32),
        np.column_stack([np.eye(2), shift_px]),
        picture.shape[1::-1],
        flags=cv2.INTER_CUBIC,
        borderMode=cv2.BORDER_REPLICATE,
    )
    moved += rng.standard_normal(picture.shape, dtype=np.float32) * np.float32(noise)
    return np.clip(np.rint(moved), 0, 255).astype(np.uint8)


def _true_walk(walked, n_frames):
    time_s = walked.grid(n_frames)
    return session_truth.Walk(
        time_s=time_s,
        K=walked.K,
        dist=walked.dist,
        cam_from_world=np.array([walked.pose(time) for time in time_s]),
        principal_point_px=np.array([walked.principal_point_px(time) for time in time_s]),
    )
