"""Quality of a calibration with a board: numbers by camera for a JSON file, and warnings."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from courtside.calibration import vertical
from courtside.calibration.boards.adjustment import Found
from courtside.calibration.boards.board import Board
from courtside.calibration.boards.corners import Corners
from courtside.geometry import triangulation

# ASSUME: one camera is told whose corners fit worse by this factor, and by more than a pixel.
MUCH_WORSE, WORSE_PX = 3.0, 1.0
OUT_OF_STEP = 2.0  # ASSUME: more excess scatter of whole pictures is told; at rest it is 1
# ASSUME: where cameras disagree, a delay is told that is larger: of the time from picture to
# picture, and in its standard deviations.
LATE, LATE_SIGMAS = 0.05, 3.0
OF_ESTIMATED = (
    "its lens is probably wrong by more than stated; give `lenses`, or film the board nearer to "
    "this camera, tilted and at rest"
)
OF_GIVEN = (
    "its given lens is probably that of another zoom or camera, or its pictures are blurred; check "
    "`lenses`, and film the board at rest"
)
# By whether lenses are given: what else may be wrong, and what to do.
OF_LENS = {
    True: "given lens is wrong; let it rest, and check `lenses`",
    False: "wide lens bends more than k1 k2 follow; let it rest, and give `lenses` (those from "
    "`chessboard` have k3)",
}


def summary(found: Found, seen: Corners, board: Board, *, known: bool) -> dict[str, Any]:
    """Return for a JSON file how well the corners fit, warnings, and remarks.

    By camera: corners, pictures, `rms_px` per axis, standard deviations of the place (mm) and of
    the focal length, and of moving boards how late it films, in steps (`late_pictures`).
    `neighbour_mm`: error of the distance between neighbouring corners, triangulated from two
    cameras or more, mean and standard deviation. `known` says whether the lenses are given.
    """
    own = [seen.camera == c for c in range(len(found.cameras))]
    rms_px = [float(np.sqrt(np.nanmean(found.error_px[rows] ** 2))) for rows in own]
    report: dict[str, Any] = {"warnings": _warnings(found, seen, rms_px, known)}
    report |= {"remarks": [], "world_of_picture": found.world}
    if not found.stated:
        report["vertical_sigma_deg"] = vertical.sigma_deg(found.covariance.frame)
        report["warnings" if vertical.is_unknown(found.cameras) else "remarks"].append(
            f"board: {vertical.words(found.cameras)}, and z = 0 is at the board of picture "
            f"{found.world}, not at the floor; name the picture in which it lies on the floor as "
            "`floor`"
        )
    report |= {"sigma_px": found.sigma_px, "covariance_factor": found.factor}
    for c, camera in enumerate(found.cameras):
        used = own[c] & np.isfinite(found.error_px[:, 0])
        one = {
            "n_corners": int(used.sum()),
            "n_pictures": len(np.unique(seen.picture[used])),
            "rms_px": rms_px[c],
            "place_sigma_mm": 1000 * found.covariance.place_sigma_m(camera.name),
            "f_px": float(camera.K[1, 1]),
            "f_sigma_px": found.covariance.sigma(camera.name, "f_px"),
        }
        if np.isfinite(found.late[c]):
            one["late_pictures"] = float(found.late[c])
        for key, value in one.items():
            report.setdefault(key, {})[camera.name] = value
    mean, spread, count = neighbours_mm(found, seen, board)
    report["neighbour_mm"] = {"mean": mean, "standard_deviation": spread, "n": count}
    return report


def _warnings(found: Found, seen: Corners, rms_px: Sequence[float], known: bool) -> list[str]:
    lines = []
    worse = _worse(rms_px)
    scatters = found.factor > OUT_OF_STEP
    late = _latest(found) if scatters or worse else None
    if scatters:
        lines.append(
            f"board: whole pictures scatter {found.factor:.1f} times as much as their corners: the "
            "board moved while the cameras did not film at one time, pictures are blurred, or a "
            f"{OF_LENS[known]}"
        )
    if late is not None:  # it spoils the fit of those that see the board with it
        return [*lines, _late_line(found, seen, late)]
    return lines + [
        f"camera {found.cameras[c].name}: its corners fit by {rms_px[c]:.1f} px, those of the "
        f"other cameras by {others:.1f} px: {OF_GIVEN if known else OF_ESTIMATED}"
        for c, others in worse.items()
    ]


def _worse(rms_px: Sequence[float]) -> dict[int, float]:
    """Return the cameras whose corners fit far worse than those of the others, px, with these."""
    found = {}
    for c, own in enumerate(rms_px):
        others = float(np.median([*rms_px[:c], *rms_px[c + 1 :]])) if len(rms_px) > 2 else np.inf
        if own > max(MUCH_WORSE * others, WORSE_PX):
            found[c] = others
    return found


def _latest(found: Found) -> int | None:
    """Return the camera that films at another time than the others, the worst one, or none."""
    sure = np.abs(found.late) > np.maximum(LATE, LATE_SIGMAS * found.late_sigma)
    return int(np.argmax(np.where(sure, np.abs(found.late), 0.0))) if sure.any() else None


def _late_line(found: Found, seen: Corners, c: int) -> str:
    steps = abs(found.late[c])
    in_time = f" ({steps * seen.every_s:.2f} s)" if seen.every_s else ""
    return (
        f"camera {found.cameras[c].name}: films probably {steps:.1f} pictures{in_time} "
        f"{'late' if found.late[c] > 0 else 'early'} by the movement of the board; synchronise the "
        "videos, or let the board rest"
    )


def neighbours_mm(found: Found, seen: Corners, board: Board) -> tuple[float, float, int]:
    """Return by how much neighbouring corners are too far apart, mm: mean, deviation, number."""
    xy = np.full((len(seen.cameras), len(seen.pictures), len(board.corners), 2), np.nan)
    xy[seen.camera, seen.picture, seen.corner] = seen.xy
    xyz, pairs = triangulation.triangulate_all(found.cameras, xy), board.neighbours
    apart = np.linalg.norm(xyz[:, pairs[:, 0]] - xyz[:, pairs[:, 1]], axis=-1)
    off = 1000 * (apart[np.isfinite(apart)] - board.side_m)
    return (float(off.mean()), float(off.std()), len(off)) if len(off) else (np.nan, np.nan, 0)
