"""Pictures of a chessboard before a fixed camera, exact through its lens."""

from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.geometry import camera as camera_models
from courtside.geometry import rotations
from courtside.geometry.camera import Camera
from courtside.video import reader

# ASSUME: a board as people print it; no source is recorded.
INNER_CORNERS = (7, 4)  # along the board's x and y
SQUARE_M = 0.06
BORDER_M = 0.03  # white, around the squares
DARK, BRIGHT = 28.0, 218.0
SUBSAMPLES = 4  # per pixel and axis
OPTICAL_BLUR_PX = 0.5
TILT_DEG = 35.0
# Of the board's centre, as fractions of width and height: together they cover the picture.
PLACES: tuple[tuple[float, float], ...]
PLACES = ((0.5, 0.5), (0.2, 0.22), (0.8, 0.22), (0.8, 0.78), (0.2, 0.78), (0.5, 0.2), (0.5, 0.8))
PLACES += ((0.17, 0.5), (0.83, 0.5), (0.35, 0.4), (0.65, 0.6), (0.5, 0.5))


def corners_m() -> NDArray:
    """Return the inner corners (28, 3) of the board, row by row, m; the first is the origin."""
    columns, rows = INNER_CORNERS
    grid = np.mgrid[:rows, :columns][::-1].reshape(2, -1).T * SQUARE_M
    return np.column_stack([grid, np.zeros(len(grid))])


def poses(camera: Camera, n_boards: int, rng: np.random.Generator) -> NDArray:
    """Draw poses of a board that together fill the field of view.

    Returns
    -------
    cam_from_board : (n_boards, 3, 4) float
        Metres; the whole board is visible, with 0.3 to 0.55 of the picture's width.
    """
    found: list[NDArray] = []
    middle = np.append(corners_m()[:, :2].mean(axis=0), 0.0)
    while len(found) < n_boards:
        place = np.array(PLACES[len(found) % len(PLACES)]) + rng.uniform(-0.03, 0.03, 2)
        ray = np.append(camera_models.undistort(camera, place * camera.size), 1.0)
        wide = rng.uniform(0.3, 0.55)
        depth_m = (INNER_CORNERS[0] + 1) * SQUARE_M * camera.K[0, 0] / (wide * camera.size[0])
        turn = rng.uniform(-TILT_DEG, TILT_DEG, 3) * [1, 1, 0.4]
        rotation = rotations.rotation_from_rodrigues(np.radians(turn))
        pose = np.column_stack([rotation, ray * depth_m - rotation @ middle])
        if _inside(camera, pose):
            found.append(pose)
    return np.array(found)


def picture(
    camera: Camera,
    cam_from_board: NDArray,
    background: NDArray,
    rng: np.random.Generator,
    *,
    noise: float,
) -> NDArray:
    """Draw the board in front of a background.

    Parameters
    ----------
    camera : Camera
        Gives the lens; its pose does not matter.
    cam_from_board : (3, 4) float
        Metres.
    background : (H, W, 3) uint8
        The camera's picture without a board.
    rng : numpy.random.Generator
    noise : float
        Standard deviation of the sensor's noise, grey levels.

    Returns
    -------
    image : (H, W, 3) uint8
        BGR.

    Notes
    -----
    The ray of each sample is intersected with the board's plane. Rays follow the lens exactly at
    pixel centres and linearly within a pixel (error below 1e-5 px for phone lenses).
    """
    left, top, right, bottom = _box(camera, cam_from_board)
    xy = np.stack(np.meshgrid(np.arange(left, right), np.arange(top, bottom)), axis=-1)
    rays = camera_models.undistort(camera, xy)
    along_x, along_y = np.gradient(rays, axis=1), np.gradient(rays, axis=0)
    offsets = (np.arange(SUBSAMPLES) + 0.5) / SUBSAMPLES - 0.5
    shade, cover = np.zeros(rays.shape[:2]), np.zeros(rays.shape[:2])
    for dx in offsets:
        for dy in offsets:
            level, on_board = _pattern(cam_from_board, rays + dx * along_x + dy * along_y)
            shade += level
            cover += on_board
    share = (cover / SUBSAMPLES**2)[..., np.newaxis]
    slope = np.linspace(1.0, rng.uniform(0.8, 1.0), right - left)  # light from one side
    board = (shade / SUBSAMPLES**2 * slope)[..., np.newaxis]
    image = background.astype(np.float32)
    patch = image[top:bottom, left:right]
    image[top:bottom, left:right] = patch * (1 - share) + board
    image = cv2.GaussianBlur(image, (0, 0), OPTICAL_BLUR_PX)
    image += rng.standard_normal(image.shape, dtype=np.float32) * noise
    return np.clip(np.rint(image), 0, 255).astype(np.uint8)


def simulate(
    camera: Camera,
    folder: str | Path,
    background: NDArray,
    rng: np.random.Generator,
    *,
    n_boards: int = 12,
    noise: float = 2.0,
) -> NDArray:
    """Write pictures of a board as numbered PNG files.

    Parameters
    ----------
    camera : Camera
    folder : str or Path
        Created if missing.
    background : (H, W, 3) uint8
        The camera's picture without a board.
    rng : numpy.random.Generator
    n_boards : int
    noise : float
        Standard deviation of the sensor's noise, grey levels.

    Returns
    -------
    cam_from_board : (n_boards, 3, 4) float
        Poses of the board, metres.
    """
    held = poses(camera, n_boards, rng)
    for at, pose in enumerate(held):
        image = picture(camera, pose, background, rng, noise=noise)
        reader.write_png(Path(folder) / f"{at:06d}.png", image)
    return held


def _outline_m() -> NDArray:
    """Return the board's four outer corners (4, 3), border included."""
    reach = SQUARE_M + BORDER_M
    x0, y0, x1, y1 = -reach, -reach, *((np.array(INNER_CORNERS) - 1) * SQUARE_M + reach)
    return np.array([[x0, y0, 0], [x1, y0, 0], [x1, y1, 0], [x0, y1, 0]])


def _outline_px(camera: Camera, cam_from_board: NDArray) -> NDArray:
    edges = _outline_m()
    dense = np.concatenate(
        [np.linspace(a, b, 8) for a, b in zip(edges, np.roll(edges, -1, axis=0), strict=True)]
    )
    seen = camera_models.Camera("board", camera.size, camera.K, camera.dist, cam_from_board)
    return camera_models.project(seen, dense)


def _inside(camera: Camera, cam_from_board: NDArray) -> bool:
    xy = _outline_px(camera, cam_from_board)
    return bool(((xy > 2) & (xy < np.array(camera.size) - 3)).all())


def _box(camera: Camera, cam_from_board: NDArray) -> tuple[int, int, int, int]:
    """Return left, top, right, bottom (the last two exclusive) of the board in the picture."""
    xy = _outline_px(camera, cam_from_board)
    low = np.maximum(np.floor(xy.min(axis=0)) - 3, 0)
    high = np.minimum(np.ceil(xy.max(axis=0)) + 4, camera.size)
    return int(low[0]), int(low[1]), int(high[0]), int(high[1])


def _pattern(cam_from_board: NDArray, rays: NDArray) -> tuple[NDArray, NDArray]:
    """Return grey level times coverage, and coverage (0 or 1), of rays (..., 2)."""
    # A board point (u, v, 0) lies on the ray: (r1 r2 t) (u v 1)^T ~ (x y 1)^T.
    board_from_ray = np.linalg.inv(cam_from_board[:, [0, 1, 3]])
    place = rays @ board_from_ray[:, :2].T + board_from_ray[:, 2]
    squares = place[..., :2] / place[..., 2:] / SQUARE_M
    columns, rows = INNER_CORNERS
    u, v = squares[..., 0], squares[..., 1]
    border = BORDER_M / SQUARE_M
    on_board = (np.abs(u - (columns - 1) / 2) < (columns + 1) / 2 + border) & (
        np.abs(v - (rows - 1) / 2) < (rows + 1) / 2 + border
    )
    in_squares = (u > -1) & (u < columns) & (v > -1) & (v < rows)
    dark = in_squares & ((np.floor(u) + np.floor(v)) % 2 == 0)
    return np.where(dark, DARK, BRIGHT) * on_board, on_board
