"""Check the recordings of all sessions of a study before any job starts.

Recordings that jobs make or fetch are checked once they are there.
"""

from collections.abc import Iterable, Iterator
from pathlib import Path

from courtside.calibration.court import court
from courtside.records.devices.clocks import are_stated
from courtside.study.configuration.session_files import is_there
from courtside.study.configuration.sessions import Session, Study, Take
from courtside.study.errors import InputError
from courtside.study.methods import NEEDS_COURT, Calibration, fewer_images
from courtside.validation import (
    boards,
    bodies,
    calibrated,
    devices,
    keypoint_folders,
    lengths,
    points,
    stated_times,
    views,
)
from courtside.validation.remembered import Remembered
from courtside.video import walk_frames
from courtside.video.glance import Glance


def check(study: Study, remembered: Remembered) -> list[str]:
    """Check every recorded session; return what is worth a look, one line each.

    An `InputError` has every fault, one line each, with the session's file.
    """
    faults = [*_court_faults(study)]
    remarks: list[str] = []
    recorded = [one for one in study.sessions.values() if not one.virtual]
    for session in recorded:
        found = _Session(session, study, remembered)
        faults += found.faults()
        remarks += found.remarks()
    remarks += stated_times.repeated(recorded)
    remarks += bodies.unlike(recorded)
    remarks += bodies.compared(study)
    remembered.save()
    if faults:
        raise InputError(*dict.fromkeys(faults))
    return remarks


def _court_faults(study: Study) -> Iterator[str]:
    """Yield what is wrong in the files of the courts, which jobs read before points are clicked."""
    for path in dict.fromkeys(map(study.court_file, study.sessions.values())):
        try:
            if path:
                court.read(path)
        except InputError as error:
            yield from error.lines


class _Session:
    """A session and a look at each of its recordings that is there."""

    def __init__(self, session: Session, study: Study, remembered: Remembered) -> None:
        self._session, self._remembered = session, remembered
        self._unreadable: list[str] = []
        self._static = {
            name: look
            for name, camera in session.cameras.items()
            for look in self._look(camera.static)
        }
        self._takes = {
            name: {
                camera: look
                for camera, path in take.videos.items()
                for look in self._look(path, take.trim_s, film=True)
            }
            for name, take in session.takes.items()
        }
        self._board = {
            camera: look
            for camera, path in _of_board(session, "videos").items()
            for look in self._look(path, film=True)
        }
        self._keypoints = {
            name: keypoint_folders.check(take, self._takes[name], study.skeleton_file)
            for name, take in session.takes.items()
        }
        sizes = {name: next(iter(found.values())) for name, found in self._sizes().items()}
        self._points = points.check(session, study.court_file(session), sizes)
        self._devices = [
            line
            for take in session.takes.values()
            for line in devices.faults(take, remembered, study.skeleton_yaml)
        ]
        self._filmed: dict[str, Glance] = {}  # other videos: of walks, and by devices
        for path in (*session.walks.values(), *_filmed_by_devices(session)):
            for look in self._look(path):
                self._filmed[path] = look
            self._look_at_photos(path)

    def _look(
        self, path: str | None, trim_s: tuple[float, ...] | None = None, *, film: bool = False
    ) -> list[Glance]:
        """Return a look at a file that is there and readable, else nothing.

        A folder, of photos or of a depth camera, is a fault only where a film is needed.
        """
        if path is None or not is_there(Path(path)):
            return []
        if Path(path).is_dir():
            line = f"{path}: expected a video, found a folder; name the file in it"
            self._unreadable += [line] * film
            return []
        try:
            return [self._remembered.look(path, stop_s=trim_s[1] if trim_s else None)]
        except InputError as error:
            self._unreadable += error.lines
            return []

    def _look_at_photos(self, folder: str) -> None:
        """Decode all photos of a walk, if it is a folder that has changed."""
        if not is_there(Path(folder)) or not Path(folder).is_dir():
            return
        try:
            self._remembered.check(folder, "photos", lambda: _decode_all(folder))
        except InputError as error:
            self._unreadable += error.lines

    def faults(self) -> Iterator[str]:
        """Yield every fault."""
        file = self._session.file
        yield from self._unreadable
        yield from self._devices
        for line in calibrated.faults(self._session, self._sizes()):
            yield line if line.startswith(tuple(self._paths())) else f"{file}: {line}"
        for name, take in self._session.takes.items():
            for line in (*self._take_faults(name, take), *self._keypoints[name][0]):
                yield f"{file}: takes.{name}: {line}"
        yield from self._points[0]
        yield from stated_times.named(self._session, self._takes)
        shared = [*self._shared_files()]
        yield from (f"{file}: {line}" for line in shared or self._board_faults())
        yield from (f"{file}: {line}" for line in self._few_pictures())

    def remarks(self) -> Iterator[str]:
        """Yield what is worth a look."""
        board = boards.remarks(self._session.board)
        for line in (*bodies.remarks(self._session.subjects), *board, *self._of_session()):
            yield f"{self._session.file}: {line}"
        yield from self._points[1]
        for name, take in self._session.takes.items():
            said = lengths.remarks(self._takes[name], synchronised=take.synchronised)
            times = stated_times.remarks(take, self._takes[name])
            every = (*said, *times, *self._keypoints[name][1])
            yield from (f"{self._session.file}: takes.{name}: {line}" for line in every)

    def _take_faults(self, name: str, take: Take) -> Iterator[str]:
        looks = self._takes[name]
        yield from lengths.faults(looks, synchronised=take.synchronised)
        if self._session.calibration_file is None:
            yield from lengths.oblong(looks)
        has_clocks = take.synchronised or are_stated(list(take.videos), take.clocks)
        if self._session.take_calibrations() and not has_clocks:
            yield from lengths.too_few(looks)
        yield from stated_times.faults(self._session, take, looks)
        smalls = {camera: look.small for camera, look in looks.items()}
        known, what = self._known_views(name)
        yield from views.faults(take.videos, smalls, known, what)

    def _known_views(self, name: str) -> tuple[dict, str]:
        """Return small pictures of the cameras elsewhere: static recordings, or another take."""
        if self._static:
            return {c: look.small for c, look in self._static.items()}, "its static recording"
        for other, looks in self._takes.items():
            smalls = {camera: look.small for camera, look in looks.items()}
            if other == name:
                break
            if smalls and not views.doubles(smalls):
                return smalls, f"take {other}"
        return {}, ""

    def _board_faults(self) -> Iterator[str]:
        """Yield what is wrong with the views of the cameras in videos of a board."""
        smalls = {camera: look.small for camera, look in self._board.items()}
        known, what = self._known_views("")
        for line in views.faults(_of_board(self._session, "videos"), smalls, known, what):
            yield f"board: {line}"

    def _shared_files(self) -> Iterator[str]:
        """Yield the files that are given for two cameras, in takes of different names."""
        owner: dict[str, tuple[str, str, str]] = {}
        for what, key, camera, path in _by_camera(self._session):
            first = owner.setdefault(path, (camera, what, key))
            if first[0] != camera and (first[1] != what or not what.startswith("take ")):
                yield (
                    f"{key}: expected a recording of this camera, found {path}, which is "
                    f"{first[0]}'s of {first[1]} ({first[2]}); correct one path"
                )

    def _few_pictures(self) -> Iterator[str]:
        """Yield whether walks give fewer pictures than are asked for, where that is known."""
        session, photographed = self._session, self._session.n_walk_frames()
        every_s = session.parameters["extract_frames"]["every_s"]
        n_there = self._n_frames(every_s) if photographed is None else photographed
        if n_there is None or not session.walks:
            return
        ways = [Calibration.parse(way).variant for way in session.calibrations()]
        wanted = session.variants() if not session.cameras else list(filter(None, ways))
        most = max((variant.n_images for variant in wanted), default=0)
        if most > n_there:
            found = f"found {n_there} in videos, one every {every_s:g} s; film longer"
            found = found if photographed is None else f"found {n_there}; take more"
            yield (
                f"walks: expected {most} pictures or more, {found}, or ask for fewer by "
                f"`{fewer_images(n_there)}`"
            )

    def _n_frames(self, every_s: float) -> int | None:
        """Return how many frames filmed walks give at most; None where that is not known."""
        walks = self._session.walks.values()
        lengths = [self._filmed[path].duration_s for path in walks if path in self._filmed]
        known_s = [length_s for length_s in lengths if length_s is not None]
        return sum(int(s / every_s) + 1 for s in known_s) if len(known_s) == len(walks) else None

    def _of_session(self) -> Iterator[str]:
        """Yield lenses that are not used, and why a walk's cameras measure no take."""
        yield from boards.unread_lenses(self._session)
        filmed = any(len(take.cameras) > 1 for take in self._session.takes.values())
        if filmed and self._session.unscaled() and not self._session.take_calibrations():
            yield f"court: {NEEDS_COURT}"

    def _sizes(self) -> dict[str, dict[str, tuple[int, int]]]:
        found: dict[str, dict[str, tuple[int, int]]] = {}
        for camera, look in self._static.items():
            path = self._session.cameras[camera].static or ""
            found.setdefault(camera, {})[path] = look.size
        for name, looks in self._takes.items():
            for camera, look in looks.items():
                path = self._session.takes[name].videos[camera]
                found.setdefault(camera, {})[path] = look.size
        return found

    def _paths(self) -> Iterable[str]:
        given = self._session.calibration_file
        return [*(path for files in self._sizes().values() for path in files), given or "\0"]


def _decode_all(folder: str) -> None:
    for _ in walk_frames.frames(folder):
        pass


def _of_board(session: Session, key: str) -> dict[str, str]:
    """Return the videos, or the folders of pictures, in which each camera sees a board."""
    return (session.board or {}).get(key, {})


def _by_camera(session: Session) -> Iterator[tuple[str, str, str, str]]:
    """Yield what each recording of a fixed camera shows, its key, the camera and the path."""
    for name, take in session.takes.items():
        for camera, path in take.videos.items():
            yield f"take {name}", f"takes.{name}.videos.{camera}", camera, path
    for camera, one in session.cameras.items():
        if one.static:
            yield "the empty court", f"cameras.{camera}.static", camera, one.static
    for key in ("videos", "images"):
        for camera, path in _of_board(session, key).items():
            yield "the board", f"board.{key}.{camera}", camera, path


def _filmed_by_devices(session: Session) -> list[str]:
    devices = [device for take in session.takes.values() for device in take.devices.values()]
    return [device.file for device in devices if device.kind == "rgb"]
