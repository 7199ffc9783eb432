"""Whether a court was found in a picture: found, ambiguous or not found, and why."""

from dataclasses import dataclass, replace

import cv2
import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.calibration.click_proposals import proposals
from courtside.calibration.click_proposals.proposals import Proposals
from courtside.calibration.court import line_edges
from courtside.calibration.court.court import Court
from courtside.calibration.court_lines import refinement, search, views
from courtside.calibration.court_lines.refinement import Uncertainty
from courtside.calibration.court_lines.search import Candidate, Found
from courtside.calibration.court_lines.views import Samples
from courtside.geometry.camera import Camera
from courtside.records.cameras.click_proposals import EITHER

FOUND, AMBIGUOUS, NOT_FOUND = "found", "ambiguous", "not found"
# ASSUME: all of these are tuned by hand on development sessions.
MOST_RIVAL, LEAST_MARGIN = 0.92, 30.0  # of the next best: share of the score, and difference
LIKE_SCORE, WHITER, LEAST_WHITE = 0.4, 1.3, 0.3  # score and whiteness of like courts

OTHERS = "; if its lines are not white, set propose_court_points: {lines: any}"
BLUR_PX = 0.8  # of pictures, standard deviation
SAME_TURN, SAME_ZOOM = 0.08, 0.12  # rotations and logarithms of focal lengths of one camera


@dataclass(frozen=True, eq=False)
class Verdict:
    """What a picture says about its camera."""

    outcome: str  # `FOUND`, `AMBIGUOUS` or `NOT_FOUND`
    reason: str  # in one sentence; empty where found
    camera: Camera | None  # the best one, None where nothing is found
    score: float  # log likelihood ratio of the best against chance
    rival: float  # the next best one's score; 0 without
    uncertainty: Uncertainty | None
    symmetric: bool  # half a turn of the court gives the same lines: which end is not said


def examine(
    image: NDArray, court: Court, name: str, *, search_share: float, lines: str, **limits: float
) -> tuple[Verdict, Proposals]:
    """Find a court in a picture (H, W, 3) of a camera, judge what was found, propose its points.

    `search_share` of the picture's longer side is as far as a line is searched for; `limits` are
    those of `proposed`.
    """
    found = search.find(image, court, lines)
    judged = judge(found, court, name, image.shape[1::-1], lines)
    reach = {"search_px": search_share * max(image.shape[:2])}
    return judged, proposed(judged, image, court, lines=lines, **reach, **limits)


def judge(found: Found, court: Court, name: str, size: tuple[int, int], lines: str) -> Verdict:
    """Judge whether the best candidate is the camera of a picture of a size (width, height) px.

    A court is found if the picture shows most of the predicted lines, in both directions, and no
    other camera position explains nearly as much. Lines requested as "light" are white: of similar
    courts side by side the whiter one is chosen; if both are equally white, the result is
    ambiguous.
    """
    symmetric = views.is_symmetric(court)
    if not found.candidates:
        none = "no lines that fit the court" + OTHERS * (lines == "light")
        reason = none if len(court.lines_m) else proposals.NO_LINES
        return Verdict(NOT_FOUND, reason, None, 0.0, 0.0, None, symmetric)
    paint = np.ones(len(found.candidates))
    if lines == "light":
        paint = np.array([max(whiteness(found, one, court), 1e-3) for one in found.candidates])
    value = np.array([one.score for one in found.candidates]) * paint
    first = int(np.argmax(value))
    best = found.candidates[first]
    rival = np.delete(value, first).max(initial=0.0) / paint[first]
    outcome, reason = FOUND, ""
    if fault := search.fault(best, court):
        outcome, reason = NOT_FOUND, fault + OTHERS * (lines == "light")
    elif lines == "light" and paint[first] < LEAST_WHITE:
        outcome, reason = AMBIGUOUS, "the lines that fit the court are not white" + OTHERS
    elif _has_like(found.candidates, best, paint, court):
        outcome, reason = (
            AMBIGUOUS,
            "a similar court beside it fits as well: it is ambiguous which one is meant",
        )
    elif rival > MOST_RIVAL * best.score or best.score - rival < LEAST_MARGIN:
        outcome, reason = AMBIGUOUS, "another place of the camera explains the lines nearly as well"
    along = views.samples(court, search.FINE_M)
    camera = views.to_camera(best.view, name, size, found.scale, _reach_px(found, best, along))
    sure = refinement.uncertainty(found.seen, best.view, along, np.array([*court.size_m / 2, 0]))
    return Verdict(outcome, reason, camera, best.score, rival, sure, symmetric)


def _reach_px(found: Found, best: Candidate, along: Samples) -> float:
    """Return how far from the principal point lines are in the picture, px."""
    place = best.view.project(along.place)[0]
    inside = ((place > 0) & (place < found.image.shape[1::-1])).all(axis=1)
    return float(np.linalg.norm(place[inside] - best.view.principal, axis=1).max(initial=1.0))


def _has_like(candidates: list[Candidate], best: Candidate, paint: NDArray, court: Court) -> bool:
    """Return whether a court beside the best one fits too, with lines nearly as white."""
    own = paint[candidates.index(best)]
    return any(
        one.score > LIKE_SCORE * best.score
        and white * WHITER > own
        and _is_beside(one, best, court)
        and not search.fault(one, court)
        for one, white in zip(candidates, paint, strict=True)
    )


def _is_beside(one: Candidate, other: Candidate, court: Court) -> bool:
    """Say whether two candidates see courts that lie side by side, with nearly the same camera."""
    a, b = one.view, other.view
    zoom = np.abs(np.log([a.f_px[0] / b.f_px[0], a.centre[0, 2] / b.centre[0, 2]])).max()
    for way in (b, views.half_turned(b, court)):
        turned = np.linalg.norm(a.rotation[0] - way.rotation[0])
        away = np.abs(a.centre[0, :2] - way.centre[0, :2])
        if turned < SAME_TURN and zoom < SAME_ZOOM and (away > 0.95 * court.size_m).any():
            return True
    return False


def whiteness(found: Found, one: Candidate, court: Court) -> float:
    """Return the median whiteness of lines: 0 is the colour of the floor, 1 is white.

    It is the smallest of the three colour channels: yellow paint does not change blue.
    """
    along, image = views.samples(court, search.FINE_M / 2), found.image.astype(np.float32)
    place = one.view.project(along.place)[0]
    tangent = (one.view.project(along.place + along.half) - one.view.project(along.place))[0]
    normal = np.column_stack([-tangent[:, 1], tangent[:, 0]])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True) + 1e-9
    across = np.array([line_edges.middle_line(court, line)[1][:2] for line in along.line])
    ends = [one.view.project(along.place + by * across)[0] for by in (-1, 1)]
    width = np.abs(np.sum((ends[1] - ends[0]) * normal, axis=1))
    size = np.array(image.shape[1::-1])
    inside = ((place > 8) & (place < size - 9)).all(axis=1)
    if not inside.any():
        return 0.0

    def colour(xy: NDArray) -> NDArray:
        x, y = xy[inside].astype(np.float32).T
        return cv2.remap(image, x[:, None], y[:, None], cv2.INTER_LINEAR)[:, 0]

    away = max(3.0, 4.0 * size[0] / 1280)
    floor = (colour(place + away * normal) + colour(place - away * normal)) / 2
    # A thin line covers a part of a pixel's blurred surroundings.
    cover = np.maximum(scipy.special.erf(width[inside] / (2 * np.sqrt(2) * BLUR_PX)), 0.05)[:, None]
    contrast = np.median((colour(place) - floor) / cover, axis=0)
    return float((contrast / np.maximum(np.median(255 - floor, axis=0), 20)).min())


def proposed(
    verdict: Verdict,
    image: NDArray,
    court: Court,
    *,
    search_px: float,
    max_sigma_px: float = 1.0,
    lines: str = "light",
) -> Proposals:
    """Propose the court's points if the camera was found; otherwise give the reason for each point.

    As `click_proposals.proposals.propose`. For a symmetric court each reason is `EITHER`, because
    the court looks the same after half a turn.
    """
    if verdict.outcome != FOUND or verdict.camera is None:
        reason = f"court {verdict.outcome}: {verdict.reason}"
        return Proposals.none(len(court.points), reason, verdict.camera)
    found = proposals.propose(
        verdict.camera, image, court, search_px=search_px, max_sigma_px=max_sigma_px, lines=lines
    )
    if not verdict.symmetric:
        return found
    return replace(found, reason=tuple(reason or EITHER for reason in found.reason))


def in_words(verdict: Verdict, found: Proposals) -> str:
    """Return the outcome, and how many points are proposed or why none is."""
    proposed_points = np.isfinite(found.xy[:, 0])
    why = verdict.reason
    if not why and not proposed_points.any() and len(set(found.reason)) == 1:
        why = f"no point is proposed: {found.reason[0]}"
    counted = f"{proposed_points.sum()} of {len(proposed_points)} points"
    return f"court {verdict.outcome}: {why or counted}"


def report(verdict: Verdict, found: Proposals) -> dict:
    """Return a verdict for JSON: the camera and its uncertainty from floor lines."""
    said: dict = {
        "outcome": verdict.outcome,
        "reason": verdict.reason,
        "score": verdict.score,
        "next_best_score": verdict.rival,
        "either_end": verdict.symmetric,
        "n_proposed": int(np.isfinite(found.xy[:, 0]).sum()),
    }
    camera, sure = found.camera, verdict.uncertainty
    if verdict.outcome == FOUND and camera is not None and sure is not None:
        said |= {
            "f_px": float(camera.K[0, 0]),
            "f_sigma_px": sure.f_share * float(camera.K[0, 0]),
            "centre_m": camera.centre_in_world.tolist(),
            "height_sigma_m": sure.height_m,
            "distance_sigma_m": sure.distance_m,
        }
    return said
