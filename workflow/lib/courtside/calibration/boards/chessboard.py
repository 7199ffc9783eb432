"""Calibrate a camera's lens from pictures of a chessboard, held in different places before it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.geometry.camera import plain
from courtside.study.errors import InputError, StrPath
from courtside.video import images

PICTURES = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp")
FEWEST = 4  # ASSUME: boards; two in different poses are the minimum, four show a wrong one
MISREAD = 0.05  # ASSUME: of a square: corners that miss a plane grid by more are not of one board
# Lens distortions that may bend the grid: radii from the picture's middle are divided by
# 1 + b (r / half the diagonal)^2 (Fitzgibbon 2001). An action camera has -0.4.
BENDS = np.linspace(-0.8, 0.2, 21)
BLURRED = 0.25  # ASSUME: of a square: width of the edges between black and white
OUTLIER = 3.0  # ASSUME: times the median error of all boards
FINE_PX = 0.5  # ASSUME: a board with less error is never left out
MAX_F_SIGMA = 0.03  # ASSUME: relative standard deviation of a usable focal length
MAX_ROUNDS = 10  # ASSUME: boards left out at most
# Of an ordinary lens k3 lowers the rms by less than 1 %, and makes nothing better. Of an
# equidistant lens of 91 degrees (0.1 px noise, 12 boards) it halves it, of 127 degrees it divides
# it by 3, and errors of directions by 6 to 30.
CLEAR_FALL = 0.85  # ASSUME: of the rms without k3; with k3 it is below, or k3 is left out
MOST_RMS_PX = 0.3  # ASSUME: of sharp boards it is 0.1
# Focal lengths tried first, of the longer side: from action cameras to the far end of a zoom. From
# one that is 3 times too short the solution ends in a wrong minimum, with a small stated error.
STARTS = (0.5, 1.0, 2.0, 4.0, 8.0)
HOW = "film the board again: sharp, whole in the picture, in ten places, tilted by 20 to 40 degrees"


@dataclass(frozen=True, eq=False)
class Boards:
    """Chessboards found in pictures of one camera."""

    paths: tuple[Path, ...]
    xy: NDArray  # (B, columns * rows, 2): inner corners, px, row by row
    size: tuple[int, int]  # width and height of the pictures, px
    inner_corners: tuple[int, int]  # columns and rows
    dropped: dict[Path, str]  # the other pictures, and why: unseen, misread or blurred


@dataclass(frozen=True, eq=False)
class Lens:
    """A calibrated lens."""

    size: tuple[int, int]  # of the pictures, px
    K: NDArray  # (3, 3): one focal length along both axes, px
    dist: NDArray  # (5,): k1 k2, zeros, and k3 where the boards demand it
    rms_px: float  # per axis, over all corners of the boards used
    f_sigma_px: float  # standard deviation of the focal length, from the corners' scatter
    n_used: int  # boards
    dropped: dict[Path, str]  # the other pictures, and why: unseen, misread, blurred or off


def find(folder: StrPath, inner_corners: Sequence[int]) -> Boards:
    """Find a chessboard in pictures of one camera, in the order of their file names.

    Uses OpenCV's sector-based detector (Duda & Frese 2018), which has sub-pixel accuracy. It
    sometimes returns wrong corners; these do not form a plane grid and are rejected. Raises
    `InputError` if there are no pictures, one is unreadable, or their sizes differ. `inner_corners`
    counts where four squares meet, along both sides of the board, in either order: two different
    numbers of 3 or more, as the schema of a session has them.
    """
    columns, rows = (int(count) for count in inner_corners)
    paths, found = [], []
    dropped: dict[Path, str] = {}
    size: tuple[int, int] | None = None
    for path in pictures_of(folder):
        image = images.read(path, cv2.IMREAD_GRAYSCALE, advice="delete or replace it")
        size = same_size(path, image, size)
        xy, why = _corners(image, (columns, rows))
        if why:
            dropped[path] = why
        else:
            paths.append(path)
            found.append(xy)
    assert size is not None  # there is a picture
    xy = np.array(found, dtype=float).reshape(-1, columns * rows, 2)
    return Boards(tuple(paths), xy, size, (columns, rows), dropped)


def pictures_of(folder: StrPath) -> list[Path]:
    """Return the pictures of a folder in name order; raise `InputError` if there are none."""
    folder = Path(folder)
    if not folder.is_dir():
        raise InputError(
            f"{folder}: expected a folder with pictures of a board, found none; correct the path"
        )
    pictures = [path for path in folder.iterdir() if path.suffix.lower() in PICTURES]
    if not pictures:
        raise InputError(
            f"{folder}: expected pictures of a board ({' '.join(PICTURES)}), found none; add them"
        )
    return sorted(pictures)


def same_size(path: Path, image: NDArray, size: tuple[int, int] | None) -> tuple[int, int]:
    """Return the size of a picture, px; raise `InputError` if those before it had another one."""
    found = image.shape[1], image.shape[0]
    if size is not None and size != found:
        raise InputError(
            f"{path}: expected {size[0]}x{size[1]} px as of the pictures before it, found "
            f"{found[0]}x{found[1]}; give pictures of one camera with one setting"
        )
    return found


def _corners(image: NDArray, inner_corners: tuple[int, int]) -> tuple[NDArray | None, str]:
    """Return the corners (N, 2) px and an empty reason, or None and why not."""
    columns, rows = inner_corners
    seen, xy = cv2.findChessboardCornersSB(image, inner_corners, flags=cv2.CALIB_CB_EXHAUSTIVE)
    if not seen:
        return None, "unseen"
    xy = xy.reshape(-1, 2)
    middle = (np.array(image.shape[1::-1]) - 1) / 2
    away = (xy - middle) / np.linalg.norm(middle)
    square = (away**2).sum(axis=1, keepdims=True)
    if min(_off(away / (1 + bend * square), inner_corners) for bend in BENDS) > MISREAD:
        return None, "misread"
    steps = np.linalg.norm(np.diff(xy.reshape(rows, columns, 2), axis=1), axis=2)
    sharpness, _ = cv2.estimateChessboardSharpness(image, inner_corners, xy)
    if sharpness[0] > BLURRED * np.median(steps):
        return None, "blurred"
    return xy, ""


def _off(xy: NDArray, inner_corners: tuple[int, int]) -> float:
    """Return by how much corners (N, 2) miss a plane grid, rms per axis, in squares."""
    columns, rows = inner_corners
    matrix, _ = cv2.findHomography(_grid(inner_corners), xy)
    if matrix is None:
        return np.inf
    flat = cv2.perspectiveTransform(_grid(inner_corners)[:, None], matrix)[:, 0]
    steps = np.linalg.norm(np.diff(xy.reshape(rows, columns, 2), axis=1), axis=2)
    return float(np.sqrt(np.mean((flat - xy) ** 2)) / np.median(steps))


def _grid(inner_corners: tuple[int, int]) -> NDArray:
    columns, rows = inner_corners
    return np.mgrid[:rows, :columns][::-1].reshape(2, -1).T.astype(np.float32)


def calibrate(boards: Boards, *, name: str = "camera") -> Lens:
    """Calibrate a lens from chessboards; `name` is the camera's, for messages.

    Zhang 2000, by OpenCV: one focal length, the principal point, k1 and k2, of wide lenses k3 too.
    A handful of boards does not separate decentering (p1, p2) from the principal point. Boards that
    contradict the others are left out one after another. The size of the squares does not matter to
    a lens. Raises `InputError` if fewer than four boards are left, or these do not determine the
    focal length (to 3 %).
    """
    paths, xy = list(boards.paths), list(boards.xy)
    dropped = dict(boards.dropped)
    grid = _grid(boards.inner_corners)
    board = np.column_stack([grid, np.zeros(len(grid))])
    for n_left_out in range(MAX_ROUNDS + 1):
        if len(xy) < FEWEST:
            raise InputError(_too_few(name, len(xy), dropped))
        rms_px, matrix, dist, f_sigma_px, errors = solve([board] * len(xy), xy, boards.size)
        worst = int(np.argmax(errors))
        is_fine = errors[worst] <= max(FINE_PX, OUTLIER * np.median(errors))
        if is_fine or n_left_out == MAX_ROUNDS:
            break
        dropped[paths.pop(worst)] = "off"
        xy.pop(worst)
    if not f_sigma_px < MAX_F_SIGMA * matrix[0, 0]:
        raise InputError(
            f"camera {name}: expected chessboards that show the focal length to "
            f"{100 * MAX_F_SIGMA:g} %, found it to {100 * f_sigma_px / matrix[0, 0]:.0f} %; {HOW}"
        )
    rms_px /= np.sqrt(2)  # OpenCV's is of the distances
    return Lens(boards.size, matrix, dist, rms_px, f_sigma_px, len(xy), dropped)


def _too_few(name: str, count: int, dropped: Mapping[Path, str]) -> str:
    reasons = list(dropped.values())
    counts = ", ".join(f"{reasons.count(why)} {why}" for why in sorted(set(reasons)))
    return (
        f"camera {name}: expected {FEWEST} pictures or more with a usable chessboard, found "
        f"{count} of {count + len(dropped)}{f' ({counts})' if counts else ''}; check "
        f"inner_corners, or {HOW}"
    )


def warnings(lens: Lens, *, name: str = "camera") -> list[str]:
    """Return a warning if the boards do not fit the lens; `name` is the camera's."""
    if lens.rms_px <= MOST_RMS_PX:
        return []
    return [
        f"camera {name}: expected corners of chessboards within {MOST_RMS_PX:g} px of the lens, "
        f"found {lens.rms_px:.2f} px: directions may be wrong by several times that. A very wide "
        "lens bends more than k1 k2 k3 follow (film in the camera's linear or narrower mode), the "
        "board is not flat, or its pictures are blurred"
    ]


def solve(
    places: Sequence[NDArray],
    xy: Sequence[NDArray],
    size: tuple[int, int],
    *,
    may_have_k3: bool = True,
) -> tuple[float, NDArray, NDArray, float, NDArray]:
    """Return rms px, K, dist, sigma of the focal length px, and the error px of each view.

    `places` (N, 3) are those of each view's corners on the board, z = 0, `xy` (N, 2) px where they
    are seen. It is the best of the solutions from all `STARTS`; with k3, starting from this one, if
    the rms falls clearly (`CLEAR_FALL`).
    """
    views = [(p.astype(np.float32), q.astype(np.float32)) for p, q in zip(places, xy, strict=True)]
    starts = (plain("", size, share).K for share in STARTS)
    found = (_solved(views, size, K, np.zeros(5), cv2.CALIB_FIX_K3) for K in starts)
    best = min(found, key=lambda one: one[0])
    with_k3 = False
    if may_have_k3:
        freed = _solved(views, size, best[1], best[2].ravel()[:5], 0)
        with_k3 = freed[0] < CLEAR_FALL * best[0]
        best = freed if with_k3 else best
    rms, matrix, dist, turns, shifts, _, _, errors = best
    poses = zip(places, turns, shifts, strict=True)
    by = [cv2.projectPoints(p, turn, shift, matrix, dist)[1] for p, turn, shift in poses]
    count = sum(len(each) for each in xy)
    f_sigma_px = _f_sigma_px(by, rms * np.sqrt(count), with_k3)
    return rms, matrix, dist.ravel()[:5], f_sigma_px, errors.ravel()


def _solved(
    views: Sequence[tuple[NDArray, NDArray]],
    size: tuple[int, int],
    K: NDArray,
    dist: NDArray,
    flags: int,
) -> tuple:
    """Return OpenCV's solution from a first lens, with one focal length and no decentering."""
    return cv2.calibrateCameraExtended(
        [places for places, _ in views],
        [xy for _, xy in views],
        size,
        K.copy(),  # OpenCV writes its result there
        dist.copy(),
        flags=flags
        | cv2.CALIB_USE_INTRINSIC_GUESS
        | cv2.CALIB_FIX_ASPECT_RATIO
        | cv2.CALIB_ZERO_TANGENT_DIST,
    )


def _f_sigma_px(by: Sequence[NDArray], off_px: float, with_k3: bool) -> float:
    """Return the standard deviation of the focal length; `off_px` is the norm of all residuals.

    `by` (2 N, 15) are the derivatives of each view, by `cv2.projectPoints`: of its pose, f along x
    and y, the centre, k1 k2 p1 p2 k3. OpenCV's own standard deviation is 0 where the boards do
    not determine the focal length: it inverts the normal equations without what is nearly singular.
    """
    lens = []
    distortion = [10, 11, 14] if with_k3 else [10, 11]
    for view in by:
        of_pose, _ = np.linalg.qr(view[:, :6])
        own = np.column_stack([view[:, [8, 9, *distortion]], view[:, 6] + view[:, 7]])
        lens.append(own - of_pose @ (of_pose.T @ own))
    stacked = np.concatenate(lens)
    _, upper = np.linalg.qr(stacked)
    of_f = abs(upper[-1, -1])  # what no other unknown explains
    unknown = stacked.shape[1] + 6 * len(by)
    with np.errstate(divide="ignore"):
        return float(off_px / np.sqrt(max(1, len(stacked) - unknown)) / of_f)
