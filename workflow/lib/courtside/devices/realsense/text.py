"""Data of a RealSense recording beside its pictures, as messages (`.bag`) or text (`.db3`)."""

from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.devices.realsense.rosbag import Bag
from courtside.geometry import camera_fields
from courtside.study.errors import InputError

# Metadata messages to search: they include the first frame's, of which a .bag has about twenty.
FIRST = 60
HOW = "record again in the camera's program"


def pairs(message: Any) -> dict[str, str]:
    """Return `key=value;key=value` of a text message as a dict; empty for other messages."""
    text = getattr(message, "data", "")
    if not isinstance(text, str):
        return {}
    return dict(item.split("=", 1) for item in text.split(";") if "=" in item)


def number(message: Any) -> float:
    """Return the number that a message holds, as text or not; NaN where there is none."""
    try:
        return float(message.data)
    except (AttributeError, TypeError, ValueError):
        return float("nan")


def number_in(message: Any, key: str) -> float:
    """Return a number of a text message; NaN where there is none."""
    try:
        return float(pairs(message)[key])
    except (KeyError, ValueError):
        return float("nan")


def lens(where: str, info: Any) -> tuple[list[int], NDArray, str, NDArray]:
    """Return size, matrix (3, 3), name of the lens model and its coefficients.

    `info` is a `sensor_msgs/CameraInfo` or text; `where`, file and stream, begins messages.
    """
    found = pairs(info)
    coefficients: Any
    if found:
        values = [found.get(key) for key in ("fx", "ppx", "fy", "ppy", "width", "height")]
        fx, ppx, fy, ppy, *size = camera_fields.numbers(
            where, "fx ppx fy ppy width height", values, (6,)
        )
        matrix = np.array([[fx, 0, ppx], [0, fy, ppy], [0, 0, 1]])
        model, coefficients = found.get("model", ""), found.get("coeffs", "0,0,0,0,0").split(",")
    elif hasattr(info, "distortion_model"):
        size = [info.width, info.height]
        matrix = np.asarray(getattr(info, "K", getattr(info, "k", None))).reshape((3, 3))
        model = info.distortion_model
        coefficients = getattr(info, "D", getattr(info, "d", None))
    else:
        raise InputError(f"{where}: expected its lens (camera_info), found another message; {HOW}")
    matrix = camera_fields.numbers(where, "the lens matrix", matrix, (3, 3))
    shapes = tuple((n,) for n in range(13))
    coefficients = camera_fields.numbers(where, "lens coefficients", coefficients, *shapes)
    return [int(length) for length in size], matrix, model, coefficients


def place(where: str, message: Any) -> NDArray:
    """Return `stream_from_reference` (3, 4), metres, of a `geometry_msgs/Transform` or text.

    `where` (file and stream) begins messages. The text holds the rotation column by column.
    """
    found = pairs(message)
    try:
        if found:
            rotation = np.array(found["rotation"].split(","), dtype=float).reshape(3, 3).T
            moved = np.array(found["translation"].split(","), dtype=float).reshape(3)
            # The file has six decimals: take the nearest rotation.
            left, _, right = np.linalg.svd(rotation)
            off = np.abs(left @ right - rotation).max()
            rotation = left @ right
        else:
            turn, shift = message.rotation, message.translation
            quaternion = np.array([turn.x, turn.y, turn.z, turn.w])
            off = abs(np.linalg.norm(quaternion) - 1)
            rotation = scipy.spatial.transform.Rotation.from_quat(quaternion).as_matrix()
            moved = np.array([shift.x, shift.y, shift.z])
        # ASSUME: rounding stays below 1e-3, and the sensors of one camera within 1 m.
        if not off < 1e-3 or np.linalg.det(rotation) < 0 or not np.abs(moved).max() < 1:
            raise ValueError(f"rotation {off:.2g} off, translation {moved.tolist()} m")
    except (KeyError, ValueError, AttributeError, np.linalg.LinAlgError) as error:
        raise InputError(
            f"{where}: expected its place as a rotation and less than 1 m, found "
            f"{camera_fields.short(error)}; {HOW}"
        ) from error
    return np.column_stack([rotation, moved])


def clock(bag: Bag, stream: str) -> str:
    """Return the name of the clock of a stream's times; empty if the recording has none."""
    for message in bag.all(f"{stream}/image/metadata", FIRST):
        if getattr(message, "key", "") == "timestamp_domain":
            return message.value
        if "timestamp_domain" in pairs(message):
            return pairs(message)["timestamp_domain"]
    return ""


def stamps(bag: Bag, stream: str) -> dict[int, tuple[int, float]]:
    """Return (number, time_s) on the camera's clock by message time: a `.db3` keeps them apart."""
    found: dict[int, tuple[int, float]] = {}
    topic = f"{stream}/image/metadata"
    if "timestamp" not in pairs(bag.first(topic)):
        return found
    for _, time_ns, message in bag.messages([topic]):
        number, time_ms = number_in(message, "Frame number"), number_in(message, "timestamp")
        if np.isfinite(number) and np.isfinite(time_ms):
            found[time_ns] = int(number), time_ms * 1e-3
    return found


def stamp(message: Any, time_ns: int, index: int, own_clock: bool) -> tuple[int, float]:
    """Return (number, time_s) of a picture by its own header.

    `time_ns`, the time in the recording, is used unless `own_clock`; `index`, the place in the
    stream, where the header has no number.
    """
    header = message.header
    number = int(getattr(header, "seq", index))
    if not own_clock:
        return number, time_ns * 1e-9
    return number, header.stamp.sec + header.stamp.nanosec * 1e-9
