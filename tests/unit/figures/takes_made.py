"""A made-up take as footage, for tests of figures that draw on pictures."""

from dataclasses import replace
from pathlib import Path

import numpy as np

import scene
import walker
from courtside.figures.style import stick_figure
from courtside.records.cameras.footage import Footage
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import derived_joints

DERIVED = derived_joints.read(Path(__file__).parents[3] / "config" / "derived_joints.yaml")
STICK = stick_figure.stick(walker.SKELETON, DERIVED)
CAMERAS = scene.ring(3)
LIMBS = walker.SKELETON.groups["limbs"]


def take(n_frames=20, n_persons=1, offset_px=(0.0, 0.0)):
    """Return a Keypoints3D without gaps and its Footage: `c1` has a clock that shows 0.5 s more."""
    record = walker.points(n_frames=n_frames, n_persons=n_persons)
    xyz = np.stack([walker.body(n_frames) + np.array([0, 0.7 * at, 0]) for at in range(n_persons)])
    shape = (*xyz.shape[:3], 3)
    record = replace(
        record,
        xyz=xyz,
        accepted=np.ones(shape, bool),
        reproj_error_px=np.full(shape, float(np.hypot(*offset_px))),
        reason=np.zeros(shape[:3], np.uint8),
    )
    seen = []
    for camera, view in zip(CAMERAS, walker.views(record, CAMERAS, offset_px), strict=True):
        late_s = 0.5 * (camera.name == "c1")
        view = replace(view, time_s=view.time_s + late_s)
        seen.append(Footage(camera, view, Clock(offset_s=late_s), "no file"))
    return record, seen


def pictures(height=1080, width=1920):
    """Return a black picture of each camera."""
    return {camera.name: np.zeros((height, width, 3), np.uint8) for camera in CAMERAS}
