"""OpenCV's lens distortion k1 k2 p1 p2 k3 on the normalised image plane (z = 1), and its inverse."""

import numpy as np

MAX_ITERATIONS = 50
ENTRIES = 2048
NOTHING = 1e-30  # a coefficient so small beside the others divides them beyond what a float holds


def distort(dist, normalised):
    """Move points (..., 2) to where the lens shows them.

    Brown 1971, in OpenCV's order of coefficients.
    """
    x, y = normalised[..., 0], normalised[..., 1]
    square, product = x * x + y * y, 2 * x * y
    _, _, p1, p2, _ = dist
    radial = _radial(dist, square)
    return np.stack(
        [
            x * radial + p1 * product + p2 * (square + 2 * x * x),
            y * radial + p1 * (square + 2 * y * y) + p2 * product,
        ],
        axis=-1,
    )


def jacobian(dist, normalised):
    """Return the derivative (..., 2, 2) of `distort`; it is symmetric."""
    along_x, mixed, along_y = _slopes(dist, normalised)
    return np.stack([along_x, mixed, mixed, along_y], axis=-1).reshape(*mixed.shape, 2, 2)


def _slopes(dist, normalised):
    """Return the three elements (...) of the symmetric derivative of `distort`."""
    x, y = normalised[..., 0], normalised[..., 1]
    square = x * x + y * y
    k1, k2, p1, p2, k3 = dist
    radial = _radial(dist, square)
    slope = 2 * (k1 + square * (2 * k2 + square * 3 * k3))  # of radial, over r
    mixed = x * y * slope + 2 * (p1 * x + p2 * y)
    along_x = radial + x * x * slope + 2 * p1 * y + 6 * p2 * x
    along_y = radial + y * y * slope + 6 * p1 * y + 2 * p2 * x
    return along_x, mixed, along_y


def jacobian_by_place(dist, normalised, depth):
    """Return the derivative (..., 2, 3) of distorted points by the places that the camera sees them at.

    Parameters
    ----------
    dist : (5,) float
    normalised : (..., 2) float
        On the z = 1 plane.
    depth : (..., 1) float
        Along the camera's axis; the derivative is per unit of it.
    """
    pinhole = np.zeros((*normalised.shape, 3))
    pinhole[..., 0, 0] = pinhole[..., 1, 1] = 1.0
    pinhole[..., 2] = -normalised
    return jacobian(dist, normalised) @ pinhole / depth[..., np.newaxis]


def fold_radius(dist):
    """Return the radius at which the radial part turns back, inf if it never does.

    From there on the lens model would show one pixel for several directions.
    """
    k1, k2, _, _, k3 = dist
    coefficients = np.array([7 * k3, 5 * k2, 3 * k1, 1.0])
    coefficients[np.abs(coefficients) < NOTHING * np.abs(coefficients).max()] = 0.0
    squares = np.roots(coefficients)
    real = squares.real[(np.abs(squares.imag) < 1e-9 * np.abs(squares)) & (squares.real > 0)]
    return float(np.sqrt(real.min(initial=np.inf)))


def undistort(dist, fold, distorted, tolerance):
    """Invert `distort` below the fold.

    Parameters
    ----------
    dist : (5,) float
    fold : float
        From `fold_radius`.
    distorted : (..., 2) float
    tolerance : (...) float
        Accepted error of `distort` at the result.

    Returns
    -------
    normalised : (..., 2) float
        NaN where missing, and where no point below the fold is shown there.

    Notes
    -----
    Newton's method from the inverse of the radial part, tabulated up to the fold: it neither diverges
    under strong distortion nor lands on a direction beyond the fold.
    """
    normalised = _undistort_radially(dist, fold, distorted)
    for _ in range(MAX_ITERATIONS):
        error = distorted - distort(dist, normalised)
        solved = np.abs(error).max(axis=-1) <= tolerance
        a, b, d = _slopes(dist, normalised)
        determinant = a * d - b * b
        rising = determinant > 0
        if (solved | ~rising).all():
            break
        step = [d * error[..., 0] - b * error[..., 1], a * error[..., 1] - b * error[..., 0]]
        divisor = np.where(rising, determinant, np.nan)[..., np.newaxis]
        normalised = normalised + np.stack(step, axis=-1) / divisor
    found = solved & rising & (np.hypot(normalised[..., 0], normalised[..., 1]) < fold)
    return np.where(found[..., np.newaxis], normalised, np.nan)


def _radial(dist, square):
    return 1 + square * (dist[0] + square * (dist[1] + square * dist[4]))


def _undistort_radially(dist, fold, distorted):
    """Undo the radial part to about 1 %: the start for Newton's method."""
    radius = np.hypot(distorted[..., 0], distorted[..., 1])
    farthest = np.nan_to_num(radius).max(initial=1.0)
    limit = 1.0
    while limit < fold and limit * _radial(dist, limit**2) < farthest:
        limit *= 2
    radii = np.geomspace(1e-3, min(limit, fold), ENTRIES)
    seen = radii * _radial(dist, radii**2)
    # The entry below: the slope falls towards the fold, so that steps from below cannot jump it.
    below = np.maximum(np.searchsorted(seen, radius) - 1, 0)
    return distorted / _radial(dist, radii[below] ** 2)[..., np.newaxis]
