"""BVH files: header, rows of motion, and the poses of the joints."""

import contextlib
import re
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote, unquote

import bvhio
import numpy as np
from numpy.typing import NDArray

from courtside.records.devices.hierarchy import NO_PARENT, Hierarchy, PosedHierarchy
from courtside.study.errors import InputError, StrPath

CENTIMETRES_M = 0.01
DEGREE = np.pi / 180
TURNED = {"X": (1, 2), "Y": (2, 0), "Z": (0, 1)}  # columns that a rotation about an axis mixes


def read(path: StrPath, *, unit_m: float = CENTIMETRES_M, radians: bool = False) -> PosedHierarchy:
    """Read a BVH file: joints by its names, which need not be unique, in its order and axes.

    `unit_m` is the length of the file's unit, metres: BVH does not say it; mocopi's is the
    centimetre. Angles are degrees, as the format has it, unless `radians`. Time is from zero.
    Position channels replace the offset, axis by axis. An `InputError` if the file is not BVH; see
    `read_text`.

    Meredith & Maddock 2001. Rotations are about the joint's own rotated axes in the order of its
    CHANNELS: Zrotation Xrotation Yrotation is R = Rz Rx Ry, Tait-Bryan, not the proper Euler angles
    (z-x-z) of some descriptions.
    """
    text = read_text(path)
    names, parents, channels = _joints(text)
    hierarchy = Hierarchy(
        joints=tuple(names),
        parents=np.array(parents),
        offsets=text.offsets * unit_m,
        ends={names[at]: text.ends[at] * unit_m for at in sorted(text.ends, reverse=True)},
    )
    columns: dict[tuple[int, str], int] = {}
    for joint, own in enumerate(channels):
        for channel in own:
            columns[joint, channel] = len(columns)
    return PosedHierarchy(
        hierarchy=hierarchy,
        time_s=np.arange(len(text.rows)) * text.frame_time_s,
        translation=_translations(text, columns) * unit_m,
        parent_from_joint=_rotations(text.rows, channels, columns, 1.0 if radians else DEGREE),
    )


def _joints(text: "BvhText") -> tuple[list[str], list[int], list[Sequence[str]]]:
    """Return the names, parents and channels of the joints, as bvhio reads them."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "hierarchy.bvh"
        path.write_text(f"{text.hierarchy}\nMOTION\nFrames: 0\nFrame Time: 0\n", encoding="ascii")
        root = bvhio.readAsBvh(str(path)).Root
    names: list[str] = []
    parents: list[int] = []
    channels: list[Sequence[str]] = []
    waiting = [(root, NO_PARENT)]
    while waiting:
        joint, parent = waiting.pop()
        waiting += [(child, len(names)) for child in reversed(joint.Children)]
        names.append(unquote(joint.Name))
        parents.append(parent)
        channels.append(joint.Channels)
    return names, parents, channels


def _translations(text: "BvhText", columns: Mapping[tuple[int, str], int]) -> NDArray:
    """Return each joint's origin in its parent, (T, J, 3) in the file's unit."""
    found = np.repeat(text.offsets[None], len(text.rows), axis=0)
    for (joint, channel), column in columns.items():
        if channel.endswith("position"):
            found[:, joint, AXES.index(channel[0])] = text.rows[:, column]
    return found


def _rotations(
    rows: NDArray,
    channels: Sequence[Sequence[str]],
    columns: Mapping[tuple[int, str], int],
    unit: float,
) -> NDArray:
    """Return each joint's rotation in its parent, (T, J, 3, 3); one order at a time.

    `unit` is that of the angles, rad.
    """
    found = np.tile(np.eye(3), (len(rows), len(channels), 1, 1))
    orders = [tuple(c for c in own if c.endswith("rotation")) for own in channels]
    for order in set(orders) - {()}:
        joints = [joint for joint, own in enumerate(orders) if own == order]
        turned = np.zeros((3, 3, len(joints), len(rows)))
        turned[range(3), range(3)] = 1.0
        for channel in order:
            angle = unit * rows[:, [columns[joint, channel] for joint in joints]].T
            first, second = TURNED[channel[0]]
            cosine, sine = np.cos(angle), np.sin(angle)
            before = turned[:, first].copy()
            turned[:, first] = cosine * before + sine * turned[:, second]
            turned[:, second] = cosine * turned[:, second] - sine * before
        found[:, joints] = np.moveaxis(turned, (3, 2), (0, 1))
    return found


LARGEST = 1e9  # of any number: sums and products of such stay finite
# ASSUME: far above what any program writes for a number; longer ones are damage.
MAX_DIGITS = 40
MAX_PER_CHANNEL = 100  # characters of a row for each channel, blanks included
NUMBER = re.compile(r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
EXPORT_AGAIN = "export the file again"


def is_number(word: str, least: float = -LARGEST, most: float = LARGEST) -> bool:
    """Return whether a word is a plain decimal number from `least` to `most`, both included."""
    return (
        len(word) <= MAX_DIGITS
        and NUMBER.fullmatch(word) is not None
        and least <= float(word) <= most
    )


def shown(word: str) -> str:
    """Return a word as an error shows it: short, on one line."""
    if not word:
        return "nothing"
    return repr(word if len(word) <= MAX_DIGITS else word[:MAX_DIGITS] + "...")


def read_rows(path: StrPath, text: str, at: int, n_frames: int, n_channels: int) -> NDArray:
    """Read the rows of motion, (T, C) float, which begin at `at` of the whole file's text.

    An `InputError` if there are more or fewer rows, or a row is not so many finite numbers.
    """
    lines = text[at:].split("\n")
    filled = [line for line in lines if line and not line.isspace()]
    if len(filled) != n_frames:
        raise InputError(
            f"{path}: expected {n_frames} rows of motion as `Frames:` says, found {len(filled)}; "
            "the file may be cut off, or correct the count"
        )
    if not n_frames:
        return np.empty((0, n_channels))
    if not n_channels:
        raise InputError(f"{path}: expected a channel in some joint, found none; {EXPORT_AGAIN}")
    rows = np.empty((0, 0))
    if max(map(len, filled)) <= MAX_PER_CHANNEL * n_channels:
        with contextlib.suppress(ValueError):
            rows = np.loadtxt(filled, comments=None, ndmin=2)
    if rows.shape != (n_frames, n_channels) or not (np.abs(rows) <= LARGEST).all():
        raise _bad_row(path, lines, text.count("\n", 0, at) + 1, n_channels)
    return rows


def _bad_row(path: StrPath, lines: Sequence[str], first: int, n_channels: int) -> InputError:
    """Return the error of the first row that is not `n_channels` numbers."""
    for number, line in enumerate(lines, start=first):
        is_wide = len(line) > MAX_PER_CHANNEL * n_channels  # splitting it could take long
        words = [] if is_wide else line.split()
        others = [word for word in words if not is_number(word)]
        if is_wide or len(words) not in (0, n_channels):
            expected = f"{n_channels} numbers, one for each channel"
            found = f"a line of {len(line)} characters" if is_wide else len(words)
        elif others:
            expected, found = f"finite numbers of at most {LARGEST:g}", shown(others[0])
        else:
            continue
        return InputError(
            f"{path}: line {number}: expected {expected}, found {found}; {EXPORT_AGAIN}"
        )
    return InputError(
        f"{path}: expected rows of {n_channels} numbers, found others; {EXPORT_AGAIN}"
    )


AXES = ("X", "Y", "Z")
CHANNELS = {
    f"{axis}{kind}".lower(): f"{axis}{kind}" for kind in ("position", "rotation") for axis in AXES
}
MAX_BYTES = 256 << 20  # 50 minutes of mocopi at 60 frames a second
# ASSUME: far above any take and any body, far below what would fill the memory.
MAX_LINES = 1_000_000
MAX_JOINTS = 1000
MAX_NAME = 100
LONGEST_FRAME_S = 3600.0
MAX_DEPTH = 100  # bvhio recurses once a level
MAX_JOINT_FRAMES = 5_000_000  # the rotations of all joints and frames then take 360 MB
FRAMES = re.compile(r"\s*frames\s*:[^\S\n]*(\S*)[^\S\n]*(?:\n|\Z)", re.IGNORECASE)
FRAME_TIME = re.compile(r"\s*frame\s+time\s*:[^\S\n]*(\S*)[^\S\n]*(?:\n|\Z)", re.IGNORECASE)


@dataclass(frozen=True, eq=False)
class BvhText:
    """The checked content of a BVH file, in its unit and degrees."""

    hierarchy: str  # as bvhio reads it: capitals, one item a line; names percent-encoded to ASCII
    offsets: NDArray  # (J, 3): OFFSET of each joint in the file's order
    ends: dict[int, NDArray]  # (3,) each: End Site of the joints that have one, by their index
    frame_time_s: float  # from row to row
    rows: NDArray  # (T, C): the motion, a column for each channel


class _Words:
    """The words of a text in order, and their positions."""

    def __init__(self, path: StrPath, text: str) -> None:
        self.path, self.text = path, text
        self.found = re.compile(r"\S+").finditer(text)
        self.start = self.end = 0

    def take(self) -> str:
        """Return the next word; empty at the end of the file."""
        match = next(self.found, None)
        self.start, self.end = match.span() if match else (len(self.text), len(self.text))
        return match.group() if match else ""

    def expect(self, wanted: str, where: str) -> str:
        word = self.take()
        if word.upper() != wanted:
            raise self.error(f"expected {wanted} {where}", word)
        return word

    def number(self, where: str) -> float:
        word = self.take()
        if not is_number(word):
            raise self.error(f"expected a number {where}", word)
        return float(word)

    def error(self, expected: str, word: str, mend: str = EXPORT_AGAIN) -> InputError:
        line = self.text.count("\n", 0, self.start) + 1
        return InputError(f"{self.path}: line {line}: {expected}, found {shown(word)}; {mend}")


class _Reader:
    """Reads the hierarchy joint by joint, with a list of open joints instead of recursion."""

    def __init__(self, words: _Words) -> None:
        self.words = words
        self.lines = ["HIERARCHY"]
        self.offsets: list[list[float]] = []
        self.ends: dict[int, list[float]] = {}
        self.n_channels = 0
        self.open: list[tuple[int, str]] = []

    def read(self) -> "_Reader":
        self.words.expect("HIERARCHY", "in front of the joints")
        self.words.expect("ROOT", "after HIERARCHY")
        self._joint("ROOT")
        while self.open:
            index, name = self.open[-1]
            word = self.words.take()
            if word.upper() == "JOINT":
                self._joint("JOINT")
            elif word.upper() == "END" and index not in self.ends:
                self._end_site(index, name)
            elif word == "}":
                self.lines.append("}")
                self.open.pop()
            else:
                raise self.words.error(f"expected JOINT, one End Site or }} in joint {name}", word)
        return self

    def _joint(self, kind: str) -> None:
        name = self.words.take()
        if not 0 < len(name) <= MAX_NAME or not name.isprintable() or name in ("{", "}"):
            raise self.words.error(
                f"expected a joint's name of up to {MAX_NAME} printable letters", name
            )
        if len(self.offsets) == MAX_JOINTS or len(self.open) == MAX_DEPTH:
            limit = f"at most {MAX_JOINTS} joints, {MAX_DEPTH} of them in a chain"
            raise self.words.error(f"expected {limit}", f"joint {name}")
        self.words.expect("{", f"after the name of joint {name}")
        self.open.append((len(self.offsets), name))
        self.offsets.append(self._offset(f"of joint {name}"))
        channels = self._channels(name)
        self.n_channels += len(channels)
        offset = "OFFSET {} {} {}".format(*self.offsets[-1])
        self.lines += [
            f"{kind} {quote(name)}",
            "{",
            offset,
            " ".join(["CHANNELS", str(len(channels)), *channels]),
        ]

    def _offset(self, where: str) -> list[float]:
        self.words.expect("OFFSET", where)
        return [self.words.number(f"in OFFSET {where}") for _ in AXES]

    def _channels(self, name: str) -> list[str]:
        self.words.expect("CHANNELS", f"after OFFSET of joint {name}")
        count = self.words.take()
        if count not in map(str, range(len(CHANNELS) + 1)):
            raise self.words.error(f"expected 0 to {len(CHANNELS)} CHANNELS of joint {name}", count)
        channels: list[str] = []
        for at in range(int(count)):
            word = self.words.take()
            channel = CHANNELS.get(word.lower())
            if channel is None or channel in channels:
                raise self.words.error(
                    f"CHANNELS of joint {name}: expected {count} different ones of "
                    f"{', '.join(CHANNELS.values())}",
                    word,
                    f"correct the one after the first {at}",
                )
            channels.append(channel)
        return channels

    def _end_site(self, index: int, name: str) -> None:
        where = f"of the End Site of joint {name}"
        self.words.expect("SITE", f"after End in joint {name}")
        self.words.expect("{", f"at the start {where}")
        self.ends[index] = self._offset(where)
        self.words.expect("}", f"at the end {where}")


def read_text(path: StrPath) -> BvhText:
    """Read the text of a BVH file and check it: one ROOT, keywords in any case, any whitespace.

    An `InputError` if the file cannot be read, is not BVH, or is larger than any take; the message
    names the line.
    """
    text = _load(path)
    words = _Words(path, text)
    found = _Reader(words).read()
    words.expect("MOTION", "after the joints of the one ROOT")
    n_frames, frame_time_s, at = _motion_header(words)
    if n_frames * len(found.offsets) > MAX_JOINT_FRAMES:
        raise InputError(
            f"{path}: expected at most {MAX_JOINT_FRAMES} joints times frames, found "
            f"{len(found.offsets)} times {n_frames}; cut the take into pieces"
        )
    return BvhText(
        hierarchy="\n".join(found.lines),
        offsets=np.array(found.offsets, dtype=float),
        ends={index: np.array(offset) for index, offset in found.ends.items()},
        frame_time_s=frame_time_s,
        rows=read_rows(path, text, at, n_frames, found.n_channels),
    )


def _load(path: StrPath) -> str:
    path = Path(path)
    try:
        if not path.is_file():
            raise InputError(f"{path}: expected a BVH file, found no file; correct the path")
        size = path.stat().st_size
        if size > MAX_BYTES:
            raise InputError(
                f"{path}: expected a BVH file of at most {MAX_BYTES >> 20} MiB, found {size >> 20} "
                "MiB; cut the take into pieces"
            )
        text = path.read_bytes().decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: expected a text file, found: {error}; {EXPORT_AGAIN}") from None
    if text.count("\n") > MAX_LINES:
        raise InputError(
            f"{path}: expected at most {MAX_LINES} lines, found more; cut the take into pieces"
        )
    return text


def _motion_header(words: _Words) -> tuple[int, float, int]:
    """Return the number of frames, the frame time, and where the rows begin."""
    frames, at = _header(words, FRAMES, "`Frames: COUNT`", words.end)
    if not frames.isascii() or not frames.isdecimal() or len(frames) > len(str(MAX_JOINT_FRAMES)):
        raise words.error(f"expected 0 to {MAX_JOINT_FRAMES} as the number of Frames", frames)
    time_s, at = _header(words, FRAME_TIME, "`Frame Time: SECONDS`", at)
    least = 0.0 if int(frames) <= 1 else np.finfo(float).tiny
    if not is_number(time_s, least, LONGEST_FRAME_S):
        positive = "of 0 or more" if least == 0 else "above 0"
        raise words.error(
            f"expected a Frame Time {positive} and up to {LONGEST_FRAME_S:g} s", time_s
        )
    return int(frames), float(time_s), at


def _header(words: _Words, pattern: re.Pattern[str], wanted: str, at: int) -> tuple[str, int]:
    match = pattern.match(words.text, at)
    words.start = match.start(1) if match else at
    if not match:
        rest = words.text[at : at + MAX_DIGITS + 1].strip().partition("\n")[0]
        raise words.error(f"expected {wanted} alone on its line", rest)
    return match.group(1), match.end()
