"""C3D: the biomechanics exchange format, written through ezc3d.

Millimetres, because many readers take C3D points for millimetres without looking at POINT:UNITS.
World axes, z up, as POINT:X_SCREEN and Y_SCREEN say.

The fourth word of a point, taken as an integer, has the residual in its low byte, in units of
|POINT:SCALE|, and the cameras that saw the point in its high byte (c3d.org, "3D point residuals").
ezc3d 1.7 exchanges the two bytes, so the words are written here. Programs that read by ezc3d
therefore see 0 for every point that is there.

The header and POINT:FRAMES count at most 65,535 frames. The number of more is in POINT:LONG_FRAMES
(c3d.org, "LONG_FRAMES"), which ezc3d does not read: to programs that use it, the file ends there.

The format has no times: frame 1 is at 0 s, and the first frame's number follows from its time, to
half a frame. Before 0 s, or where the last number would be too large, it is 1. POINT:START_S is
the time itself.
"""

import struct

import ezc3d
import numpy as np
from numpy.typing import NDArray

from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.study.errors import InputError, StrPath
from courtside.study.execution import log
from courtside.study.execution.files import atomic

MM_PER_M = 1000.0
MISSING = -1.0
MOST_RESIDUAL_MM = 127.0  # above, readers that take the byte as signed see a missing point
BLOCK_BYTES = 512
FIRST_DATA_BLOCK = slice(16, 18)  # of the header: the block, from 1, in which the points begin
MOST_ROUNDED_MM = 1.0  # points have 24 bits: 1 mm at 17 km from the origin
MOST_COUNTED = 65535  # frames: header and POINT:FRAMES count in 16 bits


def write(path: StrPath, keypoints: Keypoints3D, person: int) -> None:
    """Write one person, by index.

    A point's residual is its root-mean-square standard deviation over the axes, mm, of all errors
    that are known (`Keypoints3D.covariance`), 127 where it is larger; -1 marks a
    missing point, 0 one without a known uncertainty (interpolated, for one). Raises `InputError` if
    the take is one frame, which has no rate, or the disk refuses the file.
    """
    xyz = keypoints.xyz[person] * MM_PER_M
    n_frames, n_joints, _ = xyz.shape
    if n_frames < 2:
        raise InputError(
            f"{path}: expected at least 2 frames in a C3D file, found {n_frames}; change `trim_s` "
            "of the take"
        )
    file = ezc3d.c3d()
    file["header"]["points"]["first_frame"] = _first_frame(keypoints)
    point = file["parameters"]["POINT"]
    point["UNITS"]["value"] = ["mm"]
    point["RATE"]["value"] = [keypoints.rate_hz]
    point["LABELS"]["value"] = [str(joint) for joint in keypoints.joints]
    file.add_parameter("POINT", "X_SCREEN", ["+X"])
    file.add_parameter("POINT", "Y_SCREEN", ["+Z"])
    file.add_parameter("POINT", "START_S", [float(keypoints.time_s[0])])
    if n_frames > MOST_COUNTED:
        file.add_parameter("POINT", "LONG_FRAMES", [float(n_frames)])
        log.logger.warning(
            "%s: %d frames; programs that read by ezc3d, such as OpenSim, see the first %d alone: "
            "give them the TRC file",
            *(path, n_frames, MOST_COUNTED),
        )
    _warn_of_rounding(path, xyz)
    points = np.ones((4, n_joints, n_frames))
    points[:3] = xyz.transpose(2, 1, 0)
    file["data"]["points"] = points
    residuals = _residuals(keypoints, person)
    file["data"]["meta_points"]["residuals"] = residuals.T[np.newaxis]
    with atomic(path) as temporary:
        file.write(str(temporary))
        content = bytearray(temporary.read_bytes())
        start = _first_point(path, content, points.size * 4)
        stored = np.frombuffer(content, "<f4", points.size, start).reshape(n_frames, n_joints, 4)
        stored[..., 3] = residuals
        temporary.write_bytes(content)


def _first_frame(keypoints: Keypoints3D) -> int:
    """Return the number of the first frame, from 0, on the clock of the take."""
    first = round(float(keypoints.time_s[0]) * keypoints.rate_hz)
    return first if 0 <= first <= MOST_COUNTED - len(keypoints.time_s) else 0


def _warn_of_rounding(path: StrPath, xyz: NDArray) -> None:
    """Warn of places so far from the origin that the points of the format round them."""
    rounded = np.abs(xyz.astype(np.float32) - xyz)
    if (worst := np.max(rounded, initial=0.0, where=np.isfinite(rounded))) > MOST_ROUNDED_MM:
        log.logger.warning(
            "%s: places are up to %.0f mm off, because C3D rounds numbers so far from the origin: "
            "use the TRC file, or coordinates that begin near the court",
            *(path, worst),
        )


def _first_point(path: StrPath, content: bytes | bytearray, n_bytes: int) -> int:
    """Return where the points begin, and check that the file is complete.

    ezc3d does not notice a full disk; it writes last where the points begin.
    """
    header = content[FIRST_DATA_BLOCK].ljust(2, b"\0")
    before = BLOCK_BYTES * (struct.unpack("<H", header)[0] - 1)
    if before < 2 * BLOCK_BYTES or len(content) < before + n_bytes:
        raise InputError(
            f"{path}: expected to write {n_bytes} bytes of points, found {len(content)} bytes of a "
            "file that is not whole: free or allow the space"
        )
    return before


def _residuals(keypoints: Keypoints3D, person: int) -> NDArray:
    """Return (T, J) in whole mm."""
    variance = np.trace(keypoints.covariance[person], axis1=-2, axis2=-1) / 3
    residual = np.sqrt(np.nan_to_num(variance, nan=0.0)) * MM_PER_M
    residual = np.minimum(np.rint(residual), MOST_RESIDUAL_MM)
    return np.where(np.isfinite(keypoints.xyz[person]).all(axis=-1), residual, MISSING)
