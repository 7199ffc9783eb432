"""Read recordings of RealSense cameras: `.bag` (ROS 1) and `.db3` (ROS 2, SDK 2.58 and later).

A stream has the topic `/device_0/sensor_<n>/Depth_<n>` or `.../Color_<n>`, followed by `image/data`
(pictures; in a `.db3` also `image/data/compressed` and `image/data/compressedDepth`, both PNG),
`image/metadata`, `camera_info` (a `.bag`: `info/camera_info`) and `tf/<reference>`: the transform
from the reference's axes to the stream's own. A `.bag` holds ROS messages, a `.db3` text
(`width=640;height=480;fx=...`).
"""

import functools
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.devices import plausible
from courtside.devices.depth_recording import DEFAULT_UNIT_M, STANDING_STILL, DepthRecording
from courtside.devices.realsense import lens, rosbag, text
from courtside.devices.realsense.rosbag import Bag
from courtside.geometry import camera_fields, rotations
from courtside.geometry.camera import Camera
from courtside.records.cameras.frame_times import FrameTimes
from courtside.study.errors import InputError, StrPath
from courtside.study.execution import log

PICTURES = re.compile(
    r"(/device_\d+/sensor_\d+/(Depth|Color)_\d+)/image/data(/compressed|/compressedDepth)?"
)
LONGEST_STEP_S = 10.0  # ASSUME: of frames with numbers in a row; no camera films slower
RECORD = "record depth and colour together in the camera's program"


def read(path: StrPath, name: str = "realsense") -> DepthRecording:
    """Read a `.bag` or `.db3` file; `name` is the device's in the study.

    Times are the camera's own (its hardware clock where both streams have it). Frames with a stray
    time are left out with a warning; frames missing by their numbers are counted in the log. An
    `InputError` if the file is no such recording, damaged, or lacks a stream, its lens or its pose.
    Damage further in, and a clock that was set or restarted, are found when the frames are read.
    """
    path = Path(path)
    with rosbag.opened(path) as bag:
        streams = _streams(bag)
        lenses = {kind: _camera(bag, streams[kind], f"{name}-{kind}") for kind in streams}
        domains = {kind: text.clock(bag, streams[kind]) for kind in streams}
        depth_unit_m, remark = _depth_unit(bag, streams["depth"])
        moved = _colour_from_depth(bag, streams)
        remarks: tuple[str, ...] = (remark,) if remark else ()
        baseline_m = _option(bag, streams["depth"], "Stereo Baseline", np.nan) / 1000
    own_clock = domains["depth"] == domains["colour"]
    if not own_clock:
        remarks += (
            f"the streams have different clocks ({domains}): times are those of the recording",
        )
    follow = functools.partial(_follow, path, name, own_clock)
    colour, depth = ((streams[k], lenses[k]) for k in ("colour", "depth"))
    try:
        return DepthRecording(
            name=name,
            colour=lenses["colour"],
            depth=lenses["depth"],
            colour_from_depth=moved,
            depth_unit_m=depth_unit_m,
            colour_frames=lambda: _pictures(follow(*colour, rosbag.colour)),
            depth_frames=lambda: _pictures(follow(*depth, rosbag.depth)),
            colour_index=lambda: _index(follow(*colour, None)),
            baseline_m=float(baseline_m),
            remarks=remarks,
        )
    except ValueError as error:
        raise InputError(f"{path}: {error}; {RECORD}") from error


def _streams(bag: Bag) -> dict[str, str]:
    """Return the topics of both streams by `depth` and `colour`."""
    found: dict[str, set[str]] = {"Depth": set(), "Color": set()}
    for topic, count in bag.counts.items():
        match = PICTURES.fullmatch(topic)
        if match and count:
            found[match[2]].add(match[1])
    for kind, prefixes in found.items():
        if len(prefixes) != 1:
            seen = sorted(prefixes) or sorted(t for t in bag.counts if "image" in t)[:3] or "none"
            raise InputError(
                f"{bag.path}: expected one stream of pictures named {kind}, found "
                f"{camera_fields.short(seen)}; {RECORD}"
            )
    return {"depth": found["Depth"].pop(), "colour": found["Color"].pop()}


def _camera(bag: Bag, stream: str, name: str) -> Camera:
    where = f"{bag.path}: {stream}"
    info = bag.first(f"{stream}/info/camera_info") or bag.first(f"{stream}/camera_info")
    if info is None:
        raise InputError(f"{where}: expected its lens (camera_info), found none; {RECORD}")
    size, matrix, model, coefficients = text.lens(where, info)
    try:
        camera = Camera(name, (size[0], size[1]), matrix, np.zeros(5), STANDING_STILL)
        dist = lens.five_coefficients(where, model, coefficients, matrix, size)
        return replace(camera, dist=dist)
    except InputError:
        raise
    except ValueError as error:
        raise InputError(f"{where}: {error}; {RECORD}") from error


def _depth_unit(bag: Bag, stream: str) -> tuple[float, str]:
    """Return metres per step, and a remark if that is the default."""
    unit = _option(bag, stream, "Depth Units", np.nan)
    if np.isnan(unit):
        unit = text.number_in(bag.first(f"{stream}/image/metadata"), "depth_units")
    if np.isnan(unit):
        return (
            DEFAULT_UNIT_M,
            f"no depth unit in the recording: {DEFAULT_UNIT_M} m assumed, as cameras have it",
        )
    return float(f"{unit:.7g}"), ""  # stored as a 32-bit float: 0.001 there is 0.0010000000475


def _option(bag: Bag, stream: str, option: str, absent: float) -> float:
    """Return a setting of a stream's sensor."""
    sensor = stream.rpartition("/")[0]
    for name in (option, option.replace(" ", "_")):
        value = text.number(bag.first(f"{sensor}/option/{name}/value"))
        if np.isfinite(value):
            return value
    return absent


def _colour_from_depth(bag: Bag, streams: Mapping[str, str]) -> NDArray:
    places = {}
    for kind, stream in streams.items():
        topics = [topic for topic in bag.counts if topic.startswith(f"{stream}/tf/")]
        found = bag.first(topics[0]) if len(topics) == 1 else None
        if found is None:
            raise InputError(
                f"{bag.path}: {stream}: expected its place (tf), found {len(topics)} of them; "
                f"{RECORD}"
            )
        reference = topics[0].rpartition("/")[2].removeprefix("ref_")
        places[kind] = reference, text.place(f"{bag.path}: {stream}", found)
    (to_depth, depth_from), (to_colour, colour_from) = places["depth"], places["colour"]
    if to_depth != to_colour:
        raise InputError(
            f"{bag.path}: expected depth and colour placed against one reference, found {to_depth} "
            f"and {to_colour}; {RECORD}"
        )
    return rotations.composed(colour_from, rotations.invert(depth_from))


def _follow(
    path: Path,
    name: str,
    own_clock: bool,
    stream: str,
    camera: Camera,
    decode: Callable[[Any], NDArray] | None,
) -> Iterator[tuple[float, int, Any]]:
    """Yield (time_s, number, picture) of a stream; picture is None without `decode`."""
    what, n, numbers, last_s = f"{name}: {stream.rpartition('/')[2]}", 0, [0, 0], 0.0
    with rosbag.opened(path) as bag:
        stamps = text.stamps(bag, stream) if own_clock else {}
        topics = [t for t in bag.counts if (m := PICTURES.fullmatch(t)) and m[1] == stream]
        stamped = (
            (*(stamps.get(time_ns) or text.stamp(message, time_ns, index, own_clock)), message)
            for index, (_, time_ns, message) in enumerate(bag.messages(topics))
        )
        for number, time_s, message in plausible.following(f"{path}: {what}", stamped):
            if n and number == numbers[1] + 1 and time_s - last_s > LONGEST_STEP_S:
                raise InputError(
                    f"{path}: {what}: expected the next frame at {last_s:.3f} s, found it at "
                    f"{time_s:.3f} s though none is missing; the camera's clock was set: {RECORD}"
                )
            n, last_s = n + 1, time_s
            numbers = [number if n == 1 else numbers[0], number]
            yield time_s, number, _decoded(f"{path}: {what} {number}", message, camera, decode)
    missing = max(numbers[1] - numbers[0] + 1 - n, 0)
    log.logger.info("%s: %d frames, %d missing", what, n, missing)


def _decoded(
    where: str, message: Any, camera: Camera, decode: Callable[[Any], NDArray] | None
) -> NDArray | None:
    if decode is None:
        return None
    try:
        picture = decode(message)
    except (ValueError, TypeError, OverflowError, MemoryError) as error:
        raise InputError(f"{where}: {error}; {rosbag.HOW}") from error
    size = picture.shape[1], picture.shape[0]
    if size != camera.size:
        raise InputError(
            f"{where}: expected {camera_fields.times(camera.size)} px as its lens, found "
            f"{camera_fields.times(size)}; {rosbag.HOW}"
        )
    return picture


def _pictures(followed: Iterable[tuple[float, int, Any]]) -> Iterator[tuple[float, NDArray]]:
    for time_s, _, picture in followed:
        yield time_s, picture


def _index(followed: Iterable[tuple[float, int, Any]]) -> FrameTimes:
    rows = [(time_s, number) for time_s, number, _ in followed]
    return FrameTimes(
        np.array([time_s for time_s, _ in rows], dtype=float),
        np.array([number for _, number in rows], dtype=np.int64),
    )
