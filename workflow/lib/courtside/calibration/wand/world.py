"""The world frame of cameras from a wand: of the floor, of clicked points, or of the cameras."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from courtside.calibration import robust_poses, vertical
from courtside.geometry import rotations, similarity
from courtside.geometry.camera import Camera, project, undistort
from courtside.geometry.similarity import Sim3
from courtside.geometry.triangulation import triangulate_all
from courtside.study.errors import InputError

FLOOR = "the floor's"  # description of a world frame `of_floor`
WIDE = 0.03  # ASSUME: least width of markers on the floor relative to their length
OFF_M = 0.05  # ASSUME: a marker farther from the plane of the others is not on the floor
FEWEST_CLICKS = 4  # in one camera, to determine the world frame
MIRRORED = 4.0  # ASSUME: ratio of the errors of clicks in the world and in its mirror image
FAR_SHARE = 0.02  # ASSUME: of a picture's longer side: larger errors of clicks are faults


def of_floor(xyz: NDArray, above_m: float, cameras: Sequence[Camera]) -> Sim3:
    """Return `world_from_cameras` from markers (F, M, 3) m of a wand that lies on the floor.

    `above_m` is the height of the markers' centres. The origin is below the first marker in the
    first frame, x runs along the wand there, and z is up. Raises `InputError` if the markers do
    not define a plane.
    """
    places = xyz.reshape(-1, 3)
    places = places[np.isfinite(places).all(axis=1)]
    if not np.isfinite(xyz[0]).all():
        raise InputError(
            "wand.floor: expected a first frame in which two cameras see all markers, found some "
            "of them missing; list another frame first"
        )
    if len(places) < 3 or similarity.flatness(places)[1] < WIDE:
        raise InputError(
            "wand.floor: expected two frames or more in which two cameras see the wand on the "
            "floor in different directions, found all markers on one line; list more frames"
        )
    middle = places.mean(axis=0)
    up = np.linalg.svd(places - middle)[2][2]
    off_m = float(np.abs((places - middle) @ up).max())
    if off_m > OFF_M:
        raise InputError(
            f"wand.floor: expected markers in one plane, found one {off_m:.2f} m from it; list "
            "only frames in which the wand lies on the floor"
        )
    centres = np.array([camera.centre_in_world for camera in cameras])
    up = up if np.median((centres - middle) @ up) > 0 else -up
    turn = vertical.axes(up, xyz[0, -1] - xyz[0, 0])
    origin = xyz[0, 0] - ((xyz[0, 0] - middle) @ up + above_m) * up
    return Sim3(1.0, turn, -turn @ origin)


def of_cameras(xyz: NDArray, cameras: Sequence[Camera]) -> Sim3:
    """Return `world_from_cameras` without floor and points, from all markers (F, M, 3) m.

    The origin is the middle of the wand's path, z is up as in the pictures, and x runs from the
    first camera to the second, perpendicular to z.
    """
    turn = vertical.upright(cameras)
    return Sim3(1.0, turn, -np.nanmedian(xyz.reshape(-1, 3) @ turn.T, axis=0))


def of_clicks(cameras: Sequence[Camera], points: NDArray, xy: NDArray) -> Sim3:
    """Return `world_from_cameras` from points (P, 3) m and their clicks (C, P, 2) px.

    Raises `InputError` if too few points are clicked, or only the mirror image of the cameras fits.
    """
    found = _best(cameras, points, xy)
    if found is None:
        raise InputError(
            f"wand: expected {FEWEST_CLICKS} clicked points or more in one camera, not all in "
            "one place, found fewer; click more, or remove `court_points` and set `wand.floor`"
        )
    off, world = found
    other = _best([_flipped(camera) for camera in cameras], points, xy)
    if other is not None and off > MIRRORED * max(1.0, other[0]):
        raise InputError(
            "wand: expected clicked points that fit the cameras from the wand, found points that "
            "fit their mirror image: y of the wand's markers runs in the other direction; correct "
            "`wand.program`"
        )
    limit = FAR_SHARE * max(max(camera.size) for camera in cameras)
    if off > limit:
        raise InputError(
            f"wand: expected clicked points within {limit:.0f} px of their projections by the "
            f"cameras from the wand, found {off:.0f} px; check the order of the cameras, "
            "`length_m`, and the clicks"
        )
    return world


def _best(cameras, points: NDArray, xy: NDArray) -> tuple[float, Sim3] | None:
    """Return the median error of clicks, px, and the world frame with the least error, or None."""
    worlds = _worlds(cameras, points, xy)
    tried = [(_error(world, cameras, points, xy), world) for world in worlds]
    return min(tried, key=lambda one: one[0], default=None)


def _worlds(cameras, points: NDArray, xy: NDArray) -> Iterator[Sim3]:
    """Yield world frames from the clicks of each camera alone, and from triangulated points."""
    for camera, px in zip(cameras, xy, strict=True):
        at = np.isfinite(px).all(axis=1)
        if at.sum() < FEWEST_CLICKS:
            continue
        rays = undistort(camera, px[at])
        for pose in robust_poses.placed(points[at], rays, robust_poses.IDEAL, None)[:1]:
            moved = rotations.composed(rotations.invert(pose), camera.cam_from_world)
            yield Sim3(1.0, moved[:, :3], moved[:, 3])
    placed = triangulate_all(cameras, xy)
    seen = np.isfinite(placed).all(axis=1)
    if not any(similarity.is_collinear(xyz[seen]) for xyz in (placed, points)):
        yield similarity.rigid(placed[seen], points[seen])


def _error(world: Sim3, cameras, points: NDArray, xy: NDArray) -> float:
    """Return the median error of clicks, px; inf if most points are behind the cameras."""
    off = np.stack([project(world.camera(camera), points) for camera in cameras]) - xy
    off_px = np.linalg.norm(off, axis=-1)[np.isfinite(xy[..., 0])]
    return float(np.median(np.nan_to_num(off_px, nan=np.inf)))


def _flipped(camera: Camera) -> Camera:
    """Return the mirror image of a camera, whose picture is upside down."""
    turn = np.diag([1.0, -1.0, 1.0])
    matrix = camera.K.copy()
    matrix[1, 2] = camera.size[1] - 1 - matrix[1, 2]
    pose = np.column_stack([
        turn @ camera.cam_from_world[:, :3] @ turn, turn @ camera.cam_from_world[:, 3]
    ])  # fmt: skip
    dist = camera.dist * [1, 1, -1, 1, 1]
    return replace(camera, K=matrix, dist=dist, cam_from_world=pose)
