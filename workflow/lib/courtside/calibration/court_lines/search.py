"""The cameras that explain the lines of a picture best."""

import itertools
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.calibration.court_lines import (
    evidence,
    floor_frames,
    placements,
    refinement,
    ridges,
    views,
)
from courtside.calibration.court_lines.evidence import Fields
from courtside.calibration.court_lines.views import Samples, Views

# ASSUME: all of these are tuned by hand on development sessions, but for the widest lens and the
# second draw: these were added for a view of a real hall (docs/measured/real_footage.md).
WIDEST_PX = 1600  # larger pictures are made smaller: lines stay 1 px wide
COARSE_PX, FINE_PX = 8.0, 2.5  # per 1280 px of width: tolerance before and after refinement
COARSE_SAMPLES, FINE_M = 120, 0.3  # of all lines; between samples of a line
SHORTLIST, REFINED = 2000, 24  # cameras
APART_WIDTHS = 0.008  # of the picture: cameras nearer than this see the same
# Lenses tried in turn, by the share by which they pull the picture's corners in; all are tried
# `DRAWS` times, each time with other random samples. The search stops at the first camera that is
# accepted.
BARREL, DRAWS = (0.0, 0.07, 0.15, 0.22), 2
SETTLED, ROUNDS, STILL_PX = 3, 4, 0.3  # best cameras, refined again until they stay; per 1280 px
NEIGHBOURS, BESIDE_M, BESIDE_STEP_M = 2, 16.0, 0.15  # the search for a like court beside this
LEAST_SCORE = 100.0  # log likelihood ratio; lines of other things reached 70 to 110
LEAST_LINE, LEAST_LINES = 0.3, 0.7  # share of a line, and share of the lines in view seen so
FEWEST_LINES = 3  # along each axis


@dataclass(frozen=True, eq=False)
class Candidate:
    """A camera that explains lines of the picture."""

    view: Views  # of one, in a picture that is 1 / `scale` as large
    score: float  # log likelihood ratio against chance
    lines: NDArray  # (L,): share of each painted line that is seen; NaN where out of the picture


@dataclass(frozen=True, eq=False)
class Found:
    """Candidates found in a picture."""

    candidates: list[Candidate]  # best first; different ones, but for half turns
    seen: Fields
    image: NDArray  # in which they are
    scale: float  # how many times larger the given picture is


def find(image: NDArray, court: Court, lines: str = "light") -> Found:
    """Find cameras that explain the lines of a court in a picture (H, W, 3) uint8.

    The principal point is assumed to be the picture's centre. Several lenses are tried. Line
    segments give directions of the floor and focal lengths. Matches of lines in the picture with
    lines of the court give positions. The lines of the whole court then decide, and the best
    candidates are refined.
    """
    scale = max(1.0, image.shape[1] / WIDEST_PX)
    if scale > 1:
        size = round(image.shape[1] / scale), round(image.shape[0] / scale)
        scale = image.shape[1] / size[0]
        image = cv2.resize(image, size, interpolation=cv2.INTER_AREA)
    seen = evidence.fields(ridges.find(image, lines))
    found: list[Candidate] = []
    if not len(court.lines_m):
        return Found(found, seen, image, scale)
    for draw, barrel in itertools.product(range(DRAWS), BARREL):
        found += _of_lens(seen, court, barrel, draw)
        found = _different(found, court, seen.width)
        if found and not fault(found[0], court):
            break
    return Found(found, seen, image, scale)


def fault(one: Candidate, court: Court) -> str:
    """Return why a candidate is rejected, empty if it is accepted."""
    if one.score < LEAST_SCORE:
        return f"the best camera explains too little (score {one.score:.0f} of {LEAST_SCORE:.0f})"
    low, high = court.line_corners()
    axis = np.argmin(high - low, axis=1)
    shown = np.isfinite(one.lines)
    good = shown & (np.nan_to_num(one.lines) >= LEAST_LINE)
    if good.sum() < LEAST_LINES * shown.sum():
        return f"only {good.sum()} of {shown.sum()} lines in view are seen"
    for number, along in enumerate("yx"):
        # A court of fewer lines than that along an axis cannot show them.
        if good[axis == number].sum() < min(FEWEST_LINES, (axis == number).sum()):
            return f"too few lines along {along} are seen"
    return ""


def _of_lens(seen: Fields, court: Court, barrel: float, draw: int) -> list[Candidate]:
    """Return candidates with one lens."""
    rng, along = np.random.default_rng(draw), views.samples(court, FINE_M)
    hypotheses = _hypotheses(seen, court, barrel, rng)
    if hypotheses is None:
        return []
    tolerance = COARSE_PX * seen.width / 1280
    low, high = court.line_corners()
    few = views.samples(court, (high - low).max(axis=1).sum() / COARSE_SAMPLES)
    sparse = evidence.score(seen, hypotheses, few, tolerance).score
    hypotheses = hypotheses[np.argsort(-sparse, kind="stable")[:SHORTLIST]]
    found = _refined(seen, court, along, hypotheses, REFINED)
    for one in found[:NEIGHBOURS]:
        found = found + _refined(seen, court, along, _beside(one.view), 4)
    best = sorted(found, key=lambda one: -one.score)[:SETTLED]
    return found + [_settled(seen, court, along, one) for one in best]


def _hypotheses(seen, court, barrel, rng) -> Views | None:
    """Return cameras from straight pieces of lines, None if there are none."""
    height, width = seen.ridges.on.shape
    principal = np.array([width - 1, height - 1]) / 2
    corner = np.hypot(*principal)
    ends = ridges.segments(seen.ridges) - np.tile(principal, 2)
    square = np.concatenate([np.sum(half**2, axis=1) for half in (ends[:, :2], ends[:, 2:])])
    stretch = 1 / (1 - barrel * square / corner**2)
    ends = ends * np.repeat(stretch.reshape(2, -1).T, 2, axis=1)
    found = []
    for frame in floor_frames.find(ends, width, rng):
        lens = -barrel * (frame.f_px / corner) ** 2
        found += placements.find(frame, ends, court, width, lens, principal)
    return views.join(found) if found else None


def _refined(seen: Fields, court: Court, along: Samples, hypotheses: Views, most: int):
    """Return the refined ones among the best different hypotheses."""
    scale, found = seen.width / 1280, []
    score = evidence.score(seen, hypotheses, along, COARSE_PX * scale).score
    shown = np.nan_to_num(views.outline(hypotheses, court), nan=1e4)
    kept: list[int] = []
    for at in np.argsort(-score, kind="stable"):
        off = np.median(np.linalg.norm(shown[kept] - shown[at], axis=2), axis=1)
        if (off > APART_WIDTHS * seen.width).all():
            kept.append(int(at))
        if len(kept) == most or score[at] <= 0:
            break
    for at in kept:
        view = refinement.refine(seen, hypotheses[[at]], along)
        if view is not None and _possible(view, court):
            found.append(_candidate(seen, court, along, view))
    return sorted(found, key=lambda one: -one.score)


def _settled(seen: Fields, court: Court, along: Samples, one: Candidate) -> Candidate:
    """Return the best of a candidate and its further refinements, until it stays in place."""
    best, view, scale = one, one.view, seen.width / 1280
    for _ in range(ROUNDS):
        before, refined = view, refinement.refine(seen, view, along)
        if refined is None or not _possible(refined, court):
            break
        view = refined
        best = max(best, _candidate(seen, court, along, view), key=lambda trial: trial.score)
        moved = np.linalg.norm(view.project(along.place) - before.project(along.place), axis=2)
        if np.nanmedian(moved) < STILL_PX * scale:
            break
    return best


def _candidate(seen: Fields, court: Court, along: Samples, view: Views) -> Candidate:
    shown = evidence.score(seen, view, along, FINE_PX * max(1.0, seen.width / 1280))
    n = len(court.lines_m)
    weight = np.bincount(along.line, shown.weight[0], n)
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.bincount(along.line, shown.weight[0] * shown.close[0], n) / weight
    return Candidate(view, float(shown.score[0]), np.where(weight > 8, share, np.nan))


def _possible(view: Views, court: Court) -> bool:
    low, high = placements.HEIGHT_M
    away = np.hypot(*(view.centre[0, :2] - court.size_m / 2))
    far = placements.BEYOND_M + placements.BEYOND_LENGTHS * court.size_m[1]
    return bool(low * 0.9 < view.centre[0, 2] < high * 1.1 and away < far * 1.1)


def _beside(view: Views) -> Views:
    """Return cameras moved along the court's axes, to look for a like court beside it."""
    steps = np.arange(-BESIDE_M, BESIDE_M + BESIDE_STEP_M, BESIDE_STEP_M)
    steps = steps[np.abs(steps) > 0.3]
    shift = np.zeros((2 * len(steps), 3))
    shift[: len(steps), 0] = shift[len(steps) :, 1] = steps
    many = view[np.zeros(len(shift), dtype=int)]
    return replace(many, centre=many.centre + shift)


def _different(found: list[Candidate], court: Court, width: float) -> list[Candidate]:
    """Return candidates that see the court at different places, best first."""
    kept: list[Candidate] = []
    symmetric = views.is_symmetric(court)
    shown: list[NDArray] = []
    for one in sorted(found, key=lambda one: -one.score):
        place = np.nan_to_num(views.outline(one.view, court)[0], nan=1e4)
        ways = (place, place[::-1]) if symmetric else (place,)
        off = [
            np.median(np.linalg.norm(way - earlier, axis=1)) for way in ways for earlier in shown
        ]
        if not off or min(off) > APART_WIDTHS * width:
            kept.append(one)
            shown.append(place)
    return kept
