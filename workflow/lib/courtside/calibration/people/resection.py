"""A camera whose views agree with no other, found again by joints that the others place."""

from collections.abc import Sequence
from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.calibration.people.views import Limits, Seen, placed
from courtside.calibration.records.covariance import PARAMETERS, CameraCovariance
from courtside.geometry import rotations
from courtside.geometry.camera import Camera, in_picture, project

# ASSUME: a share of a camera's views that agree with the others, below which its pose is wrong:
# poses off by 0.3 degrees and 3 cm leave a half or more.
LOST = 0.2
FEWEST = 60  # joints seen, from some five rows
MOST = 400  # more points say no more about a pose that is then adjusted
WIDENED = 2.0  # times the limit of views: the other cameras, too, may be a little wrong
AGREE = 0.5  # ASSUME: of the joints of the right person, with a wrong lens, too
# ASSUME: largest residual over the movement of a joint in the picture, both medians: some pose fits
# a spectator who sits as well as a player who stands.
STILL = 0.5
ITERATIONS = 300
# ASSUME: standard deviations of a camera found again: its lens, too, may be that of another zoom.
WIDE = {"rotation": np.radians(5), "place": 1.0, "focal": 0.1}


def lost(cameras: Sequence[Camera], seen: Seen, limits: Limits) -> list[int]:
    """Return the cameras of whose views next to none agree with those of the others.

    Views of joints that no other camera sees are not counted, because they cannot agree: they may
    show spectators. A camera with few other views counts as lost. So does one that agrees with none
    of the people whom two others place in its picture: with one other alone, it may place a person
    although its pose is wrong.
    """
    found, tracks = placed(cameras, seen, limits), seen.tracks()
    usable = np.nan_to_num(seen.flat()[1]) >= limits.score
    shared = usable & (usable.sum(axis=0) >= 2)
    share = found.accepted.sum(axis=1) / np.maximum(shared.sum(axis=1), 1)
    n_views = found.accepted.sum(axis=0)
    for at, camera in enumerate(cameras):
        sure = n_views - found.accepted[at] >= 2
        inside = sure & in_picture(camera, project(camera, found.xyz))
        of = [inside & (tracks == track) for track in np.unique(seen.track)]
        shares = [found.accepted[at, joints].mean() for joints in of if joints.sum() >= FEWEST]
        share[at] = min(share[at], max(shares, default=1.0))
    return [int(at) for at in np.flatnonzero(share < LOST)]


def expected(camera: Camera, xyz: NDArray) -> bool:
    """Say whether a camera should see people whose joints (..., 3) m the other cameras place."""
    known = np.isfinite(xyz).all(axis=-1)
    inside = in_picture(camera, project(camera, xyz[known])).sum()
    return bool(inside >= max(FEWEST, LOST * known.sum()))


def find(
    camera: Camera, xyz: NDArray, tracklets: NDArray, limits: Limits
) -> tuple[Camera, int] | None:
    """Find a camera's pose by persons whom other cameras place; None where no tracklet fits.

    `xyz` (K, T, J, 3) m are joints of persons, `tracklets` (P, T, J, 2) px those that the camera
    sees at the same times; NaN where missing. Each tracklet is tried as each person. Return the
    camera for the pair with most agreeing joints, and how many agree. The tracklet must move as the
    person does: residuals are at most `STILL` of its movement.
    """
    best: tuple[Camera, int] | None = None
    for row in tracklets:
        extent_px = np.nanmax(row, axis=1, initial=-np.inf) - np.nanmin(row, axis=1, initial=np.inf)
        extent_px = extent_px[np.isfinite(extent_px).all(axis=1)]
        if not len(extent_px):
            continue
        limit_px = WIDENED * limits.limit * float(np.median(extent_px.max(axis=1)))
        for person in xyz:
            known = np.isfinite(person).all(axis=-1) & np.isfinite(row).all(axis=-1)
            if known.sum() < FEWEST:
                continue
            found = _pose(camera, person[known], row[known], limit_px)
            if not found or found[1] < AGREE * known.sum() or (best and found[1] <= best[1]):
                continue
            if _follows(found[0], person, row):
                best = found
    return best


def _pose(camera: Camera, xyz: NDArray, xy: NDArray, limit_px: float) -> tuple[Camera, int] | None:
    """Return the camera by most of the joints (N, 3) m and (N, 2) px, and how many agree."""
    some = np.linspace(0, len(xyz) - 1, min(len(xyz), MOST)).round().astype(int)
    done, turn, shift, _ = cv2.solvePnPRansac(
        xyz[some],
        xy[some],
        camera.K,
        camera.dist,
        iterationsCount=ITERATIONS,
        reprojectionError=limit_px,
        flags=cv2.SOLVEPNP_EPNP,
    )
    if not done:
        return None
    pose = np.column_stack([rotations.rotation_from_rodrigues(turn.ravel()), shift.ravel()])
    found = replace(camera, cam_from_world=pose)
    off_px = np.linalg.norm(project(found, xyz) - xy, axis=1)
    return found, int((off_px <= limit_px).sum())


def _follows(camera: Camera, xyz: NDArray, xy: NDArray) -> bool:
    """Say whether joints (T, J, 2) px move in the picture as those of a person (T, J, 3) m do."""
    known = np.isfinite(xyz).all(axis=-1) & np.isfinite(xy).all(axis=-1)
    seen = np.ma.masked_where(np.broadcast_to(~known[..., None], xy.shape), xy)
    moved_px = np.linalg.norm((seen - np.ma.median(seen, axis=0)).filled(np.nan), axis=-1)
    off_px = np.linalg.norm(project(camera, xyz) - xy, axis=-1)
    return bool(np.nanmedian(off_px[known]) <= STILL * np.nanmedian(moved_px[known]))


def widened(
    known: CameraCovariance, cameras: Sequence[Camera], which: Sequence[int]
) -> CameraCovariance:
    """Return what is known of cameras, with next to nothing of the poses of `which`."""
    size, covariance = len(PARAMETERS), known.of([c.name for c in cameras]).covariance.copy()
    for at in which:
        own = slice(size * at, size * (at + 1))
        variance = np.diag(covariance)[own].copy()
        variance[:3], variance[3:6] = WIDE["rotation"] ** 2, WIDE["place"] ** 2
        variance[PARAMETERS.index("f_px")] = (WIDE["focal"] * cameras[at].K[1, 1]) ** 2
        covariance[own], covariance[:, own] = 0.0, 0.0
        covariance[own, own] = np.diag(variance)
    return CameraCovariance([c.name for c in cameras], covariance)


def line(before: Camera, after: Camera) -> str:
    """Return what is wrong with a camera that was found again."""
    turn = after.cam_from_world[:, :3] @ before.cam_from_world[:, :3].T
    moved_m = np.linalg.norm(after.centre_in_world - before.centre_in_world)
    return (
        f"camera {before.name}: expected people in its pictures where the others see them, found "
        f"next to none; by them it stands {100 * moved_m:.0f} cm away, turned by "
        f"{np.degrees(rotations.angles(turn)):.1f} degrees: check its calibration, and theirs"
    )
