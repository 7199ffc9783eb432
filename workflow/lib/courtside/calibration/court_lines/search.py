"""The cameras that explain the lines of a picture best."""

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.calibration.click_proposals.view import View
from courtside.calibration.court.court import Court
from courtside.calibration.court_lines import (
    evidence,
    fitting,
    floor_frames,
    painting,
    placements,
    refinement,
    ridges,
    views,
)
from courtside.calibration.court_lines.evidence import Fields
from courtside.calibration.court_lines.fitting import Fitted
from courtside.calibration.court_lines.painting import Pattern
from courtside.calibration.court_lines.views import Samples, Views
from courtside.geometry.camera import Camera

# ASSUME: all of these are tuned by hand on development sessions.
WIDEST_PX = 1600  # larger pictures are made smaller: lines stay 1 px wide
COARSE_PX, FINE_PX = 8.0, 2.5  # per 1280 px of width: tolerance before and after refinement
COARSE_SAMPLES, FINE_M = 120, 0.3  # of all lines; between samples of a line
FEWEST_SAMPLES, LONGLIST = 40, 6000  # the same of the first selection, and cameras that it leaves
SHORTLIST, REFINED = 2000, 24  # cameras
APART_WIDTHS = 0.008  # of the picture: cameras nearer than this see the same
BARREL = (0.0, 0.07, 0.15)  # share by which lenses pull the picture's corners in; the next if none
NEIGHBOURS, BESIDE_M, BESIDE_STEP_M = 2, 16.0, 0.15  # the search for a like court beside this
SURE = 100.0  # score from which other lenses are not tried
TURNED, FITTED, AGAIN = 60, 10, 3  # cameras turned, fitted to the paint, and fitted again
SURE_MATCH = 40.0  # match of paint from which nothing else is tried, if lines are even
SEEN, SURE_LINES = 0.3, 0.8  # contrast of a line that is seen; share of such lines


@dataclass(frozen=True, eq=False)
class Candidate:
    """A camera that explains lines of the picture."""

    view: Views  # of one, in a picture that is 1 / `scale` as large
    score: float  # match of paint if `Found.painted`, else log likelihood ratio against chance
    # (L,): contrast of each painted line relative to all if `Found.painted`, else its share that is
    # seen; NaN where the picture cannot tell
    lines: NDArray


@dataclass(frozen=True, eq=False)
class Found:
    """Candidates found in a picture."""

    candidates: list[Candidate]  # best first; different ones, but for half turns
    seen: Fields
    image: NDArray  # in which they are
    scale: float  # how many times larger the given picture is
    painted: bool = False  # whether candidates were fitted to the paint, pixel by pixel


def find(
    image: NDArray, court: Court, lines: str = "light", *, k1: float | None = None, seed: int = 0
) -> Found:
    """Find cameras that explain the lines of a court in a picture (H, W, 3) uint8.

    The principal point is assumed to be the picture's centre. `k1` is the lens's if it is known;
    otherwise several values are tried. Line segments give directions of the floor and focal
    lengths. Matches of lines in the picture with lines of the court give positions. The lines of
    the whole court then decide, and the best candidates are refined.
    """
    image, scale = _reduced(image)
    fields = evidence.fields(ridges.find(image, lines))
    return Found(_of_lenses((fields,), court, k1, seed, None), fields, image, scale)


def find_by_paint(
    image: NDArray, court: Court, lines: str = "light", *, k1: float | None = None, seed: int = 0
) -> Found:
    """Find cameras that explain the paint of a court in a picture, pixel by pixel; as `find`.

    Slower, but it shows lines much thinner than a pixel. `lines` is "light" or "dark".
    """
    image, scale = _reduced(image)
    fields = [evidence.fields(by(image, lines)) for by in (ridges.find_faint, ridges.find)]
    painted = _Painted.of(image, court, lines)
    return Found(_of_lenses(tuple(fields), court, k1, seed, painted), fields[0], image, scale, True)


def _reduced(image: NDArray) -> tuple[NDArray, float]:
    """Return a picture that is not too wide, and how many times larger the given one is."""
    if image.shape[1] <= WIDEST_PX:
        return image, 1.0
    size = WIDEST_PX, round(image.shape[0] * WIDEST_PX / image.shape[1])
    return cv2.resize(image, size, interpolation=cv2.INTER_AREA), image.shape[1] / size[0]


def _is_sure(found: list[Candidate], painted: "_Painted | None") -> bool:
    """Return whether the best candidate is so good that nothing else is tried."""
    if not found or painted is None:
        return bool(found) and found[0].score > SURE
    known = found[0].lines[np.isfinite(found[0].lines)]
    return found[0].score > SURE_MATCH and float(np.mean(known > SEEN)) > SURE_LINES


def _of_lenses(
    fields: tuple[Fields, ...],
    court: Court,
    k1: float | None,
    seed: int,
    painted: "_Painted | None",
) -> list[Candidate]:
    """Return candidates with the first lens and ridges with which one is sure; else with all."""
    found: list[Candidate] = []
    for barrel in BARREL if k1 is None else (0.0,):
        for seen in fields:
            found += _of_lens(seen, court, barrel, k1, seed, painted)
            found = _different(found, court, seen.width)
            if _is_sure(found, painted):
                return found
    return found


@dataclass(frozen=True, eq=False)
class _Painted:
    """A picture and a court's paint."""

    pattern: Pattern
    pictures: list[NDArray]  # by `fitting.blurred`
    view: View  # the picture; of the camera only its size counts

    @classmethod
    def of(cls, image: NDArray, court: Court, lines: str) -> "_Painted":
        pictures = fitting.blurred(ridges.contrast(image, lines))
        camera = Camera("", image.shape[1::-1], np.eye(3), np.zeros(5), np.eye(4)[:3])
        return cls(Pattern.of(court), pictures, View.of(image, camera, court, lines))

    def candidate(self, fitted: Fitted) -> Candidate:
        """Return a candidate; one that matches by a few strong structures alone lacks lines."""
        lines = painting.of_lines(self.pattern, self.pictures[-1], fitted.view)
        known = np.isfinite(lines)
        even = float(np.clip(lines[known], 0, 1).sum()) / max(int(known.sum()), 1)
        return Candidate(fitted.view, fitted.match * even, lines)


def _of_lens(seen: Fields, court: Court, barrel: float, k1: float | None, seed: int, painted):
    """Return candidates with one lens."""
    rng, along = np.random.default_rng(seed), views.samples(court, FINE_M)
    hypotheses = _hypotheses(seen, court, barrel, k1, rng)
    if hypotheses is None:
        return []
    tolerance = COARSE_PX * seen.width / 1280
    low, high = court.line_corners()
    few = views.samples(court, (high - low).max(axis=1).sum() / COARSE_SAMPLES)
    if painted:
        fewest = views.samples(court, (high - low).max(axis=1).sum() / FEWEST_SAMPLES)
        least = evidence.LEAST_WIDTHS * FEWEST_SAMPLES / COARSE_SAMPLES
        sparse = evidence.score(seen, hypotheses, fewest, tolerance, least).score
        hypotheses = hypotheses[np.argsort(-sparse, kind="stable")[:LONGLIST]]
    sparse = evidence.score(seen, hypotheses, few, tolerance).score
    hypotheses = hypotheses[np.argsort(-sparse, kind="stable")[:SHORTLIST]]

    def fitted(hypotheses: Views, most: int, turned: int) -> list[Candidate]:
        if painted is None:
            return _refined(seen, court, along, hypotheses, most)
        chosen = _best_different(seen, court, along, hypotheses, turned)
        return _fitted(painted, court, hypotheses[chosen], most)

    found = fitted(hypotheses, REFINED if painted is None else FITTED, TURNED)
    if painted:
        found = _fitted_again(painted, court, found)
    for one in found[:NEIGHBOURS]:
        found = found + fitted(_beside(one.view), 4, 4)
    return found


def _hypotheses(seen, court, barrel, k1, rng) -> Views | None:
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
        lens = -barrel * (frame.f_px / corner) ** 2 if k1 is None else k1
        found += placements.find(frame, ends, court, width, lens, principal)
    return views.join(found) if found else None


def _refined(seen: Fields, court: Court, along: Samples, hypotheses: Views, most: int):
    """Return the refined ones among the best different hypotheses."""
    found = []
    for at in _best_different(seen, court, along, hypotheses, most):
        view = refinement.refine(seen, hypotheses[[at]], along)
        if view is not None and _possible(view, court):
            found.append(_candidate(seen, court, along, view))
    return sorted(found, key=lambda one: -one.score)


def _best_different(seen: Fields, court: Court, along: Samples, hypotheses: Views, most: int):
    """Return the indices of the best hypotheses that see the court at different places."""
    score = evidence.score(seen, hypotheses, along, COARSE_PX * seen.width / 1280).score
    shown = np.nan_to_num(views.outline(hypotheses, court), nan=1e4)
    kept: list[int] = []
    for at in np.argsort(-score, kind="stable"):
        off = np.median(np.linalg.norm(shown[kept] - shown[at], axis=2), axis=1)
        if (off > APART_WIDTHS * seen.width).all():
            kept.append(int(at))
        if len(kept) == most or score[at] <= 0:
            break
    return kept


def _fitted(painted: _Painted, court: Court, hypotheses: Views, most: int) -> list[Candidate]:
    """Return some of hypotheses, best first, fitted to the paint.

    One half are the first ones, the other half those that match best when turned.
    """
    given = painted.pattern, painted.pictures
    turned = [fitting.shifted(*given, hypotheses[[at]], 0) for at in range(len(hypotheses))]
    starts = [one for one in turned if one is not None]
    starts, others = starts[: most // 2], starts[most // 2 :]
    starts += sorted(others, key=lambda one: -one.match)[: most - len(starts)]
    fitted = [fitting.fit(*given, start.view) for start in starts]
    found = [painted.candidate(one) for one in fitted if one and _possible(one.view, court)]
    return sorted(found, key=lambda one: -one.score)


def _fitted_again(painted: _Painted, court: Court, found: list[Candidate]) -> list[Candidate]:
    """Return candidates, best first; the first ones are fitted again until one is sure."""
    better = list(found)
    for at, one in enumerate(found[:AGAIN]):
        again = fitting.fit_again(painted.pattern, painted.pictures, one.view, painted.view)
        if again is not None and _possible(again.view, court):
            better[at] = max(one, painted.candidate(again), key=lambda each: each.score)
        if better[at].score > SURE_MATCH:
            break
    return sorted(better, key=lambda one: -one.score)


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
