"""Where the peaks of heat maps and SimCC lines lie, to a fraction of a cell."""

import cv2
import numpy as np
from numpy.typing import NDArray

BLUR = (0.25, 0.5, 0.25)  # binomial: smooths a map before its peak is taken
MODULATION_PX = 11  # kernel of Zhang et al. 2020 for maps with peaks of 2 cells
LEAST = 1e-10  # of a map whose logarithm is taken
FURTHEST = 2.0  # cells: the neighbourhood that the derivatives see


def values(maps: NDArray) -> NDArray:
    """Return the highest value of each map (H, W, J), cut to 0 to 1."""
    return np.clip(maps.max(axis=(0, 1)), 0, 1).astype(float)


def parabola(maps: NDArray) -> NDArray:
    """Return the column and row (J, 2) of each peak of smoothed maps (H, W, J).

    The offset within a cell is the vertex of the parabola through the peak and its neighbours.
    """
    _, width, n_joints = maps.shape
    cells = np.empty((n_joints, 2))
    smooth = _smooth(_smooth(maps, axis=0), axis=1)
    for joint in range(n_joints):
        row, column = divmod(int(np.argmax(smooth[..., joint])), width)
        cells[joint, 0] = column + _vertex(smooth[row, :, joint], column)
        cells[joint, 1] = row + _vertex(smooth[:, column, joint], row)
    return cells


def dark(maps: NDArray) -> NDArray:
    """Return the column and row (J, 2) of each peak of maps (H, W, J), as Gaussian ones.

    DARK, Zhang et al. 2020, sec 3.2: smooth, then one Newton step on the logarithm.
    """
    height, width, n_joints = maps.shape
    cells = np.empty((n_joints, 2))
    for joint in range(n_joints):
        row, column = divmod(int(np.argmax(maps[..., joint])), width)
        cells[joint] = column, row
        if 1 < column < width - 2 and 1 < row < height - 2:
            plain = np.ascontiguousarray(maps[..., joint], np.float64)
            kernel = (MODULATION_PX, MODULATION_PX)
            smooth = cv2.GaussianBlur(plain, kernel, 0, borderType=cv2.BORDER_CONSTANT)
            log = np.log(np.maximum(smooth[row - 2 : row + 3, column - 2 : column + 3], LEAST))
            cells[joint] += _newton(log)
    return cells


def _newton(log: NDArray) -> NDArray:
    """Return the step (x, y) to the top of values (5, 5) from their middle."""
    gradient = np.array([log[2, 3] - log[2, 1], log[3, 2] - log[1, 2]]) / 2
    across = (log[3, 3] - log[1, 3] - log[3, 1] + log[1, 1]) / 4
    xx = (log[2, 4] - 2 * log[2, 2] + log[2, 0]) / 4
    yy = (log[4, 2] - 2 * log[2, 2] + log[0, 2]) / 4
    bend = xx * yy - across**2
    if bend <= 0 or xx >= 0:
        return np.zeros(2)
    step = -np.linalg.solve(np.array([[xx, across], [across, yy]]), gradient)
    return step if np.abs(step).max() <= FURTHEST else np.zeros(2)


def lines(x: NDArray) -> tuple[NDArray, NDArray]:
    """Return the place of the peak of each line (J, N), in bins, and its value; (J,) both."""
    at = x.argmax(axis=1)
    bins = [place + _vertex(line, int(place)) for line, place in zip(x, at, strict=True)]
    return np.array(bins, float), x.max(axis=1).astype(float)


def _smooth(maps: NDArray, axis: int) -> NDArray:
    padded = np.concatenate([maps.take([0], axis), maps, maps.take([-1], axis)], axis=axis)
    n = maps.shape[axis]
    return np.asarray(sum(w * padded.take(range(at, at + n), axis) for at, w in enumerate(BLUR)))


def _vertex(line: NDArray, at: int) -> float:
    if not 0 < at < len(line) - 1:
        return 0.0
    before, here, after = (float(line[at + step]) for step in (-1, 0, 1))
    bend = before - 2 * here + after
    return 0.5 * (before - after) / bend if bend < 0 else 0.0
