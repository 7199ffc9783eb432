"""All cameras and all places of a board, adjusted together, with covariance.

The unknowns are poses and lenses of the cameras (`bundle.problem`) and the pose of the board in
every picture but one, whose board is the world: z = 0 is its plane. If it does not lie on the
floor, z is turned afterwards to what is up in the pictures. Boards are eliminated, so that the cost
grows with the number of pictures. Residuals have Cauchy weights. The boards' size is the
only length: its error is added to the covariance.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from courtside.calibration import vertical
from courtside.calibration.boards import start
from courtside.calibration.boards.board import Board
from courtside.calibration.boards.corners import Corners
from courtside.calibration.bundle import conversion, elimination, problem, selection
from courtside.calibration.bundle.elimination import Normal
from courtside.calibration.bundle.problem import IMAGE, POSE, Network
from courtside.calibration.records import covariance as camera_covariance
from courtside.calibration.records.covariance import CameraCovariance
from courtside.geometry import camera as cameras
from courtside.geometry import rotations
from courtside.geometry.camera import Camera
from courtside.geometry.similarity import Sim3
from courtside.statistics.normal_errors import MEDIAN_TO_SIGMA
from courtside.study.errors import InputError

# ASSUME: what lenses and sensors usually are, standard deviations: nearly square pixels, a
# principal point within 3 % of the picture's longer side of its centre, little decentering.
SPREAD = {"aspect": 0.01, "k1": 0.5, "k2": 0.5, "p1": 5e-3, "p2": 5e-3}
CENTRE_SHARE = 0.03
ROUNDS = 12  # ASSUME: of new weights; the cost stands still before
STEPS = 8  # of Gauss-Newton within a round
SETTLED = 1e-6  # of the cost
CAUCHY = 2.5  # ASSUME: of the corners' sigma: where a residual has lost half its weight
LEAST_SIGMA_PX = 0.01  # no corner is found better
FAR_PX = 5.0  # ASSUME: a corner so far off is another, or its camera filmed at another time
REST_PX = 1.0  # ASSUME: the median corner moves by less where a board rests; noise is less
LEAST_NEAR = 0.7  # ASSUME: share of the corners, in pictures that two cameras see, that is nearer


@dataclass(frozen=True, eq=False)
class Found:
    """Cameras from boards."""

    cameras: list[Camera]
    covariance: CameraCovariance
    world: str  # the picture whose board is at the origin
    stated: bool  # whether this board lies on the floor; else z is up as in the pictures
    sigma_px: float  # of a corner, along each axis, by the bulk of the residuals
    factor: float  # by which the scatter of whole pictures widens the covariance
    error_px: NDArray  # (M, 2): of each corner; NaN of pictures that tell no pose
    # (C,), in steps from picture to picture: by how much each camera films later than the others,
    # and the standard deviation of that; NaN if pictures are in no order
    late: NDArray
    late_sigma: NDArray


@dataclass(frozen=True, eq=False)
class _State:
    network: Network
    boards: NDArray  # (P, 3, 4)


@dataclass(frozen=True, eq=False)
class _Problem:
    """Corners in the form of the adjustment, without those of pictures that tell no pose."""

    places: NDArray  # (M, 3): of the corners on the board
    picture: NDArray  # (M,) int
    world: int
    active: NDArray  # columns of the cameras that are unknown, bool


def calibrate(
    board: Board,
    seen: Corners,
    sizes: Mapping[str, tuple[int, int]],
    *,
    lenses: Mapping[str, Camera] | None = None,
    floor: str | None = None,
) -> Found:
    """Calibrate cameras from the corners of a board that they see.

    `sizes` px of each camera's pictures. `lenses`, where they are known, are kept; else they are
    adjusted too. `floor` names the picture whose board is the world, z towards who looks at it;
    else z is up as in the pictures, and x runs from the first camera to the second. Raises
    `InputError` if cameras share no picture, or the corners are not those of such a board.
    """
    plane = start.flat(board, seen)
    fair = _only(seen, plane)
    given = lenses or {
        name: start.lens(name, sizes[name], board, fair, c) for c, name in enumerate(seen.cameras)
    }
    known = [given[name] for name in seen.cameras]
    ideal = np.full(seen.xy.shape, np.nan)
    for c, camera in enumerate(known):
        ideal[seen.camera == c] = cameras.undistort(camera, seen.xy[seen.camera == c])
    fine = np.isfinite(ideal).all(axis=1)
    posed = start.poses(board, _only(seen, fine & plane), ideal[fine & plane], floor)
    usable = fine & np.isfinite(posed.world_from_board[seen.picture, 0, 0])
    state, fixed = _started(board, seen, known, posed, usable, ideal if lenses else None)
    state, sigma_px = _adjusted(state, fixed)
    unknown = fixed.active.sum() + len(POSE) * (len(np.unique(fixed.picture)) - 1)
    count = 2 * int(usable.sum())
    sigma_px *= float(np.sqrt(count / max(1, count - unknown)))
    error_px = np.full(seen.xy.shape, np.nan)
    error_px[usable] = problem.residuals(state.network)
    _check_rigid(seen, error_px)
    covariance, factor = _covariance(state, fixed, sigma_px, _once(seen, fixed))
    covariance += _of_size(board, state.network)
    solved = conversion.cameras_of(state.network, seen.cameras, [c.size for c in known])
    if lenses:
        both = zip(known, solved, strict=True)
        solved = [replace(lens, cam_from_world=one.cam_from_world) for lens, one in both]
    solved, frame = _upright(solved) if floor is None else (solved, None)
    named = camera_covariance.of_network(seen.cameras, covariance, frame)
    late = _delays(state, fixed, sigma_px, seen)
    at = seen.pictures[posed.world], floor is not None
    return Found(solved, named, *at, sigma_px, factor, error_px, *late)


def _upright(solved: Sequence[Camera]) -> tuple[list[Camera], NDArray]:
    """Turn the world about its origin: z up as in the pictures; also return how uncertain that is.

    The covariance of the cameras stays as it is.
    """
    turned = Sim3(1.0, vertical.upright(solved), np.zeros(3))
    upright = [turned.camera(camera) for camera in solved]
    return upright, vertical.error_of_pictures(upright)


def _check_rigid(seen: Corners, error_px: NDArray) -> None:
    """Raise `InputError` if pictures of several cameras do not show one rigid board.

    Each picture fits one of its cameras, whatever the others see.
    """
    usable = np.isfinite(error_px).all(axis=1)
    cameras_of = np.zeros((len(seen.pictures), len(seen.cameras)), dtype=bool)
    cameras_of[seen.picture[usable], seen.camera[usable]] = True
    shared = usable & (cameras_of.sum(axis=1) > 1)[seen.picture]
    near = float((np.abs(error_px[shared]).max(axis=1) < FAR_PX).mean()) if shared.any() else 1.0
    if near < LEAST_NEAR:
        raise InputError(
            f"board: expected corners within {FAR_PX:g} px of one rigid board where two cameras "
            f"see it, found {100 * near:.0f} % of them; check that the videos are synchronised, "
            "and that the board rested while pictures of one name were taken"
        )


def _only(seen: Corners, rows: NDArray) -> Corners:
    parts = {key: getattr(seen, key)[rows] for key in ("camera", "picture", "corner", "xy")}
    return replace(seen, **parts)


def _started(
    board: Board,
    seen: Corners,
    known: Sequence[Camera],
    posed: start.Poses,
    usable: NDArray,
    ideal: NDArray | None,
) -> tuple[_State, _Problem]:
    """Return the first state; with `ideal` directions, of known lenses, those are kept."""
    placed = [
        replace(camera, cam_from_world=pose, dist=np.zeros(5) if ideal is not None else camera.dist)
        for camera, pose in zip(known, posed.cam_from_world, strict=True)
    ]
    network = conversion.network_of(placed)
    xy = seen.xy if ideal is None else _pinhole(known, seen, ideal)
    rows = np.flatnonzero(usable)
    network = problem.with_points(
        network, np.zeros((len(rows), 3)), seen.camera[rows], np.arange(len(rows)), xy[rows]
    )
    sizes = [camera.size for camera in known]
    network = selection.with_lens_priors(network, sizes, SPREAD, CENTRE_SHARE)
    active = np.zeros(network.n_columns, dtype=bool)
    for c in range(len(known)):
        active[IMAGE * c : IMAGE * c + len(POSE)] = True
    active[IMAGE * len(known) :] = ideal is None
    fixed = _Problem(board.corners[seen.corner[rows]], seen.picture[rows], posed.world, active)
    return _placed(_State(network, posed.world_from_board), fixed), fixed


def _pinhole(known: Sequence[Camera], seen: Corners, ideal: NDArray) -> NDArray:
    """Return px (M, 2) that cameras without distortion would see."""
    matrices = np.stack([camera.K for camera in known])[seen.camera]
    return ideal * np.stack([matrices[:, 0, 0], matrices[:, 1, 1]], -1) + matrices[:, :2, 2]


def _placed(state: _State, fixed: _Problem) -> _State:
    """Return a state whose points are where its boards are."""
    pose = state.boards[fixed.picture]
    xyz = np.einsum("mij,mj->mi", pose[:, :, :3], fixed.places) + pose[:, :, 3]
    return replace(state, network=replace(state.network, xyz=xyz))


def _adjusted(state: _State, fixed: _Problem) -> tuple[_State, float]:
    """Return the adjusted state and the corners' sigma, px, by the bulk of the residuals."""
    last = np.inf
    sigma_px = _spread(problem.residuals(state.network))
    for _ in range(ROUNDS):
        off = problem.residuals(state.network)
        weight = _weight(off, sigma_px)
        damping = 1e-6
        cost = _cost(state, weight, sigma_px)
        for _ in range(STEPS):
            moved = _moved(state, fixed, weight, sigma_px, damping)
            trial = _cost(moved, weight, sigma_px)
            if trial <= cost:
                fell, state, cost, damping = cost - trial, moved, trial, damping / 10
                if fell <= SETTLED * cost:
                    break
            else:
                damping *= 100
        sigma_px = _spread(problem.residuals(state.network))
        if abs(sigma_px - last) <= 1e-4 * sigma_px:
            break
        last = sigma_px
    return state, sigma_px


def _spread(off: NDArray) -> float:
    """Return the sigma of residuals along an axis by their median."""
    return max(LEAST_SIGMA_PX, MEDIAN_TO_SIGMA * float(np.nanmedian(np.abs(off))))


def _weight(off: NDArray, sigma_px: float) -> NDArray:
    """Return the Cauchy weights (M,) of residuals (M, 2); 0 of points behind their camera."""
    square = (off**2).sum(axis=1) / (CAUCHY * sigma_px) ** 2
    return np.nan_to_num(1 / (1 + square))


def _cost(state: _State, weight: NDArray, sigma_px: float) -> float:
    off = problem.residuals(state.network)[weight > 0]
    if not np.isfinite(off).all():
        return np.inf
    network = state.network
    prior = (network.lens - network.lens_mean) / network.lens_sigma
    return float((weight[weight > 0] * (off**2).sum(axis=1)).sum() / sigma_px**2 + (prior**2).sum())


def _normal(
    state: _State,
    fixed: _Problem,
    weight: NDArray,
    sigma_px: float,
    damping: float,
    by_others: NDArray | None = None,
) -> Normal:
    """Return the normal equations; `by_others` (M, 2, E) are derivatives by further unknowns."""
    network = state.network
    by_others = np.zeros((len(weight), 2, 0)) if by_others is None else by_others
    off, by_camera, by_point = problem.linearised(network)
    arm = network.xyz - state.boards[fixed.picture][:, :, 3]
    by_board = np.concatenate([np.cross(arm[:, None, :], by_point), by_point], axis=2)
    by_board[fixed.picture == fixed.world] = 0.0
    root = np.sqrt(weight) / sigma_px
    rows = elimination.Rows(off, by_camera, by_others, by_board, fixed.picture, root)
    nothing, n_others = np.zeros((len(state.boards), len(POSE))), by_others.shape[2]
    active = np.append(fixed.active, np.ones(n_others, dtype=bool))
    known = (np.zeros(n_others),) * 2, (nothing, nothing)
    return elimination.normal_equations(network, rows, active, *known, damping)


def _moved(
    state: _State, fixed: _Problem, weight: NDArray, sigma_px: float, damping: float
) -> _State:
    """Return the state after a damped step of Gauss and Newton."""
    part, own = _normal(state, fixed, weight, sigma_px, damping).step(damping)
    step = np.zeros(len(fixed.active))
    step[fixed.active] = part
    boards = state.boards.copy()
    boards[:, :, :3] = rotations.rotation_from_rodrigues(own[:, :3]) @ boards[:, :, :3]
    boards[:, :, 3] += own[:, 3:]
    network = state.network.moved(step, np.zeros_like(state.network.xyz))
    return _placed(_State(network, boards), fixed)


def _once(seen: Corners, fixed: _Problem) -> NDArray:
    """Return the world and the first picture of each rest of a board that is filmed, (P,) bool.

    A rest ends with a picture that another camera sees, too. Else return all pictures.
    """
    count = len(seen.pictures)
    once = np.isin(np.arange(count), fixed.picture)
    if seen.step is None:
        return once
    xy = np.full((count, len(seen.cameras), seen.corner.max() + 1, 2), np.nan)
    xy[seen.picture, seen.camera, seen.corner] = seen.xy
    order = [p for p in np.argsort(seen.step, kind="stable").tolist() if once[p]]
    first = order[0]
    for p in order[1:]:
        moved = [one[np.isfinite(one)] for one in np.linalg.norm(xy[p] - xy[first], axis=-1)]
        sees = np.isfinite(xy[p]).any(axis=(1, 2))
        near = [len(one) > 0 and np.median(one) < REST_PX for one in moved]
        if all(near[c] for c in np.flatnonzero(sees)):
            once[p] = p == fixed.world
        else:
            first = p
    return once


def _covariance(
    state: _State, fixed: _Problem, sigma_px: float, once: NDArray
) -> tuple[NDArray, float]:
    """Return the covariance of the network's columns, and the factor of whole pictures.

    Only the pictures `once` (P,) count: most of a corner's error stays while a board rests.

    Corners of one picture err together where cameras do not film at one time or a picture is
    blurred. The scores of whole pictures scatter then more than independent corners say; their
    mean excess over all unknowns widens the covariance (a sandwich estimate with one number). The
    slope of a score is the mean of the squared Cauchy weights, that of the information their mean.
    """
    rows = once[fixed.picture]
    weight = np.where(rows, _weight(problem.residuals(state.network), sigma_px), 0.0)
    normal = _normal(state, fixed, weight, sigma_px, 0.0)
    inverse = np.linalg.inv(normal.information)
    used = len(np.unique(fixed.picture[rows]))
    scatter = normal.scores.T @ normal.scores * used / max(used - 1, 1)
    slope = float((weight**2).sum() / weight.sum())
    factor = max(1.0, float(np.trace(inverse @ scatter)) / (len(inverse) * slope**2))
    whole = np.zeros((len(fixed.active), len(fixed.active)))
    whole[np.ix_(fixed.active, fixed.active)] = factor * inverse
    return whole, factor


def _of_size(board: Board, network: Network) -> NDArray:
    """Return the covariance of the network's columns by the error of the board's size."""
    scaled = np.zeros(network.n_columns)
    for c, pose in enumerate(network.cam_from_world):
        scaled[IMAGE * c + 3 : IMAGE * c + len(POSE)] = pose[:, 3]
    return (board.square_sigma_m / board.square_m) ** 2 * np.outer(scaled, scaled)


def _delays(
    state: _State, fixed: _Problem, sigma_px: float, seen: Corners
) -> tuple[NDArray, NDArray]:
    """Return by how many steps each camera (C,) films later than the others, and the sigma.

    It is a step of the adjustment with this delay as a further unknown, each camera's for itself:
    a board that moves evenly is nearly explained by another pose of the camera. Its sigma is that
    of whole pictures. Pictures without neighbours count as if the board rested.
    """
    n_cameras = len(seen.cameras)
    late, sigma = np.full((2, n_cameras), np.nan)
    if seen.step is None:
        return late, sigma
    per_step = _per_step(state, fixed, seen.step)
    weight = _weight(problem.residuals(state.network), sigma_px)
    own = state.network.image_idx[:, None] == np.arange(n_cameras)
    normal = _normal(state, fixed, weight, sigma_px, 0.0, per_step[:, :, None] * own[:, None])
    first = len(normal.gradient) - n_cameras
    for c in np.flatnonzero(((per_step != 0) & own.T[:, :, None]).any(axis=(1, 2))):
        columns = np.append(np.arange(first), first + c)
        inverse = np.linalg.pinv(normal.information[np.ix_(columns, columns)], hermitian=True)
        late[c] = -(inverse @ normal.gradient[columns])[-1]
        sigma[c] = np.linalg.norm(normal.scores[:, columns] @ inverse[-1])
    return late, sigma


def _per_step(state: _State, fixed: _Problem, step: NDArray) -> NDArray:
    """Return how corners move in their pictures by the board's own path, (M, 2) px per step.

    0 where the picture before or after it tells no board.
    """
    at = {int(number): picture for picture, number in enumerate(step)}
    beside = np.array([[at.get(int(number) + d, -1) for d in (-1, 1)] for number in step])
    moved = [_placed(replace(state, boards=state.boards[both]), fixed).network for both in beside.T]
    per_step = (problem.residuals(moved[1]) - problem.residuals(moved[0])) / 2
    ends = np.flatnonzero(beside.min(axis=1) < 0)
    at_end = np.isin(fixed.picture, ends)[:, None]
    return np.where(at_end, 0.0, np.nan_to_num(per_step))
