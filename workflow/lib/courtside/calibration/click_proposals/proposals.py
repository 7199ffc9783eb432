"""Propose the positions of the named court points in a picture, from the painted lines."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.click_proposals import line_profiles, post_tips, refine_pose
from courtside.calibration.click_proposals.line_shift import Shift
from courtside.calibration.click_proposals.view import NO_PLACE, Ray, View
from courtside.calibration.court import line_edges
from courtside.calibration.court.court import Court
from courtside.calibration.court.line_edges import Edge
from courtside.geometry.camera import Camera, project
from courtside.statistics.normal_errors import MEDIAN_TO_SIGMA

# ASSUME: all of these are tuned by hand on the virtual sessions.
STRETCH_M = 1.6  # of line that is measured at once
SHARES = (1.0, 0.5, 0.25, 0.25)  # of the search, in successive rounds
LEAST_PX = 2.0  # of search
LEAST_SCORE, MOST_RIVAL, LEAST_SHARE = 0.25, 0.85, 0.5  # from which a stretch is reliable
FEWEST = 5  # stretches by which a camera is moved
SIDE_PX, SIDE_M = 45.0, (0.5, 2.5)  # of line on each side of a point
NEAR_PX = 2.5  # search around a point, once the camera is moved
CAMERA_PX = 0.6  # of a point on the floor by the moved camera: paint is some mm off the model
# Of the search, median by which lines may miss the moved camera: lines found by chance miss it by
# half, those of right virtual cameras by a tenth.
MOST_MISFIT = 0.35
HEIGHT_M = 0.03  # of one above the floor: lines on the floor determine heights badly
OFF_SIGMA = 4.0  # an edge farther from where the camera expects it is another one
PAINT_PX = 0.1  # error not in the fit of a profile: codec, neighbouring paint
NO_LINES = "the court file has no painted lines"
MISFIT = (
    "expected painted lines at most {:.1f} px from where an adjusted camera expects them, found "
    "{:.1f} px; click its points, or correct its lens or the court's file"
)
TOO_FEW = "too few painted lines are seen where they are expected"
_Found = tuple[NDArray, NDArray, float, str]


@dataclass(frozen=True, eq=False)
class Proposals:
    """Proposed points of one camera."""

    xy: NDArray  # (P, 2): px; NaN where nothing is proposed
    sigma_px: NDArray  # (P,): expected standard deviation, the larger of both axes; NaN as `xy`
    # (P,): share of what is expected near the point that is seen, less where the place is uncertain
    confidence: NDArray
    reason: tuple[str, ...]  # P: why nothing is proposed; empty where something is
    camera: Camera | None  # the given one, moved so that the lines fit; None without

    @classmethod
    def none(cls, n: int, reason: str, camera: Camera | None) -> "Proposals":
        """Return that none of `n` points is proposed, for one reason."""
        return cls(np.full((n, 2), np.nan), np.full(n, np.nan), np.zeros(n), (reason,) * n, camera)


@dataclass(frozen=True, eq=False)
class Registered:
    """A view whose camera was moved to the lines in its picture, or why it was not."""

    view: View
    camera_px: float = np.inf  # standard deviation, per axis, of a point on the floor by it
    reason: str = ""  # empty where the lines fit


def propose(
    camera: Camera,
    image: NDArray,
    court: Court,
    *,
    search_px: float,
    max_sigma_px: float = 1.0,
    lines: str = "light",
) -> Proposals:
    """Propose the points of a court in one camera's picture.

    First the camera is moved until all painted lines project onto the lines in the picture, stretch
    by stretch. Then each point is measured from its own lines nearby: their edges are fitted and
    intersected. Where lines meet at an acute angle, the camera adds information. The tip of a post
    is the end of its axis, which is fitted in the same way. A point that is not visible is not
    proposed, even if the camera predicts it.

    The camera is known roughly: in its static picture (H, W, 3) uint8, the predicted court may be
    wrong by up to `search_px`. A point whose expected error is above `max_sigma_px` is not
    proposed. Against the floor the lines are "light", "dark" or "any". Raises `ValueError` if the
    picture has not the camera's size.
    """
    if image.shape[1::-1] != tuple(camera.size):
        raise ValueError(f"expected a picture of {camera.size} px, found {image.shape[1::-1]}")
    moved = register(View.of(image, camera, court, lines), search_px)
    if moved.reason:
        return Proposals.none(len(court.points), moved.reason, moved.view.camera)
    found = [_point(moved.view, at) for at in range(len(court.points))]
    return _checked(moved, found, max_sigma_px)


def register(view: View, search_px: float) -> Registered:
    """Move a view's camera so that the lines fit, if they do."""
    line, ends = line_edges.stretches(view.court, STRETCH_M)
    if not len(line):
        return Registered(view, reason=NO_LINES)
    middle = ends.mean(axis=1)
    for share in SHARES:
        reach = max(share * search_px, LEAST_PX)
        shifts = [view.shift(*each, reach) for each in zip(line, ends, middle, strict=True)]
        good = np.array([is_reliable(shift) for shift in shifts])
        if good.sum() < FEWEST or len({line[at] for at in np.flatnonzero(good)}) < 3:
            return Registered(view, reason=TOO_FEW)
        halves = np.array([line_edges.middle_line(view.court, at)[1] for at in line[good]])
        along = ends[good, 1] - ends[good, 0]
        normal = line_profiles.tangent_and_normal(view.camera, middle[good], along, halves)[1]
        used = [shift for shift in shifts if shift is not None and is_reliable(shift)]
        offset = np.array([(shift.low_px + shift.high_px) / 2 for shift in used])
        sigma = np.array([shift.sigma_px for shift in used])
        moved = refine_pose.refine(view.camera, middle[good], normal, offset, sigma)
        rest = offset - refine_pose.shifts(view.camera, moved, middle[good], normal)
        misfit_px = float(np.median(np.abs(rest)))
        view = replace(view, camera=moved)
    if misfit_px > (most_px := MOST_MISFIT * reach):
        return Registered(view, reason=MISFIT.format(most_px, misfit_px))
    return Registered(view, max(CAMERA_PX, MEDIAN_TO_SIGMA * misfit_px))


def is_reliable(shift: Shift | None) -> bool:
    """Return whether a stretch is reliably a painted line."""
    return (
        shift is not None
        and shift.score > LEAST_SCORE
        and shift.share > LEAST_SHARE
        and shift.rival < MOST_RIVAL
    )


def _point(view: View, at: int) -> _Found:
    """Return (xy, covariance, share, reason) of one point."""
    court, place = view.court, view.court.xyz[at]
    expected = project(view.camera, place)
    inside = (expected > 1) & (expected < np.array(view.camera.size) - 2)
    if not (np.isfinite(expected).all() and inside.all()):
        return *NO_PLACE, "outside the picture"
    post = line_edges.post(court, at)
    edges = line_edges.named(court)[at]
    if not court.on_floor[at]:
        if post is None:
            return *NO_PLACE, "neither on a line nor on a post"
        return post_tips.tip(view, post)
    rays = [_edge(view, edge, place) for edge in edges]
    if len(edges) < 2 and post is not None and edges:
        rays.append(post_tips.axis(view, post))
    if len(rays) < 2:
        return *NO_PLACE, "fewer than two edges meet here"
    one, other = rays[:2]
    if one is None or other is None:
        return *NO_PLACE, "one of its lines is not seen near it"
    return _meet(one, other)


def _edge(view: View, edge: Edge, place: NDArray) -> Ray | None:
    """Return the seen edge near a point as a Ray, None where it is not seen."""
    ends, half = line_edges.middle_line(view.court, edge.line)
    origin = place.copy()
    origin[edge.axis] = ends[0, edge.axis]
    along = 1 - edge.axis
    step = np.zeros(3)
    step[along] = 0.05
    ends_px = project(view.camera, origin + step), project(view.camera, origin - step)
    scale = np.linalg.norm(ends_px[0] - ends_px[1])
    reach_m = np.clip(SIDE_PX / max(float(scale) / 0.1, 1e-6), *SIDE_M)
    stretch = np.array([origin, origin])
    stretch[0, along] = max(origin[along] - reach_m, ends[0, along])
    stretch[1, along] = min(origin[along] + reach_m, ends[1, along])
    shift = view.shift(edge.line, stretch, origin, NEAR_PX)
    if not shift or shift.score < LEAST_SCORE or shift.near_share < LEAST_SHARE:
        return None
    moved = {-1: shift.low_px, 0: (shift.low_px + shift.high_px) / 2, 1: shift.high_px}[edge.side]
    line = view.ray(origin, place, ends[1] - ends[0], half, moved, shift.slope)
    share = min(shift.near_share, shift.share)
    return Ray(*line, np.hypot(shift.sigma_px, PAINT_PX), share)


def _meet(one: Ray, other: Ray) -> _Found:
    """Return (xy, covariance, share, reason) where two rays meet."""
    across = np.array([[-ray.direction[1], ray.direction[0]] for ray in (one, other)])
    if abs(np.linalg.det(across)) < 0.03:
        return *NO_PLACE, "its lines run into one another"
    back = np.linalg.inv(across)
    xy = back @ np.array([across[0] @ one.start, across[1] @ other.start])
    covariance = back @ np.diag([one.sigma_px**2, other.sigma_px**2]) @ back.T
    return xy, covariance, min(one.share, other.share), ""


def _checked(moved: Registered, found: Sequence[_Found], max_sigma_px: float) -> Proposals:
    """Return proposals without those that are uncertain or far from the camera's prediction."""
    view = moved.view
    expected = project(view.camera, view.court.xyz)
    n = len(found)
    xy, sigma_px, confidence = np.full((n, 2), np.nan), np.full(n, np.nan), np.zeros(n)
    reasons = []
    for at, (place, covariance, share, reason) in enumerate(found):
        if not reason:
            off, alone = place - expected[at], covariance
            if view.court.on_floor[at]:
                # Together with where the camera, moved to fit all lines, has it.
                gain = covariance @ np.linalg.inv(covariance + moved.camera_px**2 * np.eye(2))
                place, covariance = place - gain @ off, covariance - gain @ covariance
            sigma = float(np.sqrt(np.linalg.eigvalsh(covariance)[-1]))
            allowed = alone + _model_error(moved, at) ** 2 * np.eye(2)
            reason = _why_not(off, allowed, sigma, max_sigma_px)
            if not reason:
                xy[at], sigma_px[at], confidence[at] = place, sigma, share / (1 + sigma**2)
        reasons.append(reason)
    return Proposals(xy, sigma_px, confidence, tuple(reasons), view.camera)


def _model_error(moved: Registered, at: int) -> float:
    """Return the standard deviation, px, of where the moved camera projects a point."""
    view, court = moved.view, moved.view.court
    place = court.xyz[at]
    away = np.linalg.norm(place - view.camera.centre_in_world)
    off_m = np.hypot(court.sigma_m[at], HEIGHT_M * (not court.on_floor[at]))
    return np.hypot(moved.camera_px, off_m * view.camera.K[0, 0] / away)


def _why_not(off: NDArray, allowed: NDArray, sigma: float, max_sigma_px: float) -> str:
    """Return the reason why a point is not proposed, empty if it is."""
    if sigma > max_sigma_px:
        return f"uncertain by {sigma:.1f} px"
    if off @ np.linalg.solve(allowed, off) > OFF_SIGMA**2:
        return f"{np.linalg.norm(off):.1f} px from the position that the other lines predict"
    return ""
