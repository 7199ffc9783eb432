"""The world frame of cameras from people alone: the floor under their feet, and the covariance.

The origin is on the floor below the middle of the people's paths, z is up, and x runs along the
floor in the direction from the first camera to the second.
"""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.calibration import point_covariance, vertical
from courtside.calibration.bundle import conversion
from courtside.calibration.people import metric_scale
from courtside.geometry import rotations
from courtside.geometry.camera import Camera
from courtside.geometry.similarity import Sim3
from courtside.records.keypoints import skeleton
from courtside.study.errors import InputError

ANKLE = 0.055  # ASSUME: height of the ankle of a standing foot over the person's (players-dev)
STANDING = 0.1  # the quantile of the ankles' heights that belongs to standing feet
TILT_M = 0.5  # ASSUME: extent of feet, or points, that define the tilt as well as bodies do
ROUNDS = 30  # of reweighting
EPSILON_M = 1e-3  # the weight is constant below this distance from the floor
UPRIGHT = np.radians(5.0)  # ASSUME: error of the vertical by bodies alone, standard deviation
POINT_M = 0.01  # ASSUME: that of a clicked point on the floor
ANKLE_M = 0.03  # ASSUME: that of the height of a standing ankle, as a network sees it
# Two halves of the time tell the variance of a mean with few degrees of freedom, two of the tilt
# and one of the height: Student's t over a normal distribution, squared, at 90 %.
OF_TILT = 9 / np.log(10)
OF_HEIGHT = np.tan(0.45 * np.pi) ** 2 / 2.706
TINY_STEP = 1e-6  # of a similarity, for numerical derivatives


def floor(xyz: NDArray, cameras: Sequence[Camera], on_floor: NDArray | None = None) -> Sim3:
    """Return `world_from_cameras` for joints (T, J, 3) m of all persons, NaN where unknown.

    Raises `InputError` if no ankles are known, or no legs or trunk to tell the size of a person by.

    The floor is the plane of the lowest ankles. If people stay in one place, it is perpendicular to
    the mean line from ankles to shoulders. Points `on_floor` (P, 3) replace its height, and its
    tilt if they tell it better: `_tilt_of_points`.
    """
    place = {name: xyz[:, at] for at, name in enumerate(skeleton.JOINTS)}
    ankles = np.concatenate([place["left_ankle"], place["right_ankle"]])
    ankles = ankles[np.isfinite(ankles).all(axis=1)]
    if not len(ankles) or not np.isfinite(metric_scale.length(xyz)):
        raise InputError(
            "people: expected hips, knees, ankles and shoulders that two cameras see in "
            f"{metric_scale.LEAST_FRAMES} frames or more, found fewer; film whole bodies, with "
            "the feet in the picture"
        )
    upward = rotations.unit(
        metric_scale.middle(place, "shoulder") - metric_scale.middle(place, "ankle")
    )
    up = rotations.unit(np.nanmedian(upward, axis=0))
    middle = np.median(ankles, axis=0)
    centres = [camera.centre_in_world for camera in cameras]
    turn = vertical.axes(up, centres[1] - centres[0])
    slopes, offset = _lowest_plane((ankles - middle) @ turn.T)
    normal = np.array([*-slopes, 1.0])
    up = rotations.unit(turn.T @ normal)
    sole = (
        float(offset / np.linalg.norm(normal))
        - ANKLE * metric_scale.length(xyz) / metric_scale.SEEN.mean
    )
    if on_floor is not None and len(on_floor):
        if _tilt_of_points((ankles @ turn.T)[:, :2], (on_floor @ turn.T)[:, :2]) is not None:
            normal = np.linalg.svd(on_floor - on_floor.mean(axis=0), full_matrices=False)[2][2]
            up = normal * np.sign(normal @ up)
        sole = float((on_floor.mean(axis=0) - middle) @ up)
    turn = vertical.axes(up, centres[1] - centres[0])
    return Sim3(1.0, turn, -turn @ middle - [0, 0, sole])


def _tilt_of_points(feet: NDArray, on_floor: NDArray) -> NDArray | None:
    """Return the covariance of the floor's slopes by points (P, 2); None where feet tell more.

    Compared is what both say of the floor's height under the feet (N, 2), as seen from the points,
    which define the height. Three points or more that are not on one line tell slopes.
    """
    middle = on_floor.mean(axis=0)
    about = on_floor - middle
    if len(on_floor) < 3 or np.linalg.svd(about, compute_uv=False)[1] <= TILT_M:
        return None
    by_points = POINT_M**2 * np.linalg.inv(about.T @ about)
    share = _share_of_bodies(feet)
    by_feet = UPRIGHT**2 * (share @ share.T) + ANKLE_M**2 * share / TILT_M**2
    places = (feet - middle).T @ (feet - middle)
    return by_points if np.sum(by_points * places) < np.sum(by_feet * places) else None


def _share_of_bodies(feet: NDArray) -> NDArray:
    """Return how much of an error of the vertical by bodies is in slopes by feet (N, 2), (2, 2)."""
    return TILT_M**2 * np.linalg.inv(np.cov(feet.T) + TILT_M**2 * np.eye(2))


def _lowest_plane(xyz: NDArray) -> tuple[NDArray, float]:
    """Return slopes (2,) and offset of z over x and y, for the plane of a low quantile of points.

    Quantile regression (Koenker & Bassett 1978) by weighted least squares, with a prior of 0 for
    the slopes.
    """
    design = np.column_stack([xyz[:, :2], np.ones(len(xyz))])
    found = np.array([0.0, 0.0, np.quantile(xyz[:, 2], STANDING)])
    for _ in range(ROUNDS):
        off = xyz[:, 2] - design @ found
        weight = np.where(off > 0, STANDING, 1 - STANDING) / np.maximum(np.abs(off), EPSILON_M)
        held = np.diag([1.0, 1.0, 0.0]) * weight.sum() * TILT_M**2
        found = np.linalg.solve(design.T * weight @ design + held, design.T @ (weight * xyz[:, 2]))
    return found[:2], float(found[2])


def halves_apart(
    joints: NDArray, cameras: Sequence[Camera], half: NDArray, on_floor: NDArray
) -> NDArray | None:
    """Return how far apart the floors of two halves of the frames are, in the world frame.

    (3,): the x and y of their normals, and their height (m) in the middle of the joints. None if a
    half, a mask (T,), has too few frames with whole bodies. Other arguments as for `floor`.
    """
    whole = np.isfinite(joints).all(axis=(1, 2))
    if min((whole & half).sum(), (whole & ~half).sum()) < metric_scale.LEAST_FRAMES:
        return None
    one, other = (floor(joints[rows], cameras, on_floor) for rows in (half, ~half))
    middle = np.nanmedian(joints.reshape(-1, 3), axis=0)
    height_m = (one.points(middle) - other.points(middle))[2]
    return np.append((one.rotation[2] - other.rotation[2])[:2], height_m)


def frame_error(joints: NDArray, apart: NDArray | None, on_floor: NDArray) -> NDArray:
    """Return the covariance of the world frame, as `CameraCovariance.frame` has it.

    `joints` (T, J, 3) and `on_floor` (P, 3) are m, in the world frame; `apart` is that of
    `halves_apart`. What bodies tell of the vertical counts as in `floor`: by the extent of the
    feet. The origin is under the people: from points, its height is as uncertain as the tilt, too.
    """
    at = [skeleton.JOINTS.index(f"{side}_ankle") for side in ("left", "right")]
    feet = joints[:, at].reshape(-1, 3)
    feet = feet[np.isfinite(feet).all(axis=1), :2]
    by_bodies = _share_of_bodies(feet)
    slopes, height = UPRIGHT**2 * (by_bodies @ by_bodies.T), ANKLE_M**2
    middle = np.zeros(2)  # where the floor's height is known
    if apart is None:
        slopes = slopes + UPRIGHT**2 * np.eye(2)
    else:
        slopes = slopes + OF_TILT * np.sum(apart[:2] ** 2) / 8 * np.eye(2)
        height = height + OF_HEIGHT * apart[2] ** 2 / 4
    if len(on_floor):
        height, middle = POINT_M**2 / len(on_floor), on_floor[:, :2].mean(axis=0)
        by_points = _tilt_of_points(feet, on_floor[:, :2])
        slopes = slopes if by_points is None else by_points
    # A point at x and y rises by turn_x y - turn_y x + height.
    of_slopes = np.vstack([vertical.TURNED, middle])
    found = of_slopes @ slopes @ of_slopes.T
    found[2, 2] += height
    return found


def of_shape(
    cameras: Sequence[Camera],
    covariance: NDArray,
    xyz: NDArray,
    scale_sigma: float | None,
) -> NDArray:
    """Return the covariance (K, K) of cameras in the world frame that joints define.

    `covariance` is that of a network's columns, with large errors of position, orientation and
    scale of the whole. These errors are removed, because joints `xyz` (N, 3) m define the world
    frame (an S-transformation, Baarda 1973). The error of the scale is then added: `scale_sigma`,
    a share, about the middle of the joints. With None, the scale and its error stay as they are.
    """
    network, middle = conversion.network_of(cameras), xyz.mean(axis=0)
    moved = [
        _about(middle, 1.0, rotations.rotation_from_rodrigues(e)) for e in TINY_STEP * np.eye(3)
    ]
    moved += [Sim3(1.0, np.eye(3), e) for e in TINY_STEP * np.eye(3)]
    if scale_sigma is not None:
        moved.append(_about(middle, 1 + TINY_STEP, np.eye(3)))
    of_cameras = by_similarities(cameras, moved)
    of_points = np.stack([(one.points(xyz) - xyz).ravel() for one in moved], axis=1) / TINY_STEP
    seen = point_covariance.views(cameras, xyz)
    by_column = point_covariance.sensitivity(network, xyz, seen).reshape(xyz.size, -1)
    keep = np.eye(len(covariance)) - of_cameras @ (np.linalg.pinv(of_points) @ by_column)
    scale = of_cameras[:, -1:] * (scale_sigma or 0.0)
    return keep @ covariance @ keep.T + scale @ scale.T


def by_similarities(cameras: Sequence[Camera], moved: Iterable[Sim3]) -> NDArray:
    """Return how a network's columns (K,) follow similarities of `TINY_STEP`, (K, N)."""
    network = conversion.network_of(cameras)
    return np.stack([
        conversion.network_of([one.camera(camera) for camera in cameras]).difference(network)
        for one in moved
    ], axis=1) / TINY_STEP  # fmt: skip


def _about(middle: NDArray, scale: float, rotation: NDArray) -> Sim3:
    """Return a similarity about a point, which does not move."""
    return Sim3(scale, rotation, middle - scale * rotation @ middle)
