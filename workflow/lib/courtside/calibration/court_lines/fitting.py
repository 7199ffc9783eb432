"""A camera fitted to a picture by the paint of the whole court, pixel by pixel."""

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.calibration.click_proposals import proposals
from courtside.calibration.click_proposals.view import View
from courtside.calibration.court_lines import painting, views
from courtside.calibration.court_lines.painting import Pattern
from courtside.calibration.court_lines.views import Views
from courtside.geometry import rotations

# ASSUME: all of these are tuned by hand on development sessions.
# Blur of picture and paint, px; the search by shifts of the picture, px across and down.
LEVELS = ((2.0, (16, 10)), (1.0, (4, 3)), (0.0, (2, 2)))
ROUNDS = 6  # linearisations on each level
LEAST_GAIN = 1.001  # of the match in one of them
# Standard deviations by which one linearisation may move: rad, m, ln f, k1; and the most.
SIGMA = np.array([0.01] * 3 + [0.5] * 3 + [0.05, 0.03])
MOST = np.array([0.01] * 3 + [0.6] * 3 + [0.06, 0.04])
SMALL = np.array([2e-4] * 3 + [0.02] * 3 + [2e-3, 2e-3])  # of differences
STEPS = (1.0, 0.4, 0.15)  # of a linearisation's solution that are tried
SEARCH_WIDTHS = 0.006  # of the picture: search for each stretch of a line


@dataclass(frozen=True, eq=False)
class Fitted:
    """A camera (`Views` of one) and how well it explains a picture, as `painting.match`."""

    view: Views
    match: float


def blurred(picture: NDArray) -> list[NDArray]:
    """Return the contrast (H, W) of a picture on each level of the search."""
    return [cv2.GaussianBlur(picture, (0, 0), blur) if blur else picture for blur, _ in LEVELS]


def fit(pattern: Pattern, pictures: list[NDArray], view: Views, first: int = 0) -> Fitted | None:
    """Fit a camera to a picture from `blurred`; None where too little of the court is in view.

    From a blurred to the sharp picture, the camera is turned by the best shift in the picture and
    then adjusted by Gauss-Newton: rotation, place, focal length and k1. `first` is the level to
    start with.
    """
    found = Fitted(view, 0.0)
    for level in range(first, len(LEVELS)):
        turned = shifted(pattern, pictures, found.view, level)
        if turned is None:
            return None
        found = _adjusted(pattern, pictures[level], turned, LEVELS[level][0])
    return found


def fit_again(pattern: Pattern, pictures: list[NDArray], view: Views, seen: View) -> Fitted | None:
    """Fit a camera again after each stretch of a line was searched for separately.

    Where lines are nearly parallel in the picture, `fit` ends at a wrong distance. Stretches of
    lines, each measured across the line, lead away from there. `seen` is the picture, of which the
    camera is not used. None where too few stretches are seen.
    """
    camera = views.to_camera(view, "", seen.camera.size)
    start = replace(seen, camera=camera)
    found, reason = proposals.register(start, SEARCH_WIDTHS * camera.size[0])
    if reason:
        return None
    pose, k1 = found.camera.cam_from_world[None, :, :3], found.camera.dist[:1]
    centre, f_px = found.camera.centre_in_world[None], found.camera.K[:1, 0]
    return fit(pattern, pictures, Views(pose, centre, f_px, k1, view.principal), 1)


def shifted(pattern: Pattern, pictures: list[NDArray], view: Views, level: int) -> Fitted | None:
    """Turn a camera by the shift in the picture at which the court's paint matches best."""
    (blur_px, (right, down)), picture = LEVELS[level], pictures[level]
    where = painting.area(pattern, view, picture.shape[::-1])
    if where is None:
        return None
    paint = painting.expected(pattern, view, where, blur_px)
    size = float(np.sqrt(np.sum(paint**2)))
    if size < 1e-6:
        return None
    wide = cv2.copyMakeBorder(picture, down, down, right, right, cv2.BORDER_CONSTANT, value=0)
    around = replace(where, width=where.width + 2 * right, height=where.height + 2 * down)
    matches = cv2.matchTemplate(around.of(wide), paint, cv2.TM_CCORR) / size
    row, column = np.unravel_index(int(matches.argmax()), matches.shape)
    turn = np.array([down - row, column - right, 0.0]) / view.f_px[0]
    rotation = rotations.rotation_from_rodrigues(turn) @ view.rotation[0]
    return Fitted(replace(view, rotation=rotation[None]), float(matches.max()))


def _moved(view: Views, change: NDArray) -> Views:
    """Return a camera turned (rad, own axes), moved (m), zoomed (ln), with another k1."""
    turn = rotations.rotation_from_rodrigues(change[:3])
    return Views(
        (turn @ view.rotation[0])[None],
        view.centre + change[3:6],
        view.f_px * np.exp(change[6]),
        view.k1 + change[7],
        view.principal,
    )


def _adjusted(pattern: Pattern, picture: NDArray, start: Fitted, blur_px: float) -> Fitted:
    """Adjust a camera to the picture of one level; the start where that does not help."""
    best = Fitted(start.view, painting.match(pattern, picture, start.view, blur_px))
    for _ in range(ROUNDS):
        change = _change(pattern, picture, best.view, blur_px)
        if change is None:
            break
        tried = [_moved(best.view, step * change) for step in STEPS]
        found = [painting.match(pattern, picture, view, blur_px) for view in tried]
        first = int(np.argmax(found))
        if found[first] < LEAST_GAIN * best.match:
            break
        best = Fitted(tried[first], found[first])
    return best


def _change(pattern: Pattern, picture: NDArray, view: Views, blur_px: float) -> NDArray | None:
    """Return the change (8,) of a camera after which paint and picture differ least, linearised."""
    where = painting.area(pattern, view, picture.shape[::-1])
    if where is None:
        return None
    seen = where.of(picture).ravel()
    paint = painting.expected(pattern, view, where, blur_px).ravel()
    contrast = float(paint @ seen) / max(float(paint @ paint), 1e-9)
    if contrast <= 0:
        return None
    columns = [paint]
    for axis, small in enumerate(SMALL):
        moved = _moved(view, small * np.eye(len(SMALL))[axis])
        other = painting.expected(pattern, moved, where, blur_px).ravel()
        columns.append(contrast * (other - paint) / small)
    design = np.stack(columns, axis=1)
    normal = (design.T @ design).astype(float)
    # Neighbouring pixels of a blurred picture share their noise.
    noise = max(float(np.mean((seen - contrast * paint) ** 2)), 1e-3) * (1 + 4 * np.pi * blur_px**2)
    normal[range(1, 9), range(1, 9)] += noise / SIGMA**2
    change = np.linalg.solve(normal + 1e-9 * np.eye(9), design.T @ seen)[1:]
    return change * min(1.0, 1.0 / float(np.max(np.abs(change) / MOST)))
