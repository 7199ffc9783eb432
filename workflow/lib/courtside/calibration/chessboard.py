"""A camera's lens from pictures of a chessboard, held in different places before it."""

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from courtside.study.errors import InputError
from courtside.video import images

PICTURES = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp")
FEWEST = 4  # boards
MISREAD = 0.05  # of a square: corners that miss a plane grid by more are not those of one board
BLURRED = 0.25  # of a square: width of the edges between black and white
OUTLIER = 3.0  # times the median error of all boards
FINE_PX = 0.5  # a board with less error is never left out
VAGUE = 0.03  # relative standard deviation of the focal length
MAX_ROUNDS = 10
HOW = "film the board again: sharp, whole in the picture, in ten places, tilted by 20 to 40 degrees"


@dataclass(frozen=True, eq=False)
class Boards:
    """Chessboards found in pictures of one camera.

    Attributes
    ----------
    paths : tuple of Path, length B
    xy : (B, columns * rows, 2) float
        Inner corners, px, row by row.
    size : (int, int)
        Width and height of the pictures, px.
    inner_corners : (int, int)
        Columns and rows.
    dropped : dict of Path to str
        The other pictures, and why: unseen, misread or blurred.
    """

    paths: tuple
    xy: np.ndarray
    size: tuple
    inner_corners: tuple
    dropped: dict


@dataclass(frozen=True, eq=False)
class Lens:
    """A calibrated lens.

    Attributes
    ----------
    size : (int, int)
        Of the pictures, px.
    K : (3, 3) float
        One focal length along both axes, px.
    dist : (5,) float
        k1 k2 and zeros.
    rms_px : float
        Per axis, over all corners of the boards used.
    f_sigma_px : float
        Standard deviation of the focal length, from the corners' scatter.
    n_used : int
        Boards.
    dropped : dict of Path to str
        The other pictures, and why: unseen, misread, blurred or off.
    """

    size: tuple
    K: np.ndarray
    dist: np.ndarray
    rms_px: float
    f_sigma_px: float
    n_used: int
    dropped: dict


def find(pictures, inner_corners):
    """Find a chessboard in pictures of one camera.

    Parameters
    ----------
    pictures : str, Path, or list of such
        A folder, or files.
    inner_corners : (int, int)
        Corners where four squares meet, along both sides of the board, in either order.

    Returns
    -------
    boards : Boards
        Sorted by file name.

    Raises
    ------
    InputError
        If there are no pictures, one is unreadable, or their sizes differ.

    Notes
    -----
    OpenCV's sector-based detector (Duda & Frese 2018), which is sub-pixel by itself. It now and then takes
    other corners for the board's: those do not form a plane grid.
    """
    columns, rows = (int(count) for count in inner_corners)
    if min(columns, rows) < 3 or columns == rows:
        raise InputError(
            f"inner_corners: expected two different counts of 3 or more, such as [7, 4], found "
            f"{list(inner_corners)}; count where four squares meet"
        )
    paths, found, dropped, size = [], [], {}, None
    for path in _paths(pictures):
        image = images.read(path, cv2.IMREAD_GRAYSCALE, advice="delete or replace it")
        size = _same_size(path, image, size)
        xy, why = _corners(image, (columns, rows))
        if why:
            dropped[path] = why
        else:
            paths.append(path)
            found.append(xy)
    xy = np.array(found, dtype=float).reshape(-1, columns * rows, 2)
    return Boards(tuple(paths), xy, size, (columns, rows), dropped)


def _paths(pictures):
    if isinstance(pictures, (str, Path)):
        folder = Path(pictures)
        if not folder.is_dir():
            raise InputError(
                f"{folder}: expected a folder with pictures of a chessboard, found none; correct the path"
            )
        pictures = [path for path in folder.iterdir() if path.suffix.lower() in PICTURES]
        if not pictures:
            raise InputError(
                f"{folder}: expected pictures of a chessboard ({' '.join(PICTURES)}), found none; add them"
            )
    return sorted(Path(path) for path in pictures)


def _same_size(path, image, size):
    found = image.shape[1], image.shape[0]
    if size not in (None, found):
        raise InputError(
            f"{path}: expected {size[0]}x{size[1]} px as of the pictures before it, found "
            f"{found[0]}x{found[1]}; give pictures of one camera with one setting"
        )
    return found


def _corners(image, inner_corners):
    """Return the corners (N, 2) px and an empty reason, or None and why not."""
    columns, rows = inner_corners
    seen, xy = cv2.findChessboardCornersSB(image, inner_corners, flags=cv2.CALIB_CB_EXHAUSTIVE)
    if not seen:
        return None, "unseen"
    xy = xy.reshape(-1, 2)
    steps = np.linalg.norm(np.diff(xy.reshape(rows, columns, 2), axis=1), axis=2)
    matrix, _ = cv2.findHomography(_grid(inner_corners), xy)
    if matrix is None:
        return None, "misread"
    flat = cv2.perspectiveTransform(_grid(inner_corners)[:, None], matrix)[:, 0]
    if np.sqrt(np.mean((flat - xy) ** 2)) > MISREAD * np.median(steps):
        return None, "misread"
    sharpness, _ = cv2.estimateChessboardSharpness(image, inner_corners, xy)
    if sharpness[0] > BLURRED * np.median(steps):
        return None, "blurred"
    return xy, ""


def _grid(inner_corners):
    columns, rows = inner_corners
    return np.mgrid[:rows, :columns][::-1].reshape(2, -1).T.astype(np.float32)


def calibrate(boards, *, name="camera"):
    """Calibrate a lens from chessboards.

    Parameters
    ----------
    boards : Boards
    name : str
        Of the camera, for messages.

    Returns
    -------
    lens : Lens

    Raises
    ------
    InputError
        If fewer than four boards are left, or these do not determine the focal length (to 3 %).

    Notes
    -----
    Zhang 2000, by OpenCV: one focal length, the principal point, k1 and k2. A handful of boards does not tell
    decentering (p1, p2) from the principal point, nor k3 from k2. Boards that the others contradict are
    left out one after another. The size of the squares does not matter to a lens.
    """
    paths, xy = list(boards.paths), list(boards.xy)
    dropped = dict(boards.dropped)
    for _ in range(MAX_ROUNDS):
        if len(xy) < FEWEST:
            raise InputError(_too_few(name, len(xy), dropped))
        rms_px, matrix, dist, f_sigma_px, errors = _solve(xy, boards)
        worst = int(np.argmax(errors))
        if errors[worst] <= max(FINE_PX, OUTLIER * np.median(errors)):
            break
        dropped[paths.pop(worst)] = "off"
        xy.pop(worst)
    if not f_sigma_px < VAGUE * matrix[0, 0]:
        raise InputError(
            f"camera {name}: expected chessboards that show the focal length to {100 * VAGUE:g} %, found it "
            f"to {100 * f_sigma_px / matrix[0, 0]:.0f} %; {HOW}"
        )
    rms_px /= np.sqrt(2)  # OpenCV's is of the distances
    return Lens(boards.size, matrix, dist, rms_px, f_sigma_px, len(xy), dropped)


def _too_few(name, count, dropped):
    reasons = list(dropped.values())
    counts = ", ".join(f"{reasons.count(why)} {why}" for why in sorted(set(reasons)))
    return (
        f"camera {name}: expected {FEWEST} pictures or more with a usable chessboard, found {count} of "
        f"{count + len(dropped)}{f' ({counts})' if counts else ''}; check inner_corners, or {HOW}"
    )


def _solve(xy, boards):
    """Return rms px, K, dist, sigma of the focal length px, and each board's error px."""
    board = np.column_stack([_grid(boards.inner_corners), np.zeros(len(xy[0]))]).astype(np.float32)
    width, height = boards.size
    focal = float(max(width, height))
    start = np.array([[focal, 0, (width - 1) / 2], [0, focal, (height - 1) / 2], [0, 0, 1]])
    rms, matrix, dist, _, _, sigma, _, errors = cv2.calibrateCameraExtended(
        [board] * len(xy),
        [corners.astype(np.float32) for corners in xy],
        boards.size,
        start,
        np.zeros(5),
        flags=cv2.CALIB_USE_INTRINSIC_GUESS
        | cv2.CALIB_FIX_ASPECT_RATIO
        | cv2.CALIB_ZERO_TANGENT_DIST
        | cv2.CALIB_FIX_K3,
    )
    return rms, matrix, dist.ravel()[:5], float(sigma.ravel()[:2].max()), errors.ravel()
