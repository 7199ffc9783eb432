"""Quality of a calibration with a wand: numbers by camera for a JSON file, and warnings."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.calibration import vertical
from courtside.calibration.court import place_checks
from courtside.calibration.wand import timing, world
from courtside.calibration.wand.adjustment import WRONG_SIGMAS
from courtside.calibration.wand.calibration import Found, middle_share
from courtside.calibration.wand.points import Seen, Wand
from courtside.geometry import camera_fields
from courtside.statistics.normal_errors import MEDIAN_TO_SIGMA

# ASSUME: limits of the warnings.
MOST_FACTOR = 2.0  # scatter of blocks of time, relative to single frames
# Delay of a camera: in its standard deviations, and either in frames, or in px along the path of
# the markers over the sigma of a marker: frames of the file may be every tenth of the video.
LATE_SIGMAS, LATE, LATE_PX = 5.0, 0.03, 1.0
MOST_WRONG = 30.0  # %, of a camera's markers; of a right one it is 0 to a few
LEAST_PATH = 0.3  # extent of the path in a picture of an unknown lens, of the diagonal
LONGER_SIGMAS = 4.0  # error of the stated length by clicked points, in its standard deviations
SHARE_SIGMAS = 3.0  # error of the middle marker, in standard deviations
MOST_SIGMA_PX = 3.0  # of a marker


def summary(found: Found, wand: Wand, seen: Seen, known: set[str]) -> dict[str, Any]:
    """Return the fit of the markers, warnings and remarks.

    `known` are the cameras with given lenses.

    By camera: number of frames, `rms_px` per axis without wrong markers, the share of these
    (`wrong_percent`) of the markers that another camera sees, standard deviations of the position
    (mm) and of an estimated lens, and the delay in frames (`late_frames`). `length_mm` is the error
    of the wand's length where two cameras or more see both ends: `median`, `spread` (1.4826
    times the median absolute deviation), number.
    """
    off = found.error_px
    fine = np.abs(off).max(axis=-1) < WRONG_SIGMAS * found.adjusted.sigma_px
    wrong, shared = _wrong(found, seen, fine)
    late, *more_of_late = timing.delays(found.cameras, seen, found.xyz)
    report: dict[str, Any] = {"warnings": [], "world": found.world}
    report |= {"sigma_px": found.adjusted.sigma_px, "covariance_factor": found.adjusted.factor}
    report["length_mm"] = _length_mm(found, wand)
    sigma = found.covariance.sigma
    for c, camera in enumerate(found.cameras):
        one = {
            "n_frames": int(np.isfinite(seen.xy[c, ..., 0]).any(axis=1).sum()),
            "rms_px": float(np.sqrt(np.mean(off[c][fine[c]] ** 2))),
            "wrong_percent": 100 * float(wrong[c].sum() / max(int(shared[c].sum()), 1)),
            "place_sigma_mm": 1000 * found.covariance.place_sigma_m(camera.name),
            "late_frames": float(late[c]),
        }
        if camera.name not in known:
            one |= {"f_px": float(camera.K[1, 1]), "f_sigma_px": sigma(camera.name, "f_px")}
            one |= {"k1": float(camera.dist[0]), "k1_sigma": sigma(camera.name, "k1")}
        for key, value in one.items():
            report.setdefault(key, {})[camera.name] = value
    report["warnings"] = _warnings(found, wand) + _late(found, late, *more_of_late)
    report["warnings"] += _often_wrong(report["wrong_percent"]) + _of_pictures(found, seen, known)
    report["remarks"] = []
    if not found.stated:
        report["warnings" if vertical.is_unknown(found.cameras) else "remarks"].append(
            _world(found)
        )
    if found.vertical_deg is not None:
        report["vertical_sigma_deg"] = found.vertical_deg
    return report


def _wrong(found: Found, seen: Seen, fine: NDArray) -> tuple[NDArray, NDArray]:
    """Return how much each marker (C, F, M) is wrong, 0 to 1, and which ones another camera sees.

    If no two of n cameras agree on a marker, n - 1 of them or more see another spot. Which ones is
    unknown, so each counts (n - 1) / n. So does each of two cameras that agree badly.
    """
    known = np.isfinite(seen.xy[..., 0])
    count = known.sum(axis=0)
    shared = known & (count >= 2)
    single = np.isfinite(found.xyz[..., 0]) & (count > 2)
    disagreeing = (known & ~fine).any(axis=0) * (count - 1) / np.maximum(count, 1)
    return np.where(shared, np.where(single, ~fine, disagreeing), 0.0), shared


def _length_mm(found: Found, wand: Wand) -> dict[str, float | int]:
    apart = np.linalg.norm(found.xyz[:, -1] - found.xyz[:, 0], axis=1)
    off = 1000 * (apart[np.isfinite(apart)] - wand.length_m)
    middle = float(np.median(off)) if len(off) else np.nan
    spread = MEDIAN_TO_SIGMA * float(np.median(np.abs(off - middle))) if len(off) else np.nan
    return {"median": middle, "spread": spread, "n": len(off)}


def _world(found: Found) -> str:
    return (
        f"wand: the origin is the middle of the wand's path, {vertical.words(found.cameras)}, and "
        f"x runs from camera {found.cameras[0].name} to {found.cameras[1].name}; set `floor` to "
        "frames in which the wand lies on the floor, or click court points"
    )


def _warnings(found: Found, wand: Wand) -> list[str]:
    lines = []
    if found.adjusted.sigma_px > MOST_SIGMA_PX:
        lines.append(
            f"wand: expected markers with a sigma below {MOST_SIGMA_PX:g} px, found "
            f"{found.adjusted.sigma_px:.1f} px; check the markers in the file, and `lenses`"
        )
    if found.adjusted.factor > MOST_FACTOR:
        lines.append(
            f"wand: residuals of neighbouring frames are correlated (factor "
            f"{found.adjusted.factor:.1f} of the variance); check that the videos are "
            "synchronised, that the tracker follows the markers, and that the lenses are right: "
            "given ones up to the edges of the pictures, estimated ones not too wide for k1 k2"
        )
    longer = found.adjusted.state.length
    if abs(longer) > LONGER_SIGMAS * wand.sigma_m / wand.length_m:
        lines.append(
            f"wand: expected a length of {1000 * wand.length_m:.1f} mm, found "
            f"{1000 * wand.length_m * np.exp(longer):.1f} mm by the clicked points; measure it "
            "between the markers' centres"
        )
    return lines + _middle(found, wand) + _hanging(found)


def _middle(found: Found, wand: Wand) -> list[str]:
    """Return a warning if the middle one of three markers shows that a stated length is wrong.

    The sigma of the length is also that of the middle marker.
    """
    stated, share, sigma = middle_share(wand, found.xyz)
    if not abs(share - stated) > SHARE_SIGMAS * np.hypot(sigma, wand.sigma_m / wand.length_m):
        return []
    return [
        f"wand: expected the middle marker at {100 * stated:.2f} % of the length from the first, "
        f"found it at {100 * share:.2f} %: `length_m` or `middle_m` is wrong, and with `length_m` "
        "all lengths; measure both between the markers' centres"
    ]


def _hanging(found: Found) -> list[str]:
    """Return a warning if half of the cameras or more hang upside down above the wand's floor.

    The mirror image of the wand fits as well as the wand, and turns all cameras over. Clicked
    points show it by themselves; a floor shows only this.
    """
    up = {camera.name: place_checks.up(camera) for camera in found.cameras}
    names = [name for name, along in up.items() if along < -place_checks.UPRIGHT]
    if found.world != world.FLOOR or 2 * len(names) < len(up):
        return []
    return [
        f"cameras {', '.join(names)}: expected them upright above the floor of the wand, found "
        "them upside down: right if they are mounted so; if not, y of the wand's markers is "
        "counted from the bottom and all places are mirrored: correct `wand.program`, or subtract "
        "y_px from the picture's height minus 1"
    ]


def _late(found: Found, late: NDArray, sigma: NDArray, along_px: NDArray) -> list[str]:
    """Return a warning for each camera that films at another time, from `timing.delays`."""
    large = (np.abs(late) > LATE) | (np.abs(along_px) > LATE_PX * found.adjusted.sigma_px)
    large &= np.abs(late) > LATE_SIGMAS * sigma
    return [
        f"camera {camera.name}: films {abs(late[c]):.2f} frames or more "
        f"{'late' if late[c] > 0 else 'early'} by the movement of the markers; synchronise the "
        "videos, or give the times of the frames (`time_s`)"
        for c, camera in enumerate(found.cameras)
        if large[c]
    ]


def _often_wrong(percent: Mapping[str, float]) -> list[str]:
    """Return a warning if many markers of a camera are wrong: it spoils those of the others, too.

    `percent` are the shares of wrong markers by camera. Which camera is to blame is not certain.
    """
    many = {name: each for name, each in percent.items() if each > MOST_WRONG}
    if not many:
        return []
    order = sorted(many, key=many.__getitem__, reverse=True)
    each = ", ".join(f"{name} ({many[name]:.0f} %)" for name in order)
    return [
        f"{'cameras' if len(many) > 1 else 'camera'} {each}: many markers are not where the other "
        "cameras see them, and places may be wrong by far more than stated; check that the videos "
        f"are synchronised, first {order[0]}, that no markers are exchanged, and `lenses`"
    ]


def _of_pictures(found: Found, seen: Seen, known: set[str]) -> list[str]:
    """Return warnings about where in the pictures of each camera the markers are."""
    lines = []
    for camera, xy in zip(found.cameras, seen.xy, strict=True):
        low, high = np.nanquantile(xy.reshape(-1, 2), [0.02, 0.98], axis=0)
        if (high < np.array(camera.size) / 2).all():
            lines.append(
                f"camera {camera.name}: its markers lie in the upper left quarter of the picture "
                f"(up to {high[0]:.0f}, {high[1]:.0f} of {camera_fields.times(camera.size)} px): "
                "right if they are px of the video's own size, not of a smaller copy"
            )
        extent = float(np.linalg.norm(high - low) / np.linalg.norm(camera.size))
        if camera.name not in known and extent < LEAST_PATH:
            lines.append(
                f"camera {camera.name}: the wand's path extends over {100 * extent:.0f} % of the "
                "picture's diagonal, too little for its lens; give `lenses`, or fill the picture"
            )
    return lines
