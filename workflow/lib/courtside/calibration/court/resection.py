"""Calibrate one camera from points at known places: linear (DLT), and by least squares."""

from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from courtside.calibration.bundle.problem import POSE
from courtside.calibration.court import line_edges, one_camera
from courtside.geometry import similarity
from courtside.geometry.camera import Camera, project
from courtside.statistics.normal_errors import MEDIAN_2D
from courtside.study.errors import InputError

LENS = ("f_px", "k1")
# Points. DLT has 11 unknowns, and a point gives two equations; a pose has 6 unknowns, with focal
# length and k1 8. ASSUME: 4 (pose) and 8 (lens) points leave enough equations to notice wrong
# clicks.
FEWEST = {"dlt": 6, "lens": 8, "pose": 4}
OUTLIER = 4.0  # sigmas; a good click is farther off in 0.03 % of cases
CAUCHY = 3.0  # ASSUME: scale of the Cauchy loss, in sigmas
# ASSUME: a DLT that magnifies click errors more often than this within the volume is degenerate.
MAX_MAGNIFICATION = 30.0
# ASSUME: of the picture's longer side: clicks that most miss by more are of other points. In
# virtual halls clicks of three times the usual scatter missed by 0.005 at most.
MAX_MISFIT = 0.01
# ASSUME: of the points' extent: a camera farther off sees no perspective. Clicks of mirrored or
# wrong points have the best fit at infinity.
FARTHEST = 100.0
MIN_EXTENT = 1e-9  # relative singular value below which rounding errors leave nothing determined


@dataclass(frozen=True, eq=False)
class Linear:
    """A camera found by DLT."""

    # (3, 4): from homogeneous world points (m) to homogeneous pixels, all eleven numbers free;
    # positive before the camera. For `triangulation.triangulate` with pixels in place of normalised
    # points.
    matrix: NDArray
    camera: Camera | None  # without the matrix's skew; None where it holds no camera
    rms_px: float  # per axis, of the points it was found from
    # How many times larger than a click's error a projected point's error is, at worst, in the box
    # around the points up to half its short side (the playing volume); inf for points in one plane.
    magnification: float
    reason: str  # one sentence if the points do not determine the camera, else empty


@dataclass(frozen=True, eq=False)
class Fitted:
    """A camera found by least squares."""

    camera: Camera
    # (n, n): of `parameters`. A step r, t of the pose takes x_in_cam to exp(r) x_in_cam + t.
    covariance: NDArray
    parameters: tuple[str, ...]  # `problem.POSE`, then f_px and k1 where the lens was unknown
    accepted: NDArray  # (P,) bool: clicks used: present, within four sigmas of the others' fit
    error_px: NDArray  # (P,): of each click, accepted or not, to its projected point
    rms_px: float  # per axis, of the accepted clicks


def dlt(
    xyz: ArrayLike, xy: ArrayLike, *, size: tuple[int, int] = (1, 1), name: str = "camera"
) -> Linear:
    """Calibrate a camera linearly from known points: a projection matrix of eleven free numbers.

    Hartley & Zisserman 2004, alg. 7.1 without its last step; normalised by their sec. 4.4. No lens
    distortion. `reason` comes from the covariance of the linear solution. It detects points in one
    plane. It also detects a camera in the plane of the net, which the residuals do not show: the
    only points above the floor, the tips of the posts, are then behind one another. Raises
    `InputError` if fewer than six points are clicked.

    Known places `xyz` (P, 3) are m, clicks `xy` (P, 2) px, NaN where missing. The picture's size is
    for `camera` only.
    """
    xyz, xy, _ = _clicked(xyz, xy, FEWEST["dlt"], name)
    from_xyz, from_xy = _normaliser(xyz), _normaliser(xy)
    left, right = _homogeneous(xyz) @ from_xyz.T, _homogeneous(xy) @ from_xy.T
    nothing = np.zeros_like(left)
    rows = np.block([[left, nothing, -right[:, :1] * left], [nothing, left, -right[:, 1:2] * left]])
    _, extent, vectors = np.linalg.svd(rows, full_matrices=True)
    normalised = vectors[-1].reshape(3, 4)
    magnification = _magnification(xyz, from_xyz, normalised, extent, vectors)
    matrix = np.linalg.inv(from_xy) @ normalised @ from_xyz
    matrix /= np.linalg.norm(matrix[2, :3])
    homogeneous = _homogeneous(xyz) @ matrix.T
    if np.median(homogeneous[:, 2]) < 0:
        matrix, homogeneous = -matrix, -homogeneous
    with np.errstate(divide="ignore", invalid="ignore"):  # in one plane the depth may be 0
        off = homogeneous[:, :2] / homogeneous[:, 2:] - xy
    return Linear(
        matrix=matrix,
        camera=_decompose(matrix, size, name),
        rms_px=float(np.sqrt(np.mean(off**2))),
        magnification=magnification,
        reason=_why(xyz, magnification, name),
    )


def _why(xyz: NDArray, magnification: float, name: str) -> str:
    if magnification < MAX_MAGNIFICATION:
        return ""
    if similarity.flatness(xyz)[2] < 1e-3:
        return (
            f"camera {name}: the points lie in one plane, which leaves a linear calibration "
            "undetermined; click points above the floor too, or calibrate by least squares"
        )
    return (
        f"camera {name}: a linear calibration magnifies click errors {magnification:.0f} times: "
        "the points above the floor are in line with the camera (as the net posts are for a "
        "camera in the net's plane); move the camera, or calibrate by least squares"
    )


def _clicked(xyz, xy, fewest, name) -> tuple[NDArray, NDArray, NDArray]:
    """Return the clicked points, their clicks and indices; raise `InputError` if too few."""
    xyz, xy = np.asarray(xyz, float), np.asarray(xy, float)
    if xyz.shape != (len(xy), 3) or xy.shape != (len(xy), 2):
        raise ValueError(f"expected xyz (P, 3) and xy (P, 2), found {xyz.shape} and {xy.shape}")
    seen = np.isfinite(xy).all(axis=1) & np.isfinite(xyz).all(axis=1)
    if seen.sum() < fewest or similarity.is_collinear(xyz[seen]):
        raise InputError(
            f"camera {name}: expected {fewest} clicked points or more that are not on one line, "
            f"found {seen.sum()}{' on one line' if seen.sum() >= fewest else ''}; click more "
            "points of the court"
        )
    return xyz[seen], xy[seen], seen


def _normaliser(points: NDArray) -> NDArray:
    """Return the matrix that brings points (P, D) to mean 0 and mean distance sqrt(D)."""
    middle, dimension = points.mean(axis=0), points.shape[1]
    scale = np.sqrt(dimension) / np.linalg.norm(points - middle, axis=1).mean()
    matrix = np.diag([scale] * dimension + [1.0])
    matrix[:-1, -1] = -scale * middle
    return matrix


def _homogeneous(points: NDArray) -> NDArray:
    return np.concatenate([points, np.ones((len(points), 1))], axis=1)


def _magnification(xyz, from_xyz, normalised, extent, vectors) -> float:
    """Return the largest error in the volume per unit of click error, to first order."""
    depth = np.abs(_homogeneous(xyz) @ from_xyz.T @ normalised[2])
    low, high = xyz.min(axis=0), xyz.max(axis=0)
    high[2] = max(high[2], low[2] + np.sort(high - low)[1] / 2)
    corners = np.stack(np.meshgrid(*zip(low, high, strict=True)), axis=-1).reshape(-1, 3)
    corners = _homogeneous(corners) @ from_xyz.T
    seen = corners @ normalised.T
    if extent[-2] < MIN_EXTENT * extent[0] or (np.abs(seen[:, 2]) < MIN_EXTENT * depth.max()).any():
        return np.inf
    # A click's error e moves its row by e times the depth.
    root = vectors[:-1].T * (np.sqrt(np.mean(depth**2)) / extent[:-1])
    ratio, zero = seen[:, :2] / seen[:, 2:], np.zeros_like(corners)
    by_x = np.concatenate([corners, zero, -ratio[:, :1] * corners], axis=1) @ root
    by_y = np.concatenate([zero, corners, -ratio[:, 1:] * corners], axis=1) @ root
    sigma = np.sqrt((by_x**2 + by_y**2).sum(axis=1) / 2) / np.abs(seen[:, 2])
    return float(sigma.max())


def _decompose(matrix: NDArray, size: tuple[int, int], name: str) -> Camera | None:
    """Return the `Camera` of a projection matrix without its skew, None if there is none."""
    upper, rotation = scipy.linalg.rq(matrix[:, :3])
    signs = np.diag(np.sign(np.diag(upper)))
    upper, rotation = upper @ signs, signs @ rotation
    if not np.isfinite(upper).all() or np.linalg.det(rotation) < 0 or np.diag(upper).min() <= 0:
        return None
    shift = scipy.linalg.solve_triangular(upper, matrix[:, 3])
    upper = upper / upper[2, 2]
    upper[0, 1] = 0.0
    pose = np.column_stack([rotation, shift])
    return Camera(name, size, upper, np.zeros(5), pose)


def nonlinear(
    xyz: ArrayLike,
    xy: ArrayLike,
    size: tuple[int, int],
    *,
    K: ArrayLike | None = None,
    dist: ArrayLike | None = None,
    sigma_px: float = 1.0,
    xyz_sigma: ArrayLike | None = None,
    edges: ArrayLike | None = None,
    name: str = "camera",
) -> Fitted:
    """Calibrate a camera by robust least squares of the pixel errors, without a start value.

    Start: the pose by SQPnP (Terzakis & Lourakis 2020) for each of several focal lengths; the one
    with the least median error is kept. Then Levenberg-Marquardt with a Cauchy loss, and again
    without it on the accepted clicks. The covariance is that of this last fit, for errors of
    `sigma_px` and `xyz_sigma`. Raises `InputError` if the points are too few (8, or 4 with K), on
    one line, leave the camera undetermined, or fit no camera near them.

    Parameters
    ----------
    xyz : (P, 3) float; known places, m
    xy : (P, 2) float; clicks, px; NaN where missing
    size : of the picture, px
    K : (3, 3) float; from a lens calibration: only the pose is estimated. Without K also the focal
        length, equal along both axes, and k1, with the principal point at the picture's centre
    dist : (5,) float; only with K; zeros by default
    sigma_px : of a good click per axis
    xyz_sigma : (P,) float; how far the points are from `xyz`, standard deviation per axis, m
    edges : (P,) bool; points at which painted edges along x and y cross: the accepted clicks are
        then fitted again, less certain along edges that cross flat in the picture; by default none
    """
    if K is None and dist is not None:
        raise ValueError("expected dist only together with K")
    parameters = POSE + LENS if K is None else POSE
    xyz_seen, xy_seen, seen = _clicked(xyz, xy, FEWEST["lens" if K is None else "pose"], name)
    spread = None if xyz_sigma is None else np.broadcast_to(xyz_sigma, len(seen))[seen]
    clicks = one_camera.Clicks(xyz_seen, xy_seen, float(sigma_px), spread, K is None)
    dist = np.zeros(5) if dist is None else np.asarray(dist, float)
    state = one_camera.start(clicks, size, K, dist)
    if state is None:
        raise InputError(
            f"camera {name}: expected clicks that fit a camera, found none; {_advice(size)}"
        )
    state, agree, by_step = _fit(state, clicks, size, name)
    if edges is not None and np.any(edges):
        camera = Camera(name, size, state.K, state.dist, state.cam_from_world)
        shape = line_edges.click_covariances(camera, xyz_seen, np.asarray(edges)[seen])
        shaped = replace(clicks, shape=shape).of(agree)
        state, _, by_step = one_camera.descend(state, shaped, np.inf)
    accepted = np.zeros(len(seen), dtype=bool)
    accepted[np.flatnonzero(seen)[agree]] = True
    camera = Camera(name, size, state.K, state.dist, state.cam_from_world)
    error_px = np.linalg.norm(project(camera, xyz) - xy, axis=1)
    _check_near(clicks.xyz, camera)
    covariance = _covariance(by_step.reshape(-1, by_step.shape[2]), name)
    rms_px = float(np.sqrt(np.mean(error_px[accepted] ** 2) / 2))
    return Fitted(camera, covariance, parameters, accepted, error_px, rms_px)


def _fit(
    state: one_camera.State, clicks: one_camera.Clicks, size: tuple[int, int], name: str
) -> tuple[one_camera.State, NDArray, NDArray]:
    """Return the fitted state, the clicks (P,) bool that agree, and derivatives in sigmas."""
    state, off, by_step = one_camera.descend(state, clicks, CAUCHY)
    shown = np.sqrt(1 - by_step.shape[2] / off.size)  # share of errors that residuals show
    agree = _agree(np.linalg.norm(off, axis=1), shown)
    off_px = np.median(np.linalg.norm(one_camera.residuals(state, clicks)[0], axis=1)) / shown
    _check_agreement(clicks, agree, off_px, size, name)
    state, _, by_step = one_camera.descend(state, clicks.of(agree), np.inf)
    return state, agree, by_step


def _agree(distance: NDArray, shown: float) -> NDArray:
    """Return which clicks (P,) bool agree with the fit of all, by residuals (P,) in sigmas.

    If the clicks scatter more than their sigma, their scatter is used. Residuals are smaller than
    errors because the unknowns absorb a part: a third if eight clicks give pose and lens.
    """
    return distance <= OUTLIER * max(1.0, np.median(distance) / MEDIAN_2D / shown)


def _check_agreement(clicks, agree, off_px, size, name) -> None:
    """Raise `InputError` if too few clicks agree, or most are far off.

    With the fewest clicks that are allowed, one may be wrong if the others are enough to detect it.
    """
    fewest = FEWEST["lens" if clicks.free_lens else "pose"]
    least = max(min(fewest, len(agree) - 1), 4)  # three clicks fit any pose
    few = agree.sum() < least or similarity.is_collinear(clicks.xyz[agree])
    if few or off_px > MAX_MISFIT * max(size):
        found = f"{agree.sum()} of {len(agree)}" if few else f"half of all {off_px:.1f} px off"
        raise InputError(
            f"camera {name}: expected {least} clicks or more that fit one camera, found {found}; "
            f"{_advice(size)}"
        )


def _advice(size: tuple[int, int]) -> str:
    return (
        "check the names of the points, their places (the court), and that clicks are px of the "
        f"picture's own {size[0]} x {size[1]}"
    )


def _check_near(xyz: NDArray, camera: Camera) -> None:
    """Raise `InputError` if the fit of the clicks ran to infinity."""
    away_m = np.linalg.norm(camera.centre_in_world - xyz.mean(axis=0))
    limit_m = FARTHEST * np.ptp(xyz, axis=0).max()
    if away_m > limit_m:
        raise InputError(
            f"camera {camera.name}: expected clicks that fit a camera near the court, found that "
            f"they fit best from more than {limit_m:.0f} m away; check the names of the points and "
            "their places (the court), or click points above the floor too"
        )


def _covariance(columns: NDArray, name: str) -> NDArray:
    """Return the inverse of the normal matrix, or raise `InputError` where it is singular."""
    scale = np.linalg.norm(columns, axis=0)
    extent, vectors = np.linalg.svd(columns / scale, full_matrices=False)[1:]
    if extent[-1] < MIN_EXTENT * extent[0]:
        raise InputError(
            f"camera {name}: expected points that determine the camera, found that its focal "
            "length and distance cannot be separated; click points above the floor too, or give "
            "its lens calibration"
        )
    root = vectors.T / extent / scale[:, None]
    return root @ root.T
