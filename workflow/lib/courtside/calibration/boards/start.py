"""Initial lenses, cameras and boards for the adjustment, each from a few views, robustly."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.calibration import robust_poses
from courtside.calibration.boards import chessboard
from courtside.calibration.boards.board import Board
from courtside.calibration.boards.corners import Corners
from courtside.geometry import rotations
from courtside.geometry.camera import Camera, plain
from courtside.study.errors import InputError, few

FEWEST_CORNERS = 6  # ASSUME: of a view that is to tell a pose by itself
SHOWN = 20  # pictures of a list in a message
MISREAD, LEAST_OFF_PX = 0.1, 3.0  # ASSUME: of a square, and px: farther off is another corner
FLAT_SHARE = 0.5  # ASSUME: of the corners of the right board
MOST_VIEWS = 40  # ASSUME: more do not better a lens, and cost with their square
HOW = (
    "film the board in ten places or more, tilted by 20 to 40 degrees, large in the pictures of "
    "two cameras at a time"
)
View = tuple[NDArray, NDArray]  # rows of the corners that one camera sees in one picture; (3, 4)


@dataclass(frozen=True, eq=False)
class Poses:
    """Cameras and boards in the frame of the board of one picture."""

    cam_from_world: NDArray  # (C, 3, 4)
    world_from_board: NDArray  # (P, 3, 4); NaN of a picture that tells no pose
    world: int  # the picture whose board is the world


def flat(board: Board, seen: Corners) -> NDArray:
    """Return which corners (M,) lie on one plane with the others of their picture, bool.

    A misread corner does not; lens distortion is assumed to bend a board by less than a tenth of a
    square. Raises `InputError` if most corners do not, because the stated board is then wrong.
    """
    found = np.zeros(len(seen.xy), dtype=bool)
    for rows in (view for c in range(len(seen.cameras)) for view in _views(seen, c)):
        if len(rows) < FEWEST_CORNERS:
            continue
        places, xy = board.corners[seen.corner[rows], :2], seen.xy[rows]
        apart = np.linalg.norm(xy[:, None] - xy, axis=-1) + 1e9 * np.eye(len(rows))
        limit_px = max(LEAST_OFF_PX, MISREAD * float(np.median(apart.min(axis=1))))
        _, inliers = cv2.findHomography(places, xy, cv2.RANSAC, limit_px)
        if inliers is not None:
            found[rows] = inliers.ravel().astype(bool)
    share = float(found.mean())
    if share < FLAT_SHARE:
        raise InputError(
            f"board: expected corners that lie on one plane, {FEWEST_CORNERS} or more in a "
            f"picture, found {100 * share:.0f} % of them; check `squares`, or {HOW}"
        )
    return found


def lens(name: str, size: Sequence[int], board: Board, seen: Corners, camera: int) -> Camera:
    """Return a camera without a pose: K, k1 and k2 from its own views of the board (Zhang 2000).

    Raises `InputError` if it has fewer than four views of six corners.
    """
    rows = [at for at in _views(seen, camera) if len(at) >= FEWEST_CORNERS]
    if len(rows) < chessboard.FEWEST:
        raise InputError(
            f"camera {name}: expected {chessboard.FEWEST} pictures or more with {FEWEST_CORNERS} "
            f"corners of the board, found {len(rows)}; {HOW}, or give `lenses`"
        )
    rows = [rows[k] for k in np.unique(np.linspace(0, len(rows) - 1, MOST_VIEWS).astype(int))]
    first = plain(name, (size[0], size[1]), 1.0)
    places = [board.corners[seen.corner[at]] for at in rows]
    xy = [seen.xy[at] for at in rows]
    # The adjustment has no k3.
    _, matrix, dist, *_ = chessboard.solve(places, xy, first.size, may_have_k3=False)
    return replace(first, K=matrix, dist=dist)


def poses(board: Board, seen: Corners, ideal: NDArray, world: str | None) -> Poses:
    """Return the poses of cameras and boards; each view of six corners or more gives one.

    `ideal` (M, 2) are the directions of the corners, z = 1. `world` names the picture whose board
    defines the world; None: the picture that most cameras see, with most corners. Raises
    `InputError` if a group of cameras shares no picture of the board with the others, or that
    picture shows none.
    """
    views = _posed(board, seen, ideal)
    cam_from_root = _from_root(board, seen, views)
    boards = np.full((len(seen.pictures), 3, 4), np.nan)
    most = np.zeros(len(seen.pictures))
    for (camera, picture), (rows, pose) in views.items():
        if len(rows) > most[picture]:
            most[picture] = len(rows)
            boards[picture] = rotations.composed(rotations.invert(cam_from_root[camera]), pose)
    at = _world(seen, views, world)
    world_from_root = rotations.invert(boards[at])
    root_from_world = boards[at]
    return Poses(
        np.stack([rotations.composed(pose, root_from_world) for pose in cam_from_root]),
        np.stack([rotations.composed(world_from_root, one) for one in boards]),
        at,
    )


def _views(seen: Corners, camera: int) -> list[NDArray]:
    """Return the rows of each picture of a camera."""
    rows = np.flatnonzero(seen.camera == camera)
    order = rows[np.argsort(seen.picture[rows], kind="stable")]
    return np.split(order, np.flatnonzero(np.diff(seen.picture[order])) + 1) if len(rows) else []


def _posed(board: Board, seen: Corners, ideal: NDArray) -> dict[tuple[int, int], View]:
    """Return, by camera and picture, the rows and the pose of the board where they determine it."""
    found = {}
    for camera in range(len(seen.cameras)):
        for rows in _views(seen, camera):
            xyz, at = board.corners[seen.corner[rows]], ideal[rows]
            extent = np.linalg.svd(xyz - xyz.mean(axis=0), compute_uv=False)
            if len(rows) < FEWEST_CORNERS or extent[1] < 0.1 * board.square_m:  # on one line
                continue
            lens = robust_poses.IDEAL, None
            if both := robust_poses.placed(xyz, at, *lens, cv2.SOLVEPNP_IPPE):
                found[camera, int(seen.picture[rows[0]])] = rows, both[0]
    return found


def _from_root(board: Board, seen: Corners, views: dict[tuple[int, int], View]) -> list[NDArray]:
    """Return all cameras relative to the one that shares most pictures, along a spanning tree."""
    count = len(seen.cameras)
    of = [{picture for camera, picture in views if camera == c} for c in range(count)]
    shared = np.array(
        [[len(of[a] & of[b]) if a != b else 0 for b in range(count)] for a in range(count)]
    )
    root = int(shared.sum(axis=1).argmax())
    found = {root: np.eye(3, 4)}
    while len(found) < count:
        inside = sorted(found)
        outside = [c for c in range(count) if c not in found]
        block = shared[np.ix_(inside, outside)]
        if not block.any():
            names = seen.cameras
            raise InputError(
                f"cameras {', '.join(names[c] for c in inside)} and "
                f"{', '.join(names[c] for c in outside)}: expected pictures in which one of each "
                "sees the board at the same place, found none; film it where both groups see it"
            )
        a, b = (int(k) for k in np.unravel_index(block.argmax(), block.shape))
        one, other = inside[a], outside[b]
        pairs = [(views[one, p][1], views[other, p][1]) for p in sorted(of[one] & of[other])]
        found[other] = rotations.composed(_between(board, pairs), found[one])
    return [found[c] for c in range(count)]


def _between(board: Board, pairs: Sequence[tuple[NDArray, NDArray]]) -> NDArray:
    """Return `other_from_one` of two cameras from the picture that fits most other pictures."""
    candidates = [rotations.composed(other, rotations.invert(one)) for one, other in pairs]
    corners = np.column_stack([board.corners, np.ones(len(board.corners))])
    in_one = np.stack([corners @ one.T for one, _ in pairs])
    in_other = np.stack([corners @ other.T for _, other in pairs])
    off = [
        np.median(np.linalg.norm(in_one @ c[:, :3].T + c[:, 3] - in_other, axis=-1).mean(axis=1))
        for c in candidates
    ]
    return candidates[int(np.argmin(off))]


def _world(seen: Corners, views: dict[tuple[int, int], View], wanted: str | None) -> int:
    posed = {picture for _, picture in views}
    if wanted is None:
        score = [
            (sum((c, p) in views for c in range(len(seen.cameras))), int((seen.picture == p).sum()))
            if p in posed
            else (0, 0)
            for p in range(len(seen.pictures))
        ]
        return score.index(max(score))
    names = [name for name in seen.pictures if _same(name, wanted)]
    if not names or seen.pictures.index(names[0]) not in posed:
        there = [seen.pictures[at].lstrip("0") or "0" for at in sorted(posed)]  # see `_same`
        raise InputError(
            f"board.floor: expected a picture that shows {FEWEST_CORNERS} corners of the board or "
            f"more, found {wanted!r}; name one of those that do: {few(there, SHOWN)}"
        )
    return seen.pictures.index(names[0])


def _same(name: str, wanted: str) -> bool:
    """Return whether two picture names are equal; leading zeros of numbers do not count."""
    return name.lstrip("0") == wanted.lstrip("0")
