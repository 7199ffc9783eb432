"""Looks at recordings, kept in a file from run to run: an unchanged file is looked at once."""

import base64
import contextlib
import json
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from courtside.study.errors import DAMAGED, InputError, StrPath
from courtside.study.execution import files
from courtside.video.glance import SMALL_PX, Glance, glance

FORMAT = 3  # of the file: another one is not used


class Remembered:
    """Quick looks at recordings by path, size and date.

    A missing or damaged JSON file `path` costs time only. Faults are not kept.
    """

    def __init__(self, path: StrPath) -> None:
        self._path = Path(path)
        self._kept = _read(self._path)
        self._used: dict[str, Any] = {}

    def look(self, path: StrPath, *, stop_s: float | None = None) -> Glance:
        """Look at a video or a photo, or remember it; raises as `glance`."""
        key = _key(Path(path), stop_s)
        if key not in self._used:
            found = _restored(self._kept[key]) if key in self._kept else None
            self._used[key] = _stored(found or glance(path, stop_s=stop_s))
        found = _restored(self._used[key])
        return found if found else glance(path, stop_s=stop_s)

    def check(self, path: StrPath, how: str, read: Callable[[], object]) -> None:
        """Read a file or folder that a check found right before, only if it has changed.

        `how` tells one way of reading from others. What `read` raises is not kept. Of a folder, its
        files count, and of folders in it that files are added or removed.
        """
        parts = sorted(Path(path).iterdir()) if Path(path).is_dir() else [Path(path)]
        key = " ".join([how, *(_key(part, None) for part in parts)])
        if key not in self._kept:
            read()
        self._used[key] = True

    def save(self) -> None:
        """Write what this run used, if it is new and the file may be written."""
        if set(self._used) - set(self._kept):
            with contextlib.suppress(OSError, InputError):
                files.write_json(self._path, {"format": FORMAT, "looks": self._kept | self._used})


def _key(path: Path, stop_s: float | None) -> str:
    try:
        state = path.stat()
    except OSError:
        return str(path)
    return f"{path.absolute()} {state.st_size} {state.st_mtime_ns} {stop_s}"


def _read(path: Path) -> dict[str, Any]:
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        looks = content["looks"] if content["format"] == FORMAT else {}
    except DAMAGED:
        return {}
    return looks if isinstance(looks, dict) else {}


def _stored(found: Glance) -> dict[str, Any]:
    small = base64.b64encode(found.small.tobytes()).decode()
    return {**asdict(found), "size": list(found.size), "small": small}


def _restored(entry: dict[str, Any]) -> Glance | None:
    """Return what was kept; None where it is damaged."""
    try:
        small = np.frombuffer(base64.b64decode(entry["small"]), np.uint8)
        width, height = map(int, entry["size"])
        n_frames, rate_hz, filmed_hz = (entry[key] for key in ("n_frames", "rate_hz", "filmed_hz"))
        return Glance(
            (width, height),
            small.reshape(SMALL_PX[::-1]),
            None if n_frames is None else int(n_frames),
            None if rate_hz is None else float(rate_hz),
            bool(entry["even"]),
            float(entry["late_s"]),
            None if filmed_hz is None else float(filmed_hz),
            bool(entry["interlaced"]),
            float(entry["pixel"]),
        )
    except DAMAGED:
        return None
