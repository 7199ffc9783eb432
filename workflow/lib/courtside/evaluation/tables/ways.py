"""Comparison of calibrations: predicted and true errors, and the share of accepted views."""

from collections.abc import Sequence

import numpy as np

from courtside.calibration.court import quality
from courtside.calibration.court.court import Court
from courtside.evaluation.calibration import over_volume
from courtside.geometry import camera as camera_models
from courtside.geometry.camera import Camera
from courtside.geometry.similarity import umeyama
from courtside.geometry.triangulation import triangulate_all
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.keypoints import Keypoints3D

COLUMNS = (
    "session", "calibration", "base", "taken", "expected_before_cm", "expected_cm",
    "volume_rms_cm", "shape_cm", "accepted_percent", "n_views",
)  # fmt: skip


def from_quality(quality_json: dict) -> dict:
    """Return the columns from a quality file: refined cameras in use, predicted errors (cm)."""
    keys = {"taken": "taken", "expected_before_cm": "expected_before_cm"}
    keys["expected_cm"] = "expected_volume_rms_cm"
    return {name: quality_json.get(key) for name, key in keys.items()}


def against_truth(cameras: Sequence[Camera], truth: Sequence[Camera], court: Court) -> dict:
    """Return the error over the court's volume, before and after the best similarity (cm).

    Nothing where cameras of the truth are missing. Root mean squares of points that all see.
    """
    own = {camera.name: camera for camera in cameras}
    if any(true.name not in own for true in truth):
        return {}
    grid = quality.volume(court)
    seen = np.stack([camera_models.project(true, grid) for true in truth])
    xyz = triangulate_all([own[true.name] for true in truth], seen)
    remaining = {"volume_rms_cm": xyz - grid, "shape_cm": umeyama(xyz, grid).points(xyz) - grid}
    return {name: over_volume(off)["volume_rms_cm"] for name, off in remaining.items()}


def accepted(takes: Sequence[Keypoints3D]) -> dict:
    """Return the share (%) of views of limb joints that triangulation used, and their number.

    Of joints that were placed: how many views a rejected joint has is not known.
    """
    used = [_views(found) for found in takes]
    every = np.concatenate(used) if used else np.zeros(0)
    share = 100 * float(every.mean()) if len(every) else None
    return {"accepted_percent": share, "n_views": len(every)}


def _views(found: Keypoints3D) -> np.ndarray:
    names = [str(name) for name in found.joints]
    at = [names.index(joint) for joint in skeleton.JOINTS if joint in names]
    shown = np.isfinite(found.reproj_error_px[:, :, at])
    return found.accepted[:, :, at][shown]
