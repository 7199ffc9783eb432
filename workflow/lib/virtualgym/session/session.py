"""Film a virtual session: videos of the fixed cameras and of a walk, clicks, and the truth."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.geometry.camera import Camera
from courtside.records.cameras import clicks as click_records
from courtside.records.truth import session_truth
from courtside.study.execution import log
from courtside.video import writer
from virtualgym import presets, worlds
from virtualgym.cameras import layouts, lens_errors, walk_path
from virtualgym.devices import chessboard
from virtualgym.hall import bystanders, hall, look, painted_lines
from virtualgym.rendering import background, lamps
from virtualgym.rendering.hall_renderer import Renderer
from virtualgym.session import clicks, parallel

WALK = "walk"
STATIC_HZ = 5.0  # ASSUME: frame rate of the fixed cameras' short videos
TREMBLE_PX = 0.03  # ASSUME: tremor of a tripod, standard deviation per axis, px at 1280 px width
# Independent streams of random numbers, so that a change of one part does not affect the others.
HALL, LENSES, STATIC, CLICKS, BOARDS = range(5)  # of the scene's seed
PATH, PEOPLE, GRAIN = range(5, 8)  # of the walk's seed
SHUTTER, FLICKER, WORSE = range(8, 11)  # of both: how wrong the world is
LENS, LOOK, COURT = range(3)  # of WORSE and the scene's seed


@dataclass(frozen=True)
class Settings:
    """Settings of a virtual session.

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
        Number of frames of the walk: at least two, or 0 for no walk. They are the grid from which
        bridging images are taken; no others are rendered.
    walk_seed : int
        Of the walk, its camera, its noise, and the bystanders.
    speed_kmh : float
        Of the walk.
    stabiliser : bool
        Whether the walked camera has one.
    static_frames : int
        Frames of each fixed camera's video; 0: nobody films the empty hall, nor walks through it.
    baseline_deg : float or None
        Angle between the fixed cameras of layout "a"; None: 90.
    zoom : float
        Of the fixed cameras' lenses; the walked camera has none.
    boards : bool
        Whether each fixed camera also takes pictures of a chessboard.
    people : int or None
        Number of bystanders during the walk; None: the preset's.
    world : World or dict of str to float
        How wrong the world is.
    """

    preset: str
    layout: str
    seed: int
    size_px: tuple[int, int]
    walk_frames: int
    walk_seed: int = 0
    speed_kmh: float = walk_path.USUAL_KMH
    stabiliser: bool = True
    static_frames: int = 9
    baseline_deg: float | None = None
    zoom: float = 1.0
    boards: bool = False
    people: int | None = None
    world: worlds.World | Mapping[str, float] = field(default_factory=worlds.World)

    def __post_init__(self) -> None:
        object.__setattr__(self, "world", worlds.build(self.world))
        object.__setattr__(self, "size_px", tuple(self.size_px))
        if self.preset not in presets.PRESETS:
            expected = sorted(presets.PRESETS)
            raise ValueError(f"expected a preset of {expected}, found {self.preset!r}")
        least = 1 if self.walk_frames else 0
        if self.walk_frames == 1 or self.walk_frames < 0 or self.static_frames < least:
            found = f"{self.walk_frames} and {self.static_frames}"
            raise ValueError(
                "expected walk_frames 0 or >= 2, static_frames >= 1 or 0 without a walk, "
                f"found {found}"
            )

    def strength(self, effect: str) -> float:
        """Return how strong an effect of the world is."""
        return float(getattr(self.world, effect))

    def readout_s(self, at: int | None) -> float:
        """Return the readout time of fixed camera `at`, or of the walked one."""
        usual_s, strength = presets.PRESETS[self.preset].readout_s, self.strength("shutter")
        seed, key = (self.walk_seed, ()) if at is None else (self.seed, (at,))
        return lamps.readout(usual_s, strength, parallel.generator(seed, SHUTTER, *key))

    def light(self, at: int | None) -> lamps.Light | None:
        """Return the light of the pictures of fixed camera `at`, or of the walked one."""
        seed, key = (self.walk_seed, ()) if at is None else (self.seed, (at,))
        return lamps.light(self.strength("flicker"), parallel.generator(seed, FLICKER, *key))


class Studio:
    """The hall of a session and everything in it, ready to be rendered."""

    def __init__(self, settings: Settings, court: Court) -> None:
        self.settings, self.preset = settings, presets.PRESETS[settings.preset]
        self.fixed, self.walk = plan(settings, court)
        count = self.preset.n_people if settings.people is None else settings.people
        self.people = bystanders.plan(count, court, parallel.generator(settings.walk_seed, PEOPLE))
        self._renderer = Renderer(build_hall(settings, court))
        self._readout_s, self._light = settings.readout_s(None), settings.light(None)

    def court_xyz(self) -> NDArray:
        """Return the true places of the court's points, (P, 3) m."""
        return self._renderer.scene.court_xyz

    def backdrop(self, index: int, margin_px: int = 0) -> background.Backdrop:
        """Return picture and depth of the empty hall from fixed camera `index`."""
        return background.look(self._renderer, self.fixed[index], margin_px)

    def walk_picture(self, index: int) -> NDArray:
        """Return frame `index` of the walk."""
        settings, preset = self.settings, self.preset
        time_s = self.walk.grid(settings.walk_frames)[index]
        shutter = self._readout_s, preset.exposure_s
        lit = None if self._light is None else self._light.rows(time_s, self.walk.size[1], *shutter)
        return self._renderer.render(
            self.walk.camera(time_s),
            twist=self.walk.twist(time_s),
            readout_s=shutter[0],
            exposure_s=shutter[1],
            extra=bystanders.quads(self.people, time_s),
            noise=preset.noise_sigma,
            rng=parallel.generator(settings.walk_seed, GRAIN, index),
            row_warp_px=self.walk.row_warp_px(time_s),
            light=lit,
        )


def build_hall(settings: Settings, court: Court) -> hall.Scene:
    """Build the hall of a session."""
    more: dict[str, Any] = {}
    if settings.strength("hall"):
        rng = parallel.generator(settings.seed, WORSE, LOOK)
        more["look"] = look.draw(settings.strength("hall"), rng)
    if settings.strength("court"):
        rng = parallel.generator(settings.seed, WORSE, COURT)
        more["off_m"] = painted_lines.misplacement(court, settings.strength("court"), rng)
    seed = parallel.stream(settings.seed, HALL)
    return hall.build(presets.PRESETS[settings.preset], court, seed, **more)


def plan(settings: Settings, court: Court) -> tuple[list[Camera], walk_path.Walk]:
    """Return the fixed cameras and the walk of a session."""
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
    lens = settings.strength("lens")
    for at, camera in enumerate(fixed):
        rng = parallel.generator(settings.seed, WORSE, LENS, at)
        fixed[at] = replace(camera, dist=lens_errors.added(camera.dist, lens, rng))
    walked = walk_path.plan(
        fixed,
        court,
        settings.size_px,
        preset,
        parallel.generator(settings.walk_seed, PATH),
        speed_kmh=settings.speed_kmh,
        stabiliser=settings.stabiliser,
    )
    walked = walk_path.worsened(
        walked,
        parallel.generator(settings.walk_seed, WORSE),
        lens=lens,
        breathing=settings.strength("breathing"),
        stabiliser=settings.strength("stabiliser") if settings.stabiliser else 0.0,
    )
    return fixed, walked


def simulate(
    settings: Settings,
    court: Court,
    folder: str | Path,
    *,
    backdrops_npz: str | Path | None = None,
    threads: int = 1,
) -> None:
    """Film a session.

    Parameters
    ----------
    settings : Settings
    court : Court
    folder : str or Path
        Receives `court_points.csv`, `truth.npz`, and, if asked for, `{camera}.mp4` for each camera
        of the layout, `walk.mp4` and `boards/{camera}/*.png`; each file appears only when complete.
    backdrops_npz : str, Path or None
        File for the empty hall, for takes; None: not written.
    threads : int
        Number of rendering processes; the files do not depend on it.

    Raises
    ------
    InputError
        If a file cannot be written.
    """
    folder = Path(folder)
    fixed, walked = plan(settings, court)
    with parallel.workers(Studio, (settings, court), threads) as call:
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
    rng = parallel.generator(settings.seed, CLICKS)
    marked = clicks.click_court(fixed, court, court_xyz, preset=preset, rng=rng)
    click_records.write(folder / "court_points.csv", marked, court.points)
    walks = {WALK: _true_walk(settings, walked)} if settings.walk_frames else {}
    own = [settings.readout_s(at) for at in range(len(fixed))]
    readout_s = own if settings.strength("shutter") else None
    session_truth.write(folder / "truth.npz", fixed, walks, court.points, court_xyz, readout_s)


def backdrops(
    settings: Settings,
    court: Court,
    margins: Mapping[int, int],
    *,
    kept_npz: str | Path | None = None,
    threads: int = 1,
) -> dict[int, background.Backdrop]:
    """Return the empty hall as fixed cameras see it.

    Parameters
    ----------
    settings : Settings
    court : Court
    margins : dict of int to int
        Margin on each side, px, of each camera, by its index in the layout.
    kept_npz : str, Path or None
        The file by `simulate`, whose backdrops have no margins; None: the hall is built again.
    threads : int
        Number of processes that render missing backdrops.

    Returns
    -------
    seen : dict of int to Backdrop

    Raises
    ------
    InputError
        If that file is damaged or of other cameras.
    """
    kept = [at for at, margin in margins.items() if kept_npz is not None and not margin]
    seen: dict[int, background.Backdrop] = {}
    if kept and kept_npz is not None:
        fixed = plan(settings, court)[0]
        seen = dict(zip(kept, background.read(kept_npz, [fixed[at] for at in kept]), strict=True))
    others = [(at, margin) for at, margin in margins.items() if at not in seen]
    if others:
        with parallel.workers(Studio, (settings, court), min(threads, len(others))) as call:
            looks = call("backdrop", others)
            seen |= {at: look for (at, _), look in zip(others, looks, strict=True)}
    return seen


def _film_fixed(
    settings: Settings, folder: Path, at: int, camera: Camera, picture: NDArray
) -> None:
    """Write the recording of a fixed camera, and its pictures of a chessboard."""
    preset = presets.PRESETS[settings.preset]
    rng = parallel.generator(settings.seed, STATIC, at)
    light, shutter = settings.light(at), (settings.readout_s(at), preset.exposure_s)
    frames = (
        _trembled(
            picture
            if light is None
            else lamps.lit(picture, light.rows(number / STATIC_HZ, len(picture), *shutter)),
            preset.noise_sigma,
            rng,
        )
        for number in range(settings.static_frames)
    )
    if settings.static_frames:
        writer.write_video(folder / f"{camera.name}.mp4", frames, STATIC_HZ, crf=preset.crf)
    if settings.boards:
        rng = parallel.generator(settings.seed, BOARDS, at)
        place = folder / "boards" / camera.name
        chessboard.simulate(camera, place, picture, rng, noise=preset.noise_sigma)


def _film_walk(
    settings: Settings, folder: Path, walked: walk_path.Walk, frames: Iterable[NDArray]
) -> None:
    rate_hz = (settings.walk_frames - 1) / walked.duration_s  # frame k is at grid time k
    frames = log.progress(frames, settings.walk_frames, f"{WALK}: frames")
    crf = presets.PRESETS[settings.preset].crf
    writer.write_video(folder / f"{WALK}.mp4", frames, rate_hz, crf=crf)


def _trembled(picture: NDArray, noise: float, rng: np.random.Generator) -> NDArray:
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


def _true_walk(settings: Settings, walked: walk_path.Walk) -> session_truth.Walk:
    time_s = walked.grid(settings.walk_frames)
    focal_scale = np.array([walked.focal_scale(time) for time in time_s])
    rows = [walked.row_warp_px(time) for time in time_s]
    return session_truth.Walk(
        time_s=time_s,
        K=walked.K,
        dist=walked.dist,
        cam_from_world=np.array([walked.pose(time) for time in time_s]),
        principal_point_px=np.array([walked.principal_point_px(time) for time in time_s]),
        focal_scale=focal_scale if settings.strength("breathing") else None,
        row_warp_px=None if rows[0] is None else np.array(rows),
        readout_s=settings.readout_s(None) if settings.strength("shutter") else None,
    )
