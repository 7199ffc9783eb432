"""Recordings of a folder, the words of their names, and what a session may use them for."""

import re
from collections.abc import Container, Iterable
from dataclasses import dataclass, field
from functools import cached_property

from courtside.drafting import device_names
from courtside.drafting.device_names import DeviceName
from courtside.drafting.names import words_of

# Words that mark a recording of the empty court, of the carried camera, of a chessboard, and words
# that say nothing, as people name files in English, German, French, Spanish, Italian, Portuguese.
STATIC = {"empty", "static", "still", "background", "bg", "vacant", "nobody", "blank"}
STATIC |= {"leer", "leere", "leeraufnahme", "leerbild", "vide"}
STATIC |= {"vacio", "vacia", "vuoto", "vuota", "vazio", "vazia"}
WALK = {"walk", "walking", "mobile", "moving", "handheld", "bridge", "bridging", "sweep", "gang"}
BOARD = {"board", "boards", "chess", "chessboard", "checker", "checkerboard"}
CALIBRATION = {"calib", "calibration"}
BOARD |= CALIBRATION | {"intrinsic", "intrinsics", "int"}
FOLDERS = {"video", "videos", "data", "film", "films", "footage", "takes", "raw"}
FOLDERS |= {"recording", "recordings", "cam", "camera", "kamera"}
FOLDERS |= {"json", "pose", "poses", "pose2d", "keypoints", "openpose", "alphapose", "rtmlib"}
# Words of folders in which Pose2Sim keeps keypoints that it has changed itself.
CHANGED = {"associated", "sync", "filtered"}
# Ends of names of what it draws keypoints into: `pose/left_pose.mp4`, `pose/left_img/`.
DRAWN = {"pose", "img"}
DEVICES = {"bvh": "mocopi", "bag": "realsense", "depth": "rgbd"}  # by kind
WEBCAM = "webcam"
# Words at the end or the start of a name that say what recorded it, not what was recorded.
RECORDERS = {*DEVICES.values(), WEBCAM, "depth"}
RECORDERS |= {"d405", "d415", "d435", "d455", "l515"}  # of RealSense
D435I = ["d435", "i"]  # as words
# ASSUME: cameras that are started and stopped by hand for one take differ by no more than both.
APART_S, APART = 5.0, 0.2


@dataclass(frozen=True)
class Recording:
    """A file, or a folder of photos, that a session may use."""

    path: str  # as a session's file names it
    # Folders below the one that was searched, and the name without its suffix
    parts: tuple[str, ...]
    # `video`, `photo`, `photos`, `keypoints` (a folder of JSON), `bvh`, `bag`, `depth` (a folder
    # of plain files), `court_points`, `own_points` (with their own coordinates), `people`,
    # `racket`, `calibration`, or `unusable`
    kind: str
    size: tuple[int, int] | None = None  # of its pictures, px
    rate_hz: float | None = None  # of a video
    duration_s: float | None = None  # of a video
    n_frames: int | None = None  # of a video; files of keypoints
    n_photos: int = 0  # of a folder of photos
    note: str = ""  # why it is unusable, or what is unusual about it
    # Of a calibration: sizes of the pictures of its cameras
    cameras: dict[str, tuple[int, int]] = field(default_factory=dict)
    # Of keypoints: how many points, and the skeletons that they may be of, the likeliest first
    skeleton: tuple[int, tuple[str, ...]] = (0, ())

    @cached_property
    def device(self) -> DeviceName | None:
        """What a camera or a recorder says in its name."""
        return device_names.read(self.parts[-1]) if self.kind in ("video", "photo") else None

    @property
    def words(self) -> tuple[str, ...]:
        """Words of its name and folders, without counters and moments."""
        if self.device is None:
            return words_of(self.parts)
        said = self.device
        return words_of([*self.parts[:-1], said.before, said.camera, said.after])

    @property
    def written(self) -> str:
        """Its name and folders as a user wrote them: without what a device says."""
        said = self.device
        name = self.parts[-1:] if said is None else (said.before, said.after)
        return "/".join([*self.parts[:-1], *name])


Take = dict[str, Recording]  # by camera
# A recording, its camera, and its words that name neither camera nor counter
Placed = tuple[Recording, str | None, tuple[str, ...]]
Words = dict[str, tuple[str, ...]]  # by path, or by camera


@dataclass
class Guess:
    """What the recordings of a folder seem to be."""

    cameras: list[str] = field(default_factory=list)
    static: dict[str, Recording] = field(default_factory=dict)  # by camera
    # Pictures of a chessboard, by camera
    boards: dict[str, Recording] = field(default_factory=dict)
    walks: dict[str, Recording] = field(default_factory=dict)
    # By take and camera: videos, or folders of keypoints where there are no videos
    takes: dict[str, Take] = field(default_factory=dict)
    # By take and camera: folders of keypoints, beside videos and alone
    keypoints: dict[str, Take] = field(default_factory=dict)
    # Take or "", kind of device, file
    devices: list[tuple[str, str, Recording]] = field(default_factory=list)
    # Cameras that no name tells apart: numbered in the order of their files
    numbered: list[str] = field(default_factory=list)
    serials: dict[str, str] = field(default_factory=dict)  # by camera
    court_points: Recording | None = None  # or points with their own coordinates
    people: Recording | None = None  # in which persons are named
    calibration: Recording | None = None
    unused: list[tuple[Recording, str]] = field(default_factory=list)  # with the reason
    by_order: list[str] = field(default_factory=list)  # takes that no name tells, but the order
    doubtful: bool = False  # whether names may be read in another way: takes for cameras

    @property
    def own_points(self) -> bool:
        """Whether the points have their own coordinates, so that no court is needed."""
        return self.court_points is not None and self.court_points.kind == "own_points"

    def films(self, camera: str) -> list[Recording]:
        """Return a camera's recordings of takes."""
        return [take[camera] for take in self.takes.values() if camera in take]


def called(recording: Recording, vocabulary: Container[str]) -> bool:
    """Say whether a word of a recording's name, but for its number, is one of these."""
    return any(uncounted(word) in vocabulary for word in recording.words)


def lengths_fit(recordings: Iterable[Recording]) -> bool:
    """Say whether recordings are about as long as each other, as those of one take are."""
    lengths = [r.duration_s for r in recordings if r.duration_s is not None]
    return not lengths or max(lengths) - min(lengths) <= max(APART_S, APART * max(lengths))


def uncounted(word: str) -> str:
    """Return a word without the number behind it."""
    return re.sub("[0-9]+$", "", word)


def is_called_walk(recording: Recording) -> bool:
    """Say whether the name of a recording says that it is a walk."""
    return called(recording, WALK)
