"""The world of cameras that people alone place: its floor under their feet, and its covariance.

The origin lies on the floor below the middle of people's ways, z is up, and x runs along the floor
as the line from the first camera to the second.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.calibration import point_covariance
from courtside.calibration.bundle import selection
from courtside.calibration.people import unit
from courtside.geometry import rotations
from courtside.geometry.camera import Camera
from courtside.geometry.similarity import Sim3
from courtside.records.keypoints import skeleton

ANKLE = 0.055  # ASSUME: of the height: an ankle above the floor while its foot stands (players-dev)
STANDING = 0.1  # the quantile of ankles' heights that is one of feet that stand
TILT_M = 0.5  # ASSUME: feet spread less than this tell less of the floor's tilt than bodies do
ROUNDS = 30  # of new weights
EPSILON_M = 1e-3  # nearer to the floor all weights are alike
TINY_STEP = 1e-6  # of a similarity, to differentiate by


def floor(xyz: NDArray, cameras: Sequence[Camera], on_floor: NDArray | None = None) -> Sim3:
    """Return `world_from_cameras` for joints (T, J, 3) m of all persons, NaN where unknown.

    The lowest places of ankles lie in one plane. Where people stay in one place, it is
    perpendicular to the mean line from ankles to shoulders. Points `on_floor` (P, 3) tell the
    floor's height better, and its tilt where three or more do not lie on one line.
    """
    place = {name: xyz[:, at] for at, name in enumerate(skeleton.JOINTS)}
    upward = rotations.unit(unit.middle(place, "shoulder") - unit.middle(place, "ankle"))
    up = rotations.unit(np.nanmedian(upward, axis=0))
    ankles = np.concatenate([place["left_ankle"], place["right_ankle"]])
    ankles = ankles[np.isfinite(ankles).all(axis=1)]
    middle = np.median(ankles, axis=0)
    centres = [camera.centre_in_world for camera in cameras]
    turn = axes(up, centres[1] - centres[0])
    slopes, offset = _lowest_plane((ankles - middle) @ turn.T)
    normal = np.array([*-slopes, 1.0])
    up = rotations.unit(turn.T @ normal)
    sole = float(offset / np.linalg.norm(normal)) - ANKLE * unit.length(xyz) / unit.OF_HEIGHT
    if on_floor is not None and len(on_floor):
        about = on_floor - on_floor.mean(axis=0)
        _, extent, directions = np.linalg.svd(about, full_matrices=False)
        if len(on_floor) >= 3 and extent[1] > TILT_M:
            up = directions[2] * np.sign(directions[2] @ up)
        sole = float((on_floor.mean(axis=0) - middle) @ up)
    turn = axes(up, centres[1] - centres[0])
    return Sim3(1.0, turn, -turn @ middle - [0, 0, sole])


def axes(up: NDArray, along: NDArray) -> NDArray:
    """Return the rotation (3, 3) to axes with z up and x along a direction."""
    x = rotations.unit(along - (along @ up) * up)
    return np.stack([x, np.cross(up, x), up])


def _lowest_plane(xyz: NDArray) -> tuple[NDArray, float]:
    """Return slopes (2,) and offset of z over x and y: the plane of a low quantile of points.

    Quantile regression (Koenker & Bassett 1978) by weighted least squares; slopes are held to 0.
    """
    design = np.column_stack([xyz[:, :2], np.ones(len(xyz))])
    found = np.array([0.0, 0.0, np.quantile(xyz[:, 2], STANDING)])
    for _ in range(ROUNDS):
        off = xyz[:, 2] - design @ found
        weight = np.where(off > 0, STANDING, 1 - STANDING) / np.maximum(np.abs(off), EPSILON_M)
        held = np.diag([1.0, 1.0, 0.0]) * weight.sum() * TILT_M**2
        found = np.linalg.solve(design.T * weight @ design + held, design.T @ (weight * xyz[:, 2]))
    return found[:2], float(found[2])


def of_shape(
    cameras: Sequence[Camera],
    covariance: NDArray,
    xyz: NDArray,
    scale_sigma: float | None,
) -> NDArray:
    """Return the covariance (K, K) of cameras in the world that people's joints define.

    `covariance` is that of a network's columns, with little known of place, direction and scale of
    the whole. Errors of these three are taken out: the world moves with joints `xyz` (N, 3) m (an
    S-transformation, Baarda 1973). `scale_sigma`, a share, is then added about their middle; None
    of cameras whose scale the covariance knows, which stays as it is.
    """
    network, middle = selection.of_cameras(cameras), xyz.mean(axis=0)
    moved = [
        _about(middle, 1.0, rotations.rotation_from_rodrigues(e)) for e in TINY_STEP * np.eye(3)
    ]
    moved += [Sim3(1.0, np.eye(3), e) for e in TINY_STEP * np.eye(3)]
    if scale_sigma is not None:
        moved.append(_about(middle, 1 + TINY_STEP, np.eye(3)))
    of_cameras = np.stack([
        selection.of_cameras([one.camera(camera) for camera in cameras]).difference(network)
        for one in moved
    ], axis=1) / TINY_STEP  # fmt: skip
    of_points = np.stack([(one.points(xyz) - xyz).ravel() for one in moved], axis=1) / TINY_STEP
    by_column = point_covariance.sensitivity(network, xyz).reshape(xyz.size, -1)
    keep = np.eye(len(covariance)) - of_cameras @ (np.linalg.pinv(of_points) @ by_column)
    scale = of_cameras[:, -1:] * (scale_sigma or 0.0)
    return keep @ covariance @ keep.T + scale @ scale.T


def _about(middle: NDArray, scale: float, rotation: NDArray) -> Sim3:
    """Return a similarity that leaves a point where it is."""
    return Sim3(scale, rotation, middle - scale * rotation @ middle)
