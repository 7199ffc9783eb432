"""Movement of a fixed camera's picture, and the camera rotation that explains it."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

# ASSUME: this block has no source but the development sessions (CONTRIBUTING.md).
N_FEATURES = 4000  # ORB features that find a large movement
N_CORNERS = 600  # corners that measure it
CELL = 0.02  # least distance of corners, picture widths: people get no more than their area
CONTRAST = 0.01  # picture widths: scale at which brightness and contrast are normalised
BLUR_STEPS = 3  # pixels of the lower resolution in a standard deviation of that scale
MIN_CONTRAST = 4.0  # grey levels; flatter surroundings are not amplified further
WINDOW_PX = 21  # of a tracked corner
MAX_RETURN_PX = 0.2  # a corner tracked forth and back must return this close
MAX_ERROR_PX = 1.0  # of an inlier
MIN_MATCHES = 20  # with fewer inliers the movement is unknown
MIN_SPREAD = 0.1  # least standard deviation of the inliers' places, of the shorter side


@dataclass(frozen=True)
class Movement:
    """Similarity about the picture's centre between two pictures of a fixed camera."""

    shift_px: NDArray  # (2,): of the content at the picture's centre: right, down
    zoom: float  # scale of the other picture relative to the reference; 1 for none
    rotation_deg: float  # clockwise rotation of the content, as seen on the picture
    # Background points that agree. If they are fewer than required, or do not spread over the
    # picture, the rest is NaN.
    n_matches: int
    sigma_px: float = float("nan")  # standard deviation of `shift_px` per axis, where it is known

    @property
    def known(self) -> bool:
        """Whether enough points agree to tell."""
        return bool(np.isfinite(self.zoom))

    def row(self) -> dict[str, float]:
        """Return a table row: shift_x_px, shift_y_px, zoom_percent, rotation_deg, n_matches."""
        return {
            "shift_x_px": round(float(self.shift_px[0]), 3) + 0.0,
            "shift_y_px": round(float(self.shift_px[1]), 3) + 0.0,
            "zoom_percent": round(100 * (self.zoom - 1), 4) + 0.0,
            "rotation_deg": round(self.rotation_deg, 4) + 0.0,
            "n_matches": self.n_matches,
        }


def unknown(n_matches: int = 0) -> Movement:
    """Return an undetermined movement."""
    return Movement(np.full(2, np.nan), np.nan, np.nan, n_matches)


def movement(reference: NDArray, other: NDArray) -> Movement:
    """Measure how a fixed camera's picture moved, from its background.

    Corners are tracked forth and back (Lucas & Kanade 1981, pyramidal) on pictures of normalised
    contrast, once from their old places and once from where ORB features predict them; the start
    with more agreeing corners counts. People and shadows are the outliers of a similarity fitted by
    RANSAC. For a camera that panned or tilted this holds near the centre only: towards the edges
    its picture moves a little more.

    Pictures are (H, W, 3) uint8, BGR, such as a camera's static picture and a frame of a take;
    ValueError if sizes differ. With fewer than `MIN_MATCHES` agreeing points the result is NaN.
    """
    if reference.shape != other.shape:
        raise ValueError(f"pictures of two sizes: {reference.shape} and {other.shape}")
    before, after = _even_contrast(reference), _even_contrast(other)
    width = before.shape[1]
    corners = cv2.goodFeaturesToTrack(before, N_CORNERS, 0.01, CELL * width)
    if corners is None:
        return unknown()
    starts = [np.eye(2, 3), *_roughly(before, after)]
    fits = [_fit(*_track(before, after, corners, start)) for start in starts]
    matrix, inliers = max(fits, key=lambda fit: len(fit[1]))
    if len(inliers) < MIN_MATCHES or inliers.std(axis=0).min() < MIN_SPREAD * min(before.shape):
        return unknown(len(inliers))
    centre = (np.array([width, before.shape[0]]) - 1) / 2
    return Movement(
        shift_px=matrix[:, :2] @ centre + matrix[:, 2] - centre,
        zoom=float(np.hypot(matrix[0, 0], matrix[1, 0])),
        rotation_deg=float(np.degrees(np.arctan2(matrix[1, 0], matrix[0, 0]))),
        n_matches=len(inliers),
    )


def _even_contrast(image: NDArray) -> NDArray:
    """Return grey values with normalised brightness and contrast, against exposure changes."""
    grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY).astype(np.float32)
    sigma = CONTRAST * grey.shape[1]
    high = grey - _blurred(grey, sigma)
    contrast = np.sqrt(_blurred(high * high, 2 * sigma))
    scaled = 128 + 40 * high / np.maximum(contrast, MIN_CONTRAST)
    return np.clip(scaled, 0, 255).round().astype(np.uint8)


def _blurred(grey: NDArray, sigma: float) -> NDArray:
    """Return nearly a Gaussian blur, at a lower resolution: a tenth of the time at 1080 lines."""
    step = max(1, int(sigma / BLUR_STEPS))
    height, width = grey.shape
    small = (-(-width // step), -(-height // step))
    reduced = cv2.resize(grey, small, interpolation=cv2.INTER_AREA)
    reduced = cv2.GaussianBlur(reduced, (0, 0), sigma / step)
    return cv2.resize(reduced, (width, height), interpolation=cv2.INTER_LINEAR)


def _roughly(before: NDArray, after: NDArray) -> list[NDArray]:
    """Return a list of the similarity that ORB features suggest; empty if there is none."""
    orb = cv2.ORB.create(N_FEATURES)
    (points, first), (others, second) = (
        orb.detectAndCompute(image, None) for image in (before, after)
    )
    if first is None or second is None:
        return []
    matches = cv2.BFMatcher(cv2.NORM_HAMMING, crossCheck=True).match(first, second)
    x_before = np.array([points[match.queryIdx].pt for match in matches], dtype=np.float32)
    x_after = np.array([others[match.trainIdx].pt for match in matches], dtype=np.float32)
    matrix, inliers = _fit(x_before, x_after, max_error_px=5.0)
    return [matrix] if len(inliers) else []


def _track(before, after, corners, start) -> tuple[NDArray, NDArray]:
    """Return (N, 2) corners and their new places, those that are found again on the way back."""
    guess = cv2.transform(corners, start).astype(np.float32)
    found, there = flow(before, after, corners, guess)
    back, again = flow(after, before, found, corners.copy())
    returned = np.linalg.norm(back - corners, axis=2)[:, 0] < MAX_RETURN_PX
    good = there & again & returned
    return corners[good, 0], found[good, 0]


def flow(
    before: NDArray,
    after: NDArray,
    corners: NDArray,
    guess: NDArray,
    *,
    levels: int = 3,
    stop: tuple[int, float] = (40, 0.003),
) -> tuple[NDArray, NDArray]:
    """Track corners by pyramidal Lucas-Kanade from guessed places; also say which are found.

    `levels` is how often the picture is halved, `stop` the most iterations and the least step, px.
    """
    found, status, _ = cv2.calcOpticalFlowPyrLK(
        before,
        after,
        corners,
        guess,
        winSize=(WINDOW_PX, WINDOW_PX),
        maxLevel=levels,
        flags=cv2.OPTFLOW_USE_INITIAL_FLOW,
        criteria=(cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, *stop),
    )
    return found, status[:, 0] > 0


def _fit(x_before, x_after, max_error_px=MAX_ERROR_PX) -> tuple[NDArray, NDArray]:
    """Fit a similarity (2, 3) by RANSAC; return it and the inliers (N, 2) before, if any."""
    nothing = np.eye(2, 3), np.empty((0, 2))
    if len(x_before) < 3:
        return nothing
    cv2.setRNGSeed(0)
    matrix, mask = cv2.estimateAffinePartial2D(
        x_before, x_after, ransacReprojThreshold=max_error_px, maxIters=5000, confidence=0.9999
    )
    return nothing if matrix is None else (matrix, x_before[mask[:, 0] > 0])


MOST_OFF_PX = 3.0  # ASSUME: of an inlier, before the lens is modelled
SCALE_PX = (0.03, 1.0)  # ASSUME: limits of a tracked corner's noise, per axis
TUKEY = 4.685  # standard deviations at which a corner's weight is 0: 95 % efficiency
N_STEPS = 8  # of reweighting
LEAST_SHARE = 0.25  # ASSUME: of the corners in the picture: fewer that agree may be a person
# Effect of the lens on the movement, k and p of `moved`: mean and standard deviation over usual
# lenses, 45 to 80 degrees across.
LENS_MEAN, LENS_SIGMA = np.array([0.0, 0.35]), np.array([0.12, 0.25])


def moved(places: NDArray, model: NDArray) -> NDArray:
    """Return how far a rotation of the camera moves each place (N, 2), in half longer sides.

    Places are from the picture's centre. The model (6,) is the shift of the centre x, y; the linear
    change a - 1 and b of the similarity [[a, -b], [b, a]]; and, for the lens, k and p: the centre's
    shift t is (1 + k r^2) t + p x (x . t) at x. A pinhole has k = 0 and p = (that half / focal
    length)^2 = p0; distortion k1 adds k1 p0 to k and 2 k1 p0 to p, to third order.
    """
    shift, (scale, turn, k, p) = model[:2], model[2:]
    x, y = places.T
    along = places @ shift
    radius2 = x * x + y * y
    return np.column_stack(
        [
            (1 + k * radius2) * shift[0] + p * x * along + scale * x - turn * y,
            (1 + k * radius2) * shift[1] + p * y * along + scale * y + turn * x,
        ]
    )


def _jacobian(places: NDArray, model: NDArray) -> NDArray:
    """Return the derivative of `moved` by the model, (N, 2, 6)."""
    shift, (k, p) = model[:2], model[4:]
    x, y = places.T
    radius2 = x * x + y * y
    along = places @ shift
    even, mixed = 1 + k * radius2, p * x * y
    rows = [
        [even + p * x * x, mixed, x, -y, radius2 * shift[0], x * along],
        [mixed, even + p * y * y, y, x, radius2 * shift[1], y * along],
    ]
    return np.array(rows).transpose(2, 0, 1)


@dataclass(frozen=True)
class Fit:
    """A movement that tracked points agree on."""

    model: NDArray  # (6,): for `moved`; NaN where too few agree
    sigma: float  # standard deviation of the shift per axis, in half longer sides; NaN as `model`
    n_matches: int  # points that agree

    @property
    def known(self) -> bool:
        """Whether enough points agree."""
        return bool(np.isfinite(self.sigma))


def unknown_turn(n_matches: int = 0) -> Fit:
    """Return an undetermined fit."""
    return Fit(np.full(6, np.nan), np.nan, n_matches)


def fit_turn(places: NDArray, moved_px: NDArray, shape: tuple[int, ...], n_corners: int) -> Fit:
    """Find the movement that tracked points agree on.

    Points were at `places` (N, 2) from the picture's centre, in half longer sides, and moved by
    `moved_px` (N, 2); `shape` is height and width of the picture, px, and `n_corners` the number of
    corners searched. The fit is unknown if fewer than `MIN_MATCHES` points or a quarter of those
    searched agree, or if those do not spread over the picture. A similarity by RANSAC (Fischler &
    Bolles 1981) is the start of weighted least squares with Tukey's weights.
    """
    if len(places) < MIN_MATCHES:
        return unknown_turn()
    half = max(shape) / 2
    places_px = (places * half).astype(np.float32)
    cv2.setRNGSeed(0)
    matrix, mask = cv2.estimateAffinePartial2D(
        places_px,
        places_px + moved_px.astype(np.float32),
        ransacReprojThreshold=MOST_OFF_PX,
        maxIters=500,
        refineIters=2,
    )
    if matrix is None:
        return unknown_turn()
    start = np.r_[matrix[:, 2] / half, matrix[0, 0] - 1, matrix[1, 0], LENS_MEAN]
    limits = np.array(SCALE_PX) / half
    model, sigma, inliers = _refine(places, moved_px / half, start, mask[:, 0] > 0, limits)
    n_matches = int(inliers.sum())
    enough = max(MIN_MATCHES, LEAST_SHARE * n_corners)
    least_spread = MIN_SPREAD * min(shape) / half
    if n_matches < enough or places[inliers].std(axis=0).min() < least_spread:
        return unknown_turn(n_matches)
    return Fit(model, float(sigma), n_matches)


def _refine(places, tracked, model, inliers, scale_limits) -> tuple[NDArray, float, NDArray]:
    """Refine a fit by iterated weights; return model, sigma of the shift per axis, inliers (N,)."""
    scale = scale_limits[1]
    weights = inliers.astype(float)
    for _ in range(N_STEPS):
        jacobian = _jacobian(places, model)
        residuals = tracked - moved(places, model)
        normal = np.einsum("nai,n,naj->ij", jacobian, weights, jacobian, optimize=True) / scale**2
        gradient = np.einsum("nai,n,na->i", jacobian, weights, residuals, optimize=True) / scale**2
        normal[[4, 5], [4, 5]] += LENS_SIGMA**-2.0
        gradient[4:] += (LENS_MEAN - model[4:]) / LENS_SIGMA**2
        model = model + np.linalg.solve(normal + 1e-9 * np.eye(6), gradient)
        off = tracked - moved(places, model)
        distance = np.hypot(*off.T)
        near = distance < TUKEY * scale
        if near.any():
            scale = np.clip(1.4826 * np.median(np.abs(off[near])), *scale_limits)
        weights = np.clip(1 - (distance / (TUKEY * scale)) ** 2, 0, None) ** 2
    covariance = np.linalg.inv(normal + 1e-9 * np.eye(6))
    return model, np.sqrt(np.trace(covariance[:2, :2]) / 2), weights > 0
