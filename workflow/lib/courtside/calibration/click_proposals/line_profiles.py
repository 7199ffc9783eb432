"""Painted lines in a picture: what is seen across a line where a camera expects it."""

from dataclasses import dataclass

import cv2
import numpy as np

from courtside.geometry import camera as projection

STEP_PX = 0.25  # of profiles across a line
FINE = 5  # steps of the expected paint within one of those
MARGIN_PX = 4.0  # of floor beside a line's edges that is compared too
MOST_SAMPLES = 90
LEAST_SAMPLES = 6


@dataclass(frozen=True, eq=False)
class Stretch:
    """What is seen across a stretch of a line, and what was expected.

    Attributes
    ----------
    xy : (N, 2) float
        Where the line's middle is expected, px.
    normal : (N, 2) float
        Across the line in the picture, unit length, towards its edge of the higher coordinate.
    along_px : (N,) float
        Along the line in the picture, 0 at the origin asked for.
    width_px : float
        Of the line, expected.
    seen : (N, S) float
        Brightness at steps of `STEP_PX` across, the middle one where the line is expected.
    paint : (N, T) float
        Share of paint expected there, 0..1, at the T middle ones of these steps.
    """

    xy: np.ndarray
    normal: np.ndarray
    along_px: np.ndarray
    width_px: float
    seen: np.ndarray
    paint: np.ndarray


def look(grey, camera, ends_m, origin_m, half_width_m, paint, reach_px, blur_px):
    """Sample a picture across a stretch of a line.

    Parameters
    ----------
    grey : (H, W) float32
    camera : courtside.geometry.camera.Camera
        Expects the line.
    ends_m : (2, 3) float
        Of the stretch, on the line's middle; world, metres.
    origin_m : (3,) float
        On the same straight line, where shifts are wanted.
    half_width_m : (3,) float
        From the line's middle to its edge of the higher coordinate.
    paint : courtside.calibration.court.line_edges.Paint
        Expected by the camera.
    reach_px : float
        How far off the line may be.
    blur_px : float
        Of the picture, standard deviation.

    Returns
    -------
    stretch : Stretch or None
        None where too little of it is in the picture.
    """
    xyz = ends_m[0] + np.linspace(0, 1, 400)[:, np.newaxis] * (ends_m[1] - ends_m[0])
    xy = projection.project(camera, xyz)
    inside = _inside(xy, camera.size, reach_px + MARGIN_PX)
    if inside.sum() < 2:
        return None
    xyz, xy = xyz[inside], xy[inside]
    travelled = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(xy, axis=0), axis=1))])
    n = int(min(MOST_SAMPLES, travelled[-1]))
    if n < LEAST_SAMPLES:
        return None
    at = np.linspace(0, travelled[-1], n + 1)[:-1] + travelled[-1] / n / 2
    xyz = np.column_stack([np.interp(at, travelled, column) for column in xyz.T])
    return _sample(grey, camera, xyz, origin_m, ends_m, half_width_m, paint, reach_px, blur_px)


def _sample(grey, camera, xyz, origin_m, ends_m, half_width_m, paint, reach_px, blur_px):
    xy = projection.project(camera, xyz)
    tangent, normal = axes(camera, xyz, ends_m[1] - ends_m[0], half_width_m)
    across = projection.project(camera, xyz + half_width_m) - projection.project(
        camera, xyz - half_width_m
    )
    width_px = float(np.median(np.sum(across * normal, axis=1)))
    about = np.median(tangent, axis=0)
    along = (xy - projection.project(camera, origin_m)) @ (about / np.linalg.norm(about))
    half = int(np.ceil((width_px / 2 + MARGIN_PX) / STEP_PX))
    wide = half + int(np.ceil(reach_px / STEP_PX))
    places = xy[:, np.newaxis] + normal[:, np.newaxis] * (
        np.arange(-wide, wide + 1)[:, np.newaxis] * STEP_PX
    )
    places = places.astype(np.float32)
    seen = cv2.remap(
        grey, places[..., 0], places[..., 1], cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE
    )
    expected = _expected(paint, xy, normal, half, blur_px)
    return Stretch(xy, normal, along, width_px, seen.astype(float), expected)


def axes(camera, xyz, along_m, across_m):
    """Return unit vectors in the picture along a line at points on it, and normal to it.

    Parameters
    ----------
    camera : courtside.geometry.camera.Camera
    xyz : (N, 3) float
        On the line, metres.
    along_m, across_m : (3,) float
        Along the line, and to the side to which the normals point.

    Returns
    -------
    tangent, normal : (N, 2) float
    """
    small = 1e-3 / np.linalg.norm(along_m, axis=-1, keepdims=True)
    middle = projection.project(camera, xyz)
    tangent = projection.project(camera, xyz + small * along_m) - middle
    tangent /= np.linalg.norm(tangent, axis=-1, keepdims=True)
    normal = np.stack([-tangent[..., 1], tangent[..., 0]], axis=-1)
    towards = projection.project(camera, xyz + across_m) - middle
    return tangent, normal * np.sign(np.sum(towards * normal, axis=-1, keepdims=True))


def _inside(xy, size, margin_px):
    room = np.minimum(margin_px, 12.0)
    return ((xy > room) & (xy < np.array(size) - 1 - room)).all(axis=1)


def _expected(paint, xy, normal, half, blur_px):
    """Return the blurred share of paint across the line, (N, 2 * half + 1)."""
    room = int(np.ceil(3 * blur_px / STEP_PX))
    knots = np.arange(-(half + room), half + room + FINE, FINE) * STEP_PX
    places = paint.place(xy[:, np.newaxis] + normal[:, np.newaxis] * knots[:, np.newaxis])
    share = (
        np.arange(FINE * FINE)[:, np.newaxis] / FINE**2
    )  # straight between knots, which are near
    between = places[:, :-1, np.newaxis] * (1 - share) + places[:, 1:, np.newaxis] * share
    there = paint.shows(between.reshape(len(xy), -1, 2)).astype(float)
    offsets = np.arange(-room * FINE, room * FINE + 1) * STEP_PX / FINE
    kernel = np.exp(-0.5 * (offsets / blur_px) ** 2)
    blurred = cv2.filter2D(there, -1, kernel[np.newaxis] / kernel.sum())
    first = room * FINE
    return blurred[:, first : first + 2 * half * FINE + 1 : FINE]
