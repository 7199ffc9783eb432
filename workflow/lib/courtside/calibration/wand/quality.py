"""How well a wand fits, for a JSON file, and what to warn of."""

from typing import Any

import numpy as np

from courtside.calibration import point_covariance
from courtside.calibration.bundle.problem import IMAGE, LENS, POSE
from courtside.calibration.wand import timing
from courtside.calibration.wand.adjustment import WRONG
from courtside.calibration.wand.calibration import Found
from courtside.calibration.wand.points import Seen, Wand

OUT_OF_STEP = 2.0  # ASSUME: excess scatter of blocks of time that is told
LATE, LATE_SIGMAS = 0.03, 5.0  # ASSUME: frames, and their sigmas: a camera so late is told
LEAST_WAY = 0.3  # ASSUME: of a picture's diagonal: a lens that is not known needs as much
LONGER_SIGMAS = 4.0  # ASSUME: a wand that clicked points say is so much longer is told


def summary(found: Found, wand: Wand, seen: Seen, known: set[str]) -> dict[str, Any]:
    """Return how well the markers fit; `known` are the cameras whose lens was given.

    By camera: frames, `rms_px` per axis of the markers that are not wrong, their share
    (`wrong_percent`), standard deviations of the place (mm) and of a lens that was found, and by
    how many frames it films late (`late_frames`). `length_mm`: how much longer the wand is than
    stated where two cameras or more place its ends, mean and standard deviation.
    """
    off = found.error_px
    fine = np.abs(off).max(axis=-1) < WRONG * found.adjusted.sigma_px
    late, late_sigma = timing.late(found.cameras, seen, found.xyz)
    report: dict[str, Any] = {"warnings": [], "world": found.world}
    report |= {"sigma_px": found.adjusted.sigma_px, "covariance_factor": found.adjusted.factor}
    report["length_mm"] = _length_mm(found, wand)
    first = IMAGE * len(found.cameras)
    for c, camera in enumerate(found.cameras):
        pose, lens = IMAGE * c + np.arange(len(POSE)), first + len(LENS) * c
        both = np.isfinite(off[c, ..., 0])
        sigma = np.sqrt(np.diag(found.covariance)[lens : lens + len(LENS)])
        one = {
            "n_frames": int(np.isfinite(seen.xy[c, ..., 0]).any(axis=1).sum()),
            "rms_px": float(np.sqrt(np.mean(off[c][fine[c]] ** 2))),
            "wrong_percent": 100 * float((both & ~fine[c]).sum() / max(int(both.sum()), 1)),
            "place_sigma_mm": 1000
            * point_covariance.centre_sigma(camera, found.covariance[np.ix_(pose, pose)]),
            "late_frames": float(late[c]),
        }
        if camera.name not in known:
            one |= {"f_px": float(camera.K[1, 1]), "f_sigma_px": float(sigma[0])}
            one |= {"k1": float(camera.dist[0]), "k1_sigma": float(sigma[LENS.index("k1")])}
        for key, value in one.items():
            report.setdefault(key, {})[camera.name] = value
    report["warnings"] = _warnings(found, wand, seen, known, late, late_sigma)
    return report


def _length_mm(found: Found, wand: Wand) -> dict[str, float | int]:
    apart = np.linalg.norm(found.xyz[:, -1] - found.xyz[:, 0], axis=1)
    off = 1000 * (apart[np.isfinite(apart)] - wand.length_m)
    middle = float(np.median(off)) if len(off) else np.nan
    spread = 1.4826 * float(np.median(np.abs(off - middle))) if len(off) else np.nan
    return {"mean": middle, "standard_deviation": spread, "n": len(off)}


def _warnings(found: Found, wand: Wand, seen: Seen, known: set[str], late, sigma) -> list[str]:
    told = []
    if not found.stated:
        told.append(
            "wand: the origin is the middle of the wand's ways, z up as the pictures are, x from "
            f"camera {found.cameras[0].name} to {found.cameras[1].name}; name frames in which the "
            "wand lies on the floor as `floor`, or click court points"
        )
    for camera, frames, spread in zip(found.cameras, late, sigma, strict=True):
        if abs(frames) > LATE and abs(frames) > LATE_SIGMAS * spread:
            told.append(
                f"camera {camera.name}: films {abs(frames):.1f} frames or more "
                f"{'late' if frames > 0 else 'early'}, as the markers' ways say; synchronise the "
                "videos, or state times of the frames"
            )
    for camera, xy in zip(found.cameras, seen.xy, strict=True):
        low, high = np.nanquantile(xy.reshape(-1, 2), [0.02, 0.98], axis=0)
        way = float(np.linalg.norm(high - low) / np.linalg.norm(camera.size))
        if camera.name not in known and way < LEAST_WAY:
            told.append(
                f"camera {camera.name}: the wand's ways fill {100 * way:.0f} % of its picture, "
                "which hardly tells its lens; give `lenses`, or move the wand through all of it"
            )
    if found.adjusted.factor > OUT_OF_STEP:
        told.append(
            f"wand: parts of the time scatter {found.adjusted.factor:.1f} times as much as their "
            "markers: cameras do not film at one time, or a tracker holds another spot"
        )
    longer = found.adjusted.state.length
    if abs(longer) > LONGER_SIGMAS * wand.sigma_m / wand.length_m:
        told.append(
            f"wand: clicked points say that it is {1000 * wand.length_m * np.exp(longer):.1f} mm "
            f"long, not {1000 * wand.length_m:.1f}; measure it between the markers' centres"
        )
    return told
