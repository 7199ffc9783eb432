"""TRC: marker trajectories as OpenSim and Pose2Sim read them.

Axes: TRC's X, Y, Z are the world's y, z, x, so that Y points up and the system stays right-handed.
Metres; Frame# counts from 1; a missing marker is blank, but at the end of a line `nan`: OpenSim 4.6
refuses a line whose last value is blank, as one value too short. The format has no place for
standard deviations: those of every marker and frame are in the CSV of `exports.tidy` beside it.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from courtside.geometry.camera_fields import METRES
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.study.errors import InputError, StrPath, reading
from courtside.study.execution.files import atomic

WORLD_AXES = [1, 2, 0]  # TRC X, Y, Z <- world axis
TRC_AXES = [2, 0, 1]  # world x, y, z <- TRC axis
HEADER_LINES = 5


def write(path: StrPath, keypoints: Keypoints3D, person: int) -> None:
    """Write one person, by index; raise `InputError` for a take of one frame, which has no rate."""
    if len(keypoints.time_s) < 2:
        raise InputError(
            f"{path}: expected at least 2 frames in a TRC file, found {len(keypoints.time_s)}; "
            "change `trim_s` of the take, or record longer"
        )
    xyz = keypoints.xyz[person][..., WORLD_AXES]
    joints, n_frames = list(keypoints.joints), len(xyz)
    rate = f"{keypoints.rate_hz:.6g}"
    names = ["DataRate", "CameraRate", "NumFrames", "NumMarkers", "Units"]
    names += ["OrigDataRate", "OrigDataStartFrame", "OrigNumFrames"]
    values = [rate, rate, n_frames, len(joints), "m", rate, 1, n_frames]
    lines = [
        f"PathFileType\t4\t(X/Y/Z)\t{Path(path).name}",
        "\t".join(names),
        "\t".join(map(str, values)),
        "Frame#\tTime\t" + "\t".join(f"{joint}\t\t" for joint in joints),
        "\t\t" + "\t".join(f"X{n}\tY{n}\tZ{n}" for n in range(1, len(joints) + 1)),
        "",
    ]
    for at, (time_s, row) in enumerate(
        zip(keypoints.time_s, xyz.reshape(n_frames, -1), strict=True)
    ):
        cells = ["" if np.isnan(value) else f"{value:.6f}" for value in row]
        cells[-1] = cells[-1] or "nan"
        lines.append(f"{at + 1}\t{time_s:.6f}\t" + "\t".join(cells))
    with atomic(path) as temporary:
        temporary.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")


def read(path: StrPath) -> tuple[list[str], float, NDArray, NDArray]:
    """Read joints, rate (Hz), times (T,) s and positions (T, J, 3) of any program's TRC file.

    Positions are metres along world axes, NaN where blank, or 0 0 0 as programs write it that have
    no blanks. Raises `InputError` if the file is not a TRC file in m, cm or mm, a line has another
    number of values, the header counts other markers or frames than there are, or times do not
    follow each other as its rate says.
    """
    with reading(path, "a TRC file", "export it again"):
        lines = Path(path).read_text(encoding="utf-8-sig").splitlines()
        header = dict(zip(lines[1].split("\t"), lines[2].split("\t"), strict=False))
        unit, rate_hz = header["Units"].strip(), float(header["DataRate"])
        if not 0 < rate_hz < np.inf:
            raise ValueError(f"a DataRate of {rate_hz:g}")
        stated = {key: int(header[key]) for key in ("NumMarkers", "NumFrames")}
        joints = [name.strip() for name in lines[3].split("\t")[2:] if name.strip()]
    if unit not in METRES:
        raise InputError(f"{path}: Units: expected one of {list(METRES)}, found {unit!r}")
    rows = [
        _row(path, number, line, 2 + 3 * len(joints))
        for number, line in enumerate(lines[HEADER_LINES:], start=HEADER_LINES + 1)
        if line.strip()
    ]
    if stated != {"NumMarkers": len(joints), "NumFrames": len(rows)}:
        raise InputError(
            f"{path}: expected {stated} as its header says, found {len(joints)} markers and "
            f"{len(rows)} frames; the file may be cut off"
        )
    table = np.array(rows).reshape(len(rows), 2 + 3 * len(joints))
    _check_times(path, table[:, 1], rate_hz)
    xyz = table[:, 2:].reshape(len(rows), len(joints), 3)[..., TRC_AXES] * METRES[unit]
    xyz[(xyz == 0).all(axis=-1)] = np.nan
    return joints, rate_hz, table[:, 1], xyz


def _check_times(path: StrPath, time_s: NDArray, rate_hz: float) -> None:
    """Raise `InputError` unless the times (T,) s are even within half a step of the rate."""
    even = np.abs(np.diff(time_s) * rate_hz - 1) <= 0.5  # False beside a time that is missing
    if not (even.all() and np.isfinite(time_s).all()):
        at = int(np.argmin(even)) if len(even) else 0
        raise InputError(
            f"{path}: Time: expected frames {1 / rate_hz:.4g} s apart, as DataRate ({rate_hz:g}) "
            f"says, found {' and '.join(f'{one:g}' for one in time_s[at : at + 2])} s from frame "
            f"{at + 1} on; export it again without gaps, or correct DataRate"
        )


def _row(path: StrPath, number: int, line: str, wanted: int) -> list[float]:
    cells = line.rstrip("\r\n").split("\t")
    cells += [""] * (wanted - len(cells)) if len(cells) >= 2 else []
    if any(cell.strip() for cell in cells[wanted:]) or len(cells) < wanted:
        raise InputError(f"{path}: line {number}: expected {wanted} values, found {len(cells)}")
    try:
        return [float(cell) if cell.strip() else np.nan for cell in cells[:wanted]]
    except ValueError as error:
        raise InputError(f"{path}: line {number}: expected numbers, found: {error}") from None
