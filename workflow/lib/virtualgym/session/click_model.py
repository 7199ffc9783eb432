"""How exactly a person clicks a point of the court, by what its picture shows.

A point is where two edges cross. Each edge is found across itself, and the clearer the wider its
line is seen: a line thinner than the blur loses contrast against the noise, and where edge and
middle cannot be told apart, the click is anywhere between. Edges that cross at a small angle leave
the point uncertain along them. On top of that comes the hand. Seen through the net all is worse.

No number here is the estimator's. In real pictures of a hall, 3840 px wide, the clicks of ten
cameras on the floor scatter by 1.4 px per axis where the lens model fits best, and by 3 to 7 px,
which also hold errors of lens and court, in most (docs/measured/real_footage.md).
"""

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.geometry import camera as camera_models
from courtside.geometry.camera import Camera
from virtualgym.hall.painted_lines import NET_DEPTH_M
from virtualgym.presets import Preset

FULL_WIDTH_PX = 3840
HAND_PX_AT_3840 = 1.0  # ASSUME: zoomed in, a hand's scatter per axis shrinks with the picture
EDGE_PX = 0.25  # ASSUME: an edge is not found better than to a quarter of a pixel
BLUR_PX = 1.5  # ASSUME: of lens, sensor and coding: a thinner line loses contrast
STEP = 90.0  # ASSUME: grey levels between a line and the floor
ALONG_PX = 10.0  # ASSUME: length of a line that the eye averages
THROUGH_NET = 1.5  # ASSUME: factor on the scatter of a point behind the net
LONGEST = 0.002  # ASSUME: of the longer side: along edges at a small angle, from their lengths
HAND_SPREAD = 0.3  # ASSUME: standard deviation of the logarithm of a person's own factor
BIAS_PX_AT_3840, BIAS_PX = 0.7, 0.1  # ASSUME: of a person, common to all clicks
STEP_M = 1e-3  # for derivatives
RAISED_M = 0.5  # higher points are tips of posts


def person(rng: np.random.Generator) -> tuple[float, NDArray]:
    """Return a person's own factor on the scatter, and bias (2,) in units of `bias_px`."""
    return float(np.exp(HAND_SPREAD * rng.standard_normal())), rng.standard_normal(2)


def bias_px(camera: Camera) -> float:
    """Return the standard deviation per axis of a person's bias in a camera's picture."""
    return float(np.hypot(BIAS_PX_AT_3840 * max(camera.size) / FULL_WIDTH_PX, BIAS_PX))


def covariance(camera: Camera, xyz: NDArray, court: Court, preset: Preset) -> NDArray:
    """Return the covariance (P, 2, 2) px2 of an average person's clicks of court points.

    Parameters
    ----------
    camera : Camera
    xyz : (P, 3) float
        True places of the court's points, m.
    court : Court
    preset : Preset
        Its noise is that of the pictures.
    """
    along = _edges(camera, xyz)
    xy = camera_models.project(camera, xyz)
    by_m = (
        np.stack(
            [camera_models.project(camera, xyz + STEP_M * along[:, k]) - xy for k in (0, 1)], axis=1
        )
        / STEP_M
    )  # (P, 2 edges, 2): px for a metre along each edge
    with np.errstate(invalid="ignore", divide="ignore"):
        normal = by_m[:, :, ::-1] * [1, -1] / np.linalg.norm(by_m, axis=2, keepdims=True)
    # The width of a line along one edge is seen along the other.
    width_px = court.line_width_m * np.abs(np.sum(normal * by_m[:, ::-1], axis=2))
    weight = _edge_sigma(width_px, preset) ** -2.0
    information = np.einsum("pe,pei,pej->pij", weight, normal, normal)
    extent, axes = np.linalg.eigh(np.nan_to_num(information))
    longest = LONGEST * max(camera.size)
    found = (axes / np.maximum(extent, longest**-2.0)[:, None]) @ axes.transpose(0, 2, 1)
    hand = HAND_PX_AT_3840 * max(camera.size) / FULL_WIDTH_PX
    behind = np.where(behind_net(camera, xyz, court), THROUGH_NET, 1.0)
    return (found + hand**2 * np.eye(2)) * behind[:, None, None] ** 2


def _edges(camera: Camera, xyz: NDArray) -> NDArray:
    """Return the directions of the two edges that cross at each point, (P, 2, 3).

    Lines along x and y; of a post's tip, its side and its top across the line of sight.
    """
    sight = xyz - camera.centre_in_world
    across = np.cross(sight, [0, 0, 1.0])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    raised = xyz[:, 2:] > RAISED_M
    one = np.where(raised, across, [1.0, 0, 0])
    return np.stack([one, np.where(raised, [0, 0, 1.0], [0, 1.0, 0])], axis=1)


def _edge_sigma(width_px: NDArray, preset: Preset) -> NDArray:
    """Return how far an edge of a line is clicked off, across it, px."""
    clear = np.clip(width_px / BLUR_PX, 1e-3, 1.0)
    by_noise = BLUR_PX * preset.noise_sigma / (STEP * clear * np.sqrt(ALONG_PX))
    between = (1 - clear) * width_px / np.sqrt(12)  # anywhere between the line's two edges
    return np.sqrt(EDGE_PX**2 + by_noise**2 + between**2)


def behind_net(camera: Camera, xyz: NDArray, court: Court) -> NDArray:
    """Return which points (P,) bool a camera sees through the net."""
    if court.net is None:
        return np.zeros(len(xyz), dtype=bool)
    eye, y = camera.centre_in_world, court.net["y_m"]
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (y - eye[1]) / (xyz[:, 1] - eye[1])
    place = eye + share[:, None] * (xyz - eye)
    left, right = court.net["x_m"]
    low, high = court.net["post_height_m"] - NET_DEPTH_M, court.net["post_height_m"]
    crossed = (share > 0) & (share < 1 - 1e-6)
    inside = (place[:, 0] > left) & (place[:, 0] < right)
    return crossed & inside & (place[:, 2] > low) & (place[:, 2] < high)
