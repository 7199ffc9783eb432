"""Posts of a net in a picture: their axes and upper ends."""

from collections.abc import Sequence

import cv2
import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from courtside.calibration.click_proposals.view import NO_PLACE, Ray, View
from courtside.calibration.court.court import Court
from courtside.calibration.court.line_edges import Paint
from courtside.geometry.camera import Camera, project

# ASSUME: a post is 4 cm wide; the rest is tuned by hand on the virtual sessions.
WIDTH_M = 0.04
LOWER, UPPER = (0.04, 0.6), (0.4, 0.985)  # parts of a post's height that give its foot and its tip
SEARCH_PX = 3.0  # across the axis
LEAST_SCORE, LEAST_SHARE = 0.3, 0.4  # from which an axis is reliable
OWN_PX = 0.15  # error of an axis that is not in the fit of its profiles
END_SEARCH = 0.008  # of the picture's longer side: lines on the floor determine heights badly
END_PX = 10.0  # of the axis beyond that, on each side
END_STEP_PX = 0.2
BESIDE_PX = (1.5, 3.5)  # of background beside the post
LEAST_FIT = 0.6  # share of the variance along the axis that an end must explain
MOST_BEYOND = 0.35  # of the post's contrast may remain beyond its end
COVERED_PX = 1.5  # nearer to the other post, a post is covered
APART_PX = 6.0  # ends of both posts nearer to each other cannot be separated


def axis(view: View, post: int) -> Ray | None:
    """Return the axis of a post (0 or 1, as in the court's net) near its foot, None if unseen."""
    return None if _covered(view, post, 0.0) else _axis(view, post, LOWER, 0.0)


def tip(view: View, post: int) -> tuple[NDArray, NDArray, float, str]:
    """Find the upper end of a post: (2,) px, covariance (2, 2), share that is seen, and reason.

    The reason is empty, or says why there is none; then px and covariance are NaN, the share 0.
    """
    ends = project(view.camera, _places(view.court, [0, 1], 1.0))
    if np.linalg.norm(ends[1] - ends[0]) < APART_PX or _covered(view, post, 1.0):
        return *NO_PLACE, "one post is behind the other"
    ray = _axis(view, post, UPPER, 1.0)
    if ray is None:
        return *NO_PLACE, "the post is not seen"
    found = _end(view, post, ray)
    if found is None:
        return *NO_PLACE, "the post's end is not seen"
    along, sigma = found
    turn = np.array([[ray.direction[0], -ray.direction[1]], [ray.direction[1], ray.direction[0]]])
    covariance = turn @ np.diag([sigma**2, ray.sigma_px**2]) @ turn.T
    return ray.start + along * ray.direction, covariance, ray.share, ""


def _places(court: Court, post: int | Sequence[int], share: ArrayLike) -> NDArray:
    """Return places on a post's axis at shares of its height, (..., 3) m."""
    net: dict = court.net or {}  # `line_edges.post` finds none without a net
    x, height = np.array(net["x_m"])[post], np.asarray(share) * net["post_height_m"]
    return np.stack(np.broadcast_arrays(x, net["y_m"], height), axis=-1)


def _half_width(view: View, post: int) -> NDArray:
    """Return half a post's width as a vector across the view, (3,) m."""
    away = _places(view.court, post, 0.0) - view.camera.centre_in_world
    across = np.cross([0, 0, 1.0], away)
    return across / np.linalg.norm(across) * WIDTH_M / 2


def _axis(view: View, post: int, part: ArrayLike, share: float) -> Ray | None:
    places, origin = _places(view.court, post, part), _places(view.court, post, share)
    half = _half_width(view, post)
    shown = _shows(view.camera, _places(view.court, post, [0.0, 1.0]), half)
    shift = view.measure(shown, places, origin, half, SEARCH_PX, polarity=0)
    if not shift or shift.score < LEAST_SCORE or shift.share < LEAST_SHARE:
        return None
    moved_px = (shift.low_px + shift.high_px) / 2
    line = view.ray(origin, origin, places[1] - places[0], half, moved_px, shift.slope)
    return Ray(*line, np.hypot(shift.sigma_px, OWN_PX), shift.share)


def _shows(camera: Camera, ends: NDArray, half: NDArray) -> Paint:
    """Return the post as what is expected in the picture; places are px."""
    low, high = project(camera, ends)
    reach = np.linalg.norm(project(camera, ends + half) - (low, high), axis=1)
    length = float(np.linalg.norm(high - low))
    along = (high - low) / length

    def shows(xy: NDArray) -> NDArray:
        off = xy - low
        across = np.abs(off[..., 0] * along[1] - off[..., 1] * along[0])
        return across <= np.interp(off @ along, [0, length], reach)

    return Paint(lambda xy: xy, shows)


def _covered(view: View, post: int, share: float) -> bool:
    """Return whether the other post stands before this one, at a share of its height."""
    court, centre = view.court, view.camera.centre_in_world
    here, other = _places(court, post, share), _places(court, 1 - post, [0.0, 1.0])
    if np.linalg.norm(here - centre) < np.linalg.norm(other[0] - centre):
        return False
    low, high = project(view.camera, other)
    if not np.isfinite([low, high]).all():
        return False
    wide = other[0] + 2 * _half_width(view, 1 - post)
    width = np.linalg.norm(project(view.camera, wide) - low)
    at = project(view.camera, here)
    along = (high - low) / np.linalg.norm(high - low)
    off = at - low
    beside = abs(off[0] * along[1] - off[1] * along[0])
    beyond = off @ along - np.linalg.norm(high - low)
    return bool(beside < width + COVERED_PX and beyond < width + COVERED_PX)


def _end(view: View, post: int, ray: Ray) -> tuple[float, float] | None:
    """Return the shift of a post's end along its axis, and its sigma; None if unseen."""
    reach = END_SEARCH * max(view.camera.size)
    steps = np.arange(-reach - END_PX, reach + END_PX, END_STEP_PX)
    normal = np.array([-ray.direction[1], ray.direction[0]])
    half = _half_width(view, post)
    at = _places(view.court, post, 1.0)
    width = np.linalg.norm(project(view.camera, at + half) - project(view.camera, at))
    core = np.linspace(-0.5, 0.5, 3) * width
    beside = np.linspace(*BESIDE_PX, 5) + width
    inside = _brightness(view.grey, ray, normal, steps, core)
    found = []
    for side in _sides(view, post, normal):
        outside = _brightness(view.grey, ray, normal, steps, side * beside)
        found.append(_step(inside - outside, steps, reach, view.blur_px))
    steps_found = [step for step in found if step]
    return max(steps_found, key=lambda step: step[2])[:2] if steps_found else None


def _sides(view: View, post: int, normal: NDArray) -> tuple[int, ...]:
    """Return the sides (-1, 1) on which the background beside the tip is free of the net."""
    at = _places(view.court, post, 1.0)
    outwards = np.array([0.1 if post else -0.1, 0, 0])
    shown = (project(view.camera, at + outwards) - project(view.camera, at)) @ normal
    return (-1, 1) if abs(shown) < 1.0 else (int(np.sign(shown)),)


def _brightness(grey, ray, normal, along, across) -> NDArray:
    places = ray.start + along[:, None, None] * ray.direction + across[:, None] * normal
    places = places.astype(np.float32)
    replicate = {"borderMode": cv2.BORDER_REPLICATE}
    seen = cv2.remap(grey, places[..., 0], places[..., 1], cv2.INTER_LINEAR, **replicate)
    return seen.mean(axis=1)


def _step(values, steps, reach, blur_px) -> tuple[float, float, float] | None:
    """Fit where values fall to 0; return place, sigma, share of variance explained, or None."""
    fits = []
    for place in np.arange(-reach, reach + 1e-9, 0.1):
        below = (1 + scipy.special.erf((place - steps) / blur_px / np.sqrt(2))) / 2
        design = np.stack([below, np.ones_like(below)], axis=1)
        found = np.linalg.solve(design.T @ design, design.T @ values)
        fits.append((float(np.sum((values - design @ found) ** 2)), place, found))
    rest, place, (contrast, beyond) = min(fits, key=lambda fit: fit[0])
    explained = 1 - rest / max(float(np.sum((values - values.mean()) ** 2)), 1e-9)
    post_goes_on = abs(beyond) > MOST_BEYOND * abs(contrast)
    if explained < LEAST_FIT or post_goes_on or abs(place) > reach - 0.3:
        return None
    noise = np.sqrt(rest / len(steps))
    return float(place), float(0.15 + noise / max(abs(contrast), 1e-6)), explained
