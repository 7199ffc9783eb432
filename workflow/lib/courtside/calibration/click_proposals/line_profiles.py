"""Painted lines in a picture: brightness across a line where a camera expects it."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.line_edges import Paint
from courtside.geometry.camera import Camera, project

STEP_PX = 0.25  # ASSUME: of profiles across a line
FINE = 5  # ASSUME: steps of the expected paint within one of those
MARGIN_PX = 4.0  # ASSUME: of floor beside a line's edges that is compared too
MOST_SAMPLES = 90  # ASSUME: more take longer and share their pixels' errors
LEAST_SAMPLES = 6  # ASSUME: fewer do not separate a shift from a slope


@dataclass(frozen=True, eq=False)
class Stretch:
    """Measured and expected brightness across a stretch of a line."""

    xy: NDArray  # (N, 2): where the line's middle is expected, px
    normal: NDArray  # (N, 2): unit, across the line, towards its edge of the higher coordinate
    along_px: NDArray  # (N,): along the line in the picture, 0 at the origin asked for
    width_px: float  # of the line, expected
    seen: NDArray  # (N, S): brightness at steps of `STEP_PX` across, about the expected line
    paint: NDArray  # (N, T): share of paint expected, 0..1, at the T middle ones of these steps


def sample_stretch(
    grey: NDArray,
    camera: Camera,
    ends_m: NDArray,
    origin_m: NDArray,
    half_width_m: NDArray,
    paint: Paint,
    reach_px: float,
    blur_px: float,
) -> Stretch | None:
    """Sample a picture across a stretch of a line; None if too little of it is in the picture.

    None, too, if the lens model does not reach the stretch or its origin.

    The true line may be up to `reach_px` from the expected one. The ends (2, 3) of the stretch are
    on the line's middle; the shift is measured at the origin (3,), on the same straight line.
    `half_width_m` (3,) leads from the middle to the edge of the higher coordinate; `blur_px` is the
    standard deviation of the picture's blur.
    """
    xyz = ends_m[0] + np.linspace(0, 1, 400)[:, np.newaxis] * (ends_m[1] - ends_m[0])
    xy = project(camera, xyz)
    room = np.minimum(reach_px + MARGIN_PX, 12.0)
    inside = ((xy > room) & (xy < np.array(camera.size) - 1 - room)).all(axis=1)
    if inside.sum() < 2:
        return None
    xyz, xy = xyz[inside], xy[inside]
    travelled = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(xy, axis=0), axis=1))])
    n = int(min(MOST_SAMPLES, travelled[-1]))
    if n < LEAST_SAMPLES:
        return None
    at = np.linspace(0, travelled[-1], n + 1)[:-1] + travelled[-1] / n / 2
    xyz = np.column_stack([np.interp(at, travelled, column) for column in xyz.T])
    xy = project(camera, xyz)
    tangent, normal = tangent_and_normal(camera, xyz, ends_m[1] - ends_m[0], half_width_m)
    across = project(camera, xyz + half_width_m) - project(camera, xyz - half_width_m)
    width_px = float(np.median(np.sum(across * normal, axis=1)))
    about = np.median(tangent, axis=0)
    along = (xy - project(camera, origin_m)) @ (about / np.linalg.norm(about))
    if not np.isfinite([width_px, *along, *normal.ravel()]).all():
        return None
    half = int(np.ceil((width_px / 2 + MARGIN_PX) / STEP_PX))
    wide = half + int(np.ceil(reach_px / STEP_PX))
    steps = np.arange(-wide, wide + 1)[:, np.newaxis] * STEP_PX
    places = (xy[:, np.newaxis] + normal[:, np.newaxis] * steps).astype(np.float32)
    seen = cv2.remap(
        grey, places[..., 0], places[..., 1], cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE
    )
    expected = _expected(paint, xy, normal, half, blur_px)
    return Stretch(xy, normal, along, width_px, seen.astype(float), expected)


def tangent_and_normal(
    camera: Camera, xyz: NDArray, along_m: NDArray, across_m: NDArray
) -> tuple[NDArray, NDArray]:
    """Return unit vectors (N, 2) in the picture along a line at points on it, and normal to it.

    The points `xyz` (N, 3) m lie on the line; `across_m` (3,) points to the side of the normals.
    """
    small = 1e-3 / np.linalg.norm(along_m, axis=-1, keepdims=True)
    middle = project(camera, xyz)
    tangent = project(camera, xyz + small * along_m) - middle
    tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
    normal = np.stack([-tangent[..., 1], tangent[..., 0]], axis=-1)
    towards = project(camera, xyz + across_m) - middle
    return tangent, normal * np.sign(np.sum(towards * normal, axis=-1, keepdims=True))


def _expected(paint: Paint, xy: NDArray, normal: NDArray, half: int, blur_px: float) -> NDArray:
    """Return the blurred share of paint across the line, (N, 2 * half + 1)."""
    room = int(np.ceil(3 * blur_px / STEP_PX))
    knots = np.arange(-(half + room), half + room + FINE, FINE) * STEP_PX
    places = paint.place(xy[:, np.newaxis] + normal[:, np.newaxis] * knots[:, np.newaxis])
    share = np.arange(FINE * FINE)[:, np.newaxis] / FINE**2  # knots are near: linear between them
    between = places[:, :-1, np.newaxis] * (1 - share) + places[:, 1:, np.newaxis] * share
    there = paint.shows(between.reshape(len(xy), -1, 2)).astype(float)
    offsets = np.arange(-room * FINE, room * FINE + 1) * STEP_PX / FINE
    kernel = np.exp(-0.5 * (offsets / blur_px) ** 2)
    blurred = cv2.filter2D(there, -1, kernel[np.newaxis] / kernel.sum())
    first = room * FINE
    return blurred[:, first : first + 2 * half * FINE + 1 : FINE]
