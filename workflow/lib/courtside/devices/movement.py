"""How far a fixed camera's picture moved between two pictures, measured on its background."""

from dataclasses import dataclass

import cv2
import numpy as np

N_FEATURES = 4000  # ORB features that find a large movement
N_CORNERS = 600  # corners that measure it
CELL = 0.02  # fewest picture widths between two corners: people get no more than their area
CONTRAST = 0.01  # picture widths: brightness and contrast are evened out at this scale
MIN_CONTRAST = 4.0  # grey levels; flatter surroundings are not stretched further
WINDOW_PX = 21  # of a tracked corner
MAX_RETURN_PX = 0.2  # a corner tracked there and back must come this close
MAX_ERROR_PX = 1.0  # of an inlier
MIN_MATCHES = 20  # inliers below which nothing is said
MIN_SPREAD = 0.1  # of the shorter side: standard deviation of the inliers' places, at least


@dataclass(frozen=True)
class Movement:
    """How a fixed camera's picture moved between two pictures, as a similarity about its centre.

    Attributes
    ----------
    shift_px : (2,) float
        Where the content of the picture's centre went: right, down; pixels.
    zoom : float
        Scale of the other picture over the reference; 1 for none.
    rotation_deg : float
        Clockwise turn of the content, as seen on the picture.
    n_matches : int
        Background points that agree. Below `MIN_MATCHES`, or where they do not spread over the picture,
        the rest is NaN: nothing can be said.
    """

    shift_px: np.ndarray
    zoom: float
    rotation_deg: float
    n_matches: int

    @property
    def known(self):
        """Whether enough points agree to tell."""
        return bool(np.isfinite(self.zoom))

    def row(self):
        """Return it as a row of a table: dict of shift_x_px, shift_y_px, zoom_percent, and so on."""
        return {
            "shift_x_px": round(float(self.shift_px[0]), 3) + 0.0,
            "shift_y_px": round(float(self.shift_px[1]), 3) + 0.0,
            "zoom_percent": round(100 * (self.zoom - 1), 4) + 0.0,
            "rotation_deg": round(self.rotation_deg, 4) + 0.0,
            "n_matches": self.n_matches,
        }


def unknown(n_matches=0):
    """Return the movement of which nothing can be said."""
    return Movement(np.full(2, np.nan), np.nan, np.nan, n_matches)


def movement(reference, other, *, min_matches=MIN_MATCHES):
    """Measure how a fixed camera's picture moved, from its background.

    Parameters
    ----------
    reference, other : (H, W, 3) uint8
        Two pictures of one size, BGR, such as a camera's static picture and a frame of a take.
    min_matches : int
        Fewest agreeing background points.

    Returns
    -------
    movement : Movement
        From reference to other; NaN where too few points agree.

    Raises
    ------
    ValueError
        If the pictures differ in size.

    Notes
    -----
    Corners are tracked there and back (Lucas & Kanade 1981, pyramidal) on pictures of evened contrast, once
    from where they were and once from where ORB features place them; the start with more agreeing corners
    counts. People and shadows are the outliers of a similarity fitted by RANSAC. A camera that panned or
    tilted is described near the centre only: towards the edges its picture moves a little more.
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
    if len(inliers) < min_matches or inliers.std(axis=0).min() < MIN_SPREAD * min(before.shape):
        return unknown(len(inliers))
    centre = (np.array([width, before.shape[0]]) - 1) / 2
    return Movement(
        shift_px=matrix[:, :2] @ centre + matrix[:, 2] - centre,
        zoom=float(np.hypot(matrix[0, 0], matrix[1, 0])),
        rotation_deg=float(np.degrees(np.arctan2(matrix[1, 0], matrix[0, 0]))),
        n_matches=len(inliers),
    )


def _even_contrast(image):
    """Return grey values with brightness and contrast evened out, so that exposure does not matter."""
    grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY).astype(np.float32)
    sigma = CONTRAST * grey.shape[1]
    high = grey - cv2.GaussianBlur(grey, (0, 0), sigma)
    contrast = np.sqrt(cv2.GaussianBlur(high * high, (0, 0), 2 * sigma))
    scaled = 128 + 40 * high / np.maximum(contrast, MIN_CONTRAST)
    return np.clip(scaled, 0, 255).round().astype(np.uint8)


def _roughly(before, after):
    """Return the similarity that ORB features suggest, in a list; an empty one without."""
    orb = cv2.ORB_create(N_FEATURES)
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


def _track(before, after, corners, start):
    """Return (N, 2) corners and where they went, those that are found again on the way back."""
    guess = cv2.transform(corners, start).astype(np.float32)
    options = {
        "winSize": (WINDOW_PX, WINDOW_PX),
        "maxLevel": 3,
        "flags": cv2.OPTFLOW_USE_INITIAL_FLOW,
        "criteria": (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 40, 0.003),
    }
    found, there, _ = cv2.calcOpticalFlowPyrLK(before, after, corners, guess, **options)
    back, again, _ = cv2.calcOpticalFlowPyrLK(after, before, found, corners.copy(), **options)
    returned = np.linalg.norm(back - corners, axis=2)[:, 0] < MAX_RETURN_PX
    good = (there[:, 0] > 0) & (again[:, 0] > 0) & returned
    return corners[good, 0], found[good, 0]


def _fit(x_before, x_after, max_error_px=MAX_ERROR_PX):
    """Fit a similarity by RANSAC; return it (2, 3) and the inliers (N, 2) before, none where it fails."""
    nothing = np.eye(2, 3), np.empty((0, 2))
    if len(x_before) < 3:
        return nothing
    cv2.setRNGSeed(0)
    matrix, mask = cv2.estimateAffinePartial2D(
        x_before, x_after, ransacReprojThreshold=max_error_px, maxIters=5000, confidence=0.9999
    )
    return nothing if matrix is None else (matrix, x_before[mask[:, 0] > 0])
