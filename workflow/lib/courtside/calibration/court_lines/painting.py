"""The paint of a whole court as a camera expects it, compared with a picture pixel by pixel."""

import itertools
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.calibration.court_lines.ridges import FLOOR_PX
from courtside.calibration.court_lines.views import Views

# ASSUME: all of these are tuned by hand on development sessions.
BLUR_PX = 0.75  # of pictures, standard deviation
SATURATION = 0.06  # share of a pixel covered by paint at which the clipped picture saturates
PIECE_M = 0.5  # of line drawn as one straight-sided piece: lenses bend lines
FINE = 3, 12  # the drawing's pixels in one of the picture, across and down: flat lines are thinnest
TALL_PX, TALL_FINE = 200, (2, 3)  # taller areas are drawn less finely: their lines are thicker
MARGIN_PX = 16  # of floor around the court
LEAST_AREA_PX = 60, 12  # width and height of an area in which a court can be recognised
OUTSIDE_PX = 100  # pieces farther out of the picture are left out
BITS = 4  # of sub-pixel precision of what is drawn
MEASURED = 5.0  # standard deviations of its contrast by which a line should stand out


@dataclass(frozen=True, eq=False)
class Area:
    """An upright rectangle of pixels of a picture."""

    x: int
    y: int
    width: int
    height: int

    def of(self, picture: NDArray) -> NDArray:
        """Return these pixels of a picture (H, W)."""
        return picture[self.y : self.y + self.height, self.x : self.x + self.width]


@dataclass(frozen=True, eq=False)
class Pattern:
    """A court's painted lines, cut into pieces."""

    corners: NDArray  # (N, 4, 2): of each piece, m
    line: NDArray  # (N,) int: row of the court's `lines_m`

    @classmethod
    def of(cls, court: Court) -> "Pattern":
        """Cut a court's lines into pieces."""
        corners, line = [], []
        for row, (low, high) in enumerate(zip(*court.line_corners(), strict=True)):
            along = int(np.argmax(high - low))
            n = max(1, int(np.ceil((high - low)[along] / PIECE_M)))
            cuts = np.linspace(low[along], high[along], n + 1)
            for start, end in itertools.pairwise(cuts):
                first, last = low.copy(), high.copy()
                first[along], last[along] = start, end
                corners.append([first, [last[0], first[1]], last, [first[0], last[1]]])
                line.append(row)
        return cls(np.array(corners), np.array(line))

    def project(self, view: Views) -> NDArray:
        """Return the pieces' corners (N, 4, 2) in the picture of `Views` of one, px."""
        return view.project(self.corners.reshape(-1, 2))[0].reshape(-1, 4, 2)


def area(pattern: Pattern, view: Views, size: tuple[int, int]) -> Area | None:
    """Return the part (width, height) px of a picture that shows a court; None if too little."""
    low, high = -OUTSIDE_PX, np.array(size) + OUTSIDE_PX
    shown = pattern.project(view)
    shown = shown[((shown > low) & (shown < high)).all(axis=(1, 2))]
    if not len(shown):
        return None
    first = np.maximum(np.floor(shown.min(axis=(0, 1))) - MARGIN_PX, 0).astype(int)
    last = np.minimum(np.ceil(shown.max(axis=(0, 1))) + MARGIN_PX, np.array(size) - 1).astype(int)
    width, height = (last - first + 1).tolist()
    if width < LEAST_AREA_PX[0] or height < LEAST_AREA_PX[1]:
        return None
    return Area(int(first[0]), int(first[1]), width, height)


def expected(
    pattern: Pattern, view: Views, where: Area, blur_px: float = 0.0, line: int | None = None
) -> NDArray:
    """Return the contrast (h, w) of a court's paint that `Views` of one expect in an area.

    The share of each pixel that is covered by paint is computed from a fine drawing, blurred and
    reduced to thin structures as in `ridges.contrast`. The scale is arbitrary. `line` is one row of
    the court's `lines_m`; otherwise all are drawn.
    """
    corners = pattern.project(view)
    if line is not None:
        corners = corners[pattern.line == line]
    near = np.isfinite(corners).all(axis=(1, 2))
    near &= (corners > (where.x - OUTSIDE_PX, where.y - OUTSIDE_PX)).all(axis=(1, 2))
    far = where.x + where.width + OUTSIDE_PX, where.y + where.height + OUTSIDE_PX
    near &= (corners < far).all(axis=(1, 2))
    fine = np.array(FINE if where.height < TALL_PX else TALL_FINE)
    canvas = np.zeros((where.height * fine[1], where.width * fine[0]), np.uint8)
    places = ((corners[near] - (where.x, where.y) + 0.5) * fine - 0.5) * 2**BITS
    for piece in np.round(places).astype(np.int32):
        cv2.fillConvexPoly(canvas, piece, 255, shift=BITS)
    paint = cv2.resize(canvas, (where.width, where.height), interpolation=cv2.INTER_AREA)
    paint = cv2.GaussianBlur(paint.astype(np.float32) / 255, (0, 0), BLUR_PX)
    paint -= cv2.GaussianBlur(paint, (0, 0), FLOOR_PX)
    paint = SATURATION * np.tanh(paint / SATURATION)
    return cv2.GaussianBlur(paint, (0, 0), blur_px) if blur_px else paint


def match(pattern: Pattern, picture: NDArray, view: Views, blur_px: float = 0.0) -> float:
    """Return how well a camera explains the contrast (H, W) of a picture.

    It is the sum of the picture weighted by the expected paint, in standard deviations for a
    picture of independent noise. Pictures are not: other things reach more than that.
    """
    where = area(pattern, view, picture.shape[::-1])
    if where is None:
        return 0.0
    paint = expected(pattern, view, where, blur_px)
    return float(np.sum(paint * where.of(picture)) / max(np.sqrt(np.sum(paint**2)), 1e-9))


def of_lines(pattern: Pattern, picture: NDArray, view: Views) -> NDArray:
    """Return the contrast of each line of a court relative to that of all, (L,).

    The lines' contrasts are estimated together, because neighbours may be nearer than the blur.
    NaN where the picture cannot tell: out of view, hidden in the noise, or not separable.
    """
    n = int(pattern.line.max()) + 1
    where = area(pattern, view, picture.shape[::-1])
    if where is None:
        return np.full(n, np.nan)
    paint = np.stack([expected(pattern, view, where, line=row).ravel() for row in range(n)])
    seen = where.of(picture).ravel()
    normal, right = paint @ paint.T, paint @ seen
    together = right.sum() / max(normal.sum(), 1e-9)
    known = np.diag(normal) > 1e-6
    inverse = np.linalg.pinv(normal[np.ix_(known, known)])
    found, sigma = np.zeros(n), np.full(n, np.inf)
    found[known] = inverse @ right[known]
    sigma[known] = np.sqrt(np.mean(seen**2) * np.diag(inverse))
    with np.errstate(invalid="ignore"):
        return np.where(together > MEASURED * sigma, found / together, np.nan)
