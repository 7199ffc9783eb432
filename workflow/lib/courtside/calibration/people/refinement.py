"""A calibration refined by people, beside the one that it began from: taken only where better."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from courtside.calibration.file_check import residuals, verdict
from courtside.calibration.people import adjustment, held_out, prior, resection, views
from courtside.calibration.people.held_out import Points, Score
from courtside.calibration.people.knocks import knocks
from courtside.calibration.people.views import Limits, Seen
from courtside.calibration.records import covariance as camera_covariance
from courtside.calibration.records.covariance import PARAMETERS, CameraCovariance
from courtside.geometry import rotations
from courtside.geometry.camera import Camera, in_other_picture
from courtside.records.devices.clocks import Clock

NAMED = 3.0  # stated standard deviations by which a number must change to be called wrong
LENS = ("f_px", "cx_px", "cy_px", "k1")
# ASSUME: rows of all tracks, divided by how many err alike. With 2.5 (a person on a treadmill for a
# second) held-out joints were better and points at rest worse; with 7 both were better.
FEWEST_DIFFERENT = 4.0
# ASSUME: of how far held-out joints disagree. A network errs alike in all blocks: on development
# takes, cameras that fitted its errors were better by 1 to 2 %, and worse over the volume.
LEAST_ALONE = 0.05
COLUMNS = ("what", "camera", "base", "mended", "refined", "sigma")
TAKEN = {
    "base": "cameras kept as before",
    "mended": "cameras without the faults named were taken, not adjusted",
    "refined": "cameras refined by people were taken",
}
KINDS = {"court": "court points", "static": "points at rest"}


@dataclass(frozen=True, eq=False)
class Found:
    """What came of it."""

    cameras: list[Camera]
    covariance: CameraCovariance
    taken: str  # `base`, `mended` (without named faults) or `refined`
    line: str  # why, in one line
    verdicts: dict[str, dict[str, str]]  # of `mended` against base, of `refined` against these
    wrong: list[str]  # the numbers of the base that people contradict
    table: pd.DataFrame  # `COLUMNS`: held-out measures, then each camera's numbers


def without_knocks(
    cameras: Sequence[Camera],
    known: CameraCovariance,
    takes: Mapping[str, Seen],
    clocks: Mapping[str, Mapping[str, Clock]],
    limits: Limits,
) -> tuple[Seen, list[dict[str, Any]]]:
    """Return what was seen in all takes without knocks, and rows of all found.

    Takes are in the order of time; `clocks` are of each take and camera.
    """
    rows, still = [], {}
    for take, seen in takes.items():
        found = knocks.find(cameras, known, seen, limits)
        rows += [{"take": take, **knocks.row(one, cameras, clocks[take])} for one in found]
        still[take] = knocks.undone(cameras, seen, found)
    seen, moves = knocks.between(cameras, known, still, limits)
    return seen, rows + moves


def refine(
    cameras: Sequence[Camera],
    known: CameraCovariance,
    seen: Seen,
    limits: Limits,
    points: Points,
    *,
    calibrated: Sequence[Camera] | None = None,
    found_again: Sequence[Camera] | None = None,
) -> Found:
    """Refine cameras by people, and judge this by what the fit did not see.

    Faults that files usually have (`file_check.faults`) are looked for first, where `calibrated`
    has the cameras of the file, in their own pictures; what is left is adjusted. These faults are
    judged by joints as detected: with a wrong camera a network's offsets are wrong, too. Cameras
    that were `found_again` (`resection`) take the place of mended ones. Each step must be better in
    all `held_out.verdicts`; but cameras found again are a start, and adjusting them must not be
    worse. Raises `InputError` of bad input (`views.check`).
    """
    views.check(cameras, seen, limits.score)
    wrong, mended = _mended(cameras, calibrated, seen, found_again)
    knowledge = prior.knowledge(mended, known)

    def fit(part: Seen, some: adjustment.Clicks | None) -> adjustment.Refined:
        return adjustment.refine(mended, part, knowledge, limits, some)

    scores = {"base": held_out.score(lambda *_: cameras, seen, points, limits)}
    if wrong:
        scores["mended"] = held_out.score(lambda *_: mended, seen, points, limits)
    scores["refined"] = held_out.score(lambda *part: fit(*part).cameras, seen, points, limits)
    refined = fit(seen, points.court if points.fitted else None)
    ways = {"base": list(cameras), "mended": mended, "refined": refined.cameras}
    taken, verdicts, steps = _judged(scores, seen, refined.alike, found_again is not None)
    spread = camera_covariance.of_network([c.name for c in cameras], refined.covariance)
    table = pd.concat([_measures(cameras, scores), _numbers(ways, spread)])
    wrong = [*wrong, *_named(mended, refined.cameras, known)] if taken == "refined" else wrong
    line = f"{TAKEN[taken]}; what the fit did not see: {'; '.join(steps)}"
    return Found(
        ways[taken], spread if taken == "refined" else known, taken, line, verdicts, wrong, table
    )


def _judged(
    scores: dict[str, Score], seen: Seen, alike: float, started: bool
) -> tuple[str, dict[str, dict[str, str]], list[str]]:
    """Return the way that is taken, the verdicts of each, and in words what changes by each.

    `started`: cameras found again.
    """
    taken, verdicts, steps = "base", {}, []
    names = {"mended": "with cameras found again" if started else "without the faults named"}
    for way in list(scores)[1:]:
        before, after, is_started = scores[taken], scores[way], started and taken == "mended"
        said = verdicts[way] = held_out.verdicts(before, after)
        if way == "refined" and list(said) == ["joints"] and not is_started:
            said |= _alone(seen, alike, 1 - np.exp(held_out.change(before, after)[0]))
        steps.append(f"{names.get(way, way)}, {', '.join(_changes(said, before, after))}")
        is_better = "worse" not in said.values() if is_started else held_out.better(said)
        taken = way if is_better else taken
    return taken, verdicts, steps


def _changes(said: dict[str, str], before: Score, after: Score) -> Iterator[str]:
    """Yield in words whether views of each kind of points agree better, and by how much."""
    for what, word in said.items():
        if what == "joints":
            off = [f"{1000 * one.typical():.1f}" for one in (before, after)]
            word = f"{word} ({' -> '.join(off)} thousandths of the height)"
        elif what in KINDS:
            word = f"{word} ({before.rms_px(what):.1f} -> {after.rms_px(what):.1f} px)"
        yield f"{KINDS.get(what, what)} {word}"


def unchanged(cameras: Sequence[Camera], known: CameraCovariance, why: str) -> Found:
    """Return cameras as they were, because people cannot refine them."""
    line = f"cameras kept as before: {why}"
    return Found(list(cameras), known, "base", line, {}, [], pd.DataFrame(columns=list(COLUMNS)))


def _mended(cameras, calibrated, seen: Seen, found_again) -> tuple[list[str], list[Camera]]:
    """Return the faults that explain how people's joints disagree, and the cameras without them."""
    if found_again is not None:
        both = zip(cameras, found_again, strict=True)
        return [resection.line(old, new) for old, new in both if old is not new], found_again
    if calibrated is None:
        return [], list(cameras)
    pairs = list(zip(calibrated, cameras, strict=True))
    views = [
        in_other_picture(shown, whole, xy)
        for (whole, shown), xy in zip(pairs, seen.detected_xy, strict=True)
    ]
    joints = verdict.Seen(people=residuals.of_people(views))
    said = verdict.judge(calibrated, joints, residuals.height_px(views, seen.height_px))
    if not said.faults:
        return [], list(cameras)
    lines = [f"{one.what} ({one.advice})" for one in said.faults]
    return lines, [
        replace(one, size=shown.size, K=shown.K @ np.linalg.inv(whole.K) @ one.K)
        for one, (whole, shown) in zip(said.cameras, pairs, strict=True)
    ]


def _alone(seen: Seen, alike: float, gain: float) -> dict[str, str]:
    """Return why joints alone say too little: the network's own errors last through all blocks."""
    n_rows = len(seen.thinned().track)
    advice, found = "click points at rest", {}
    if n_rows < FEWEST_DIFFERENT * alike:
        found["variety of what people do"] = f"not better ({advice})"
    if gain < LEAST_ALONE:
        least = f"{100 * gain:.1f} %, expected {100 * LEAST_ALONE:.0f} %"
        found["size of the change"] = f"not better ({least}; {advice})"
    return found


def _named(base: Sequence[Camera], refined: Sequence[Camera], known: CameraCovariance) -> list[str]:
    """Return the numbers of lenses that changed by more than is stated of them."""
    found = []
    for old, new in zip(base, refined, strict=True):
        for name, before, after in zip(LENS, _lens(old), _lens(new), strict=True):
            sigma = known.sigma(old.name, name)
            if sigma and abs(after - before) > NAMED * sigma:
                found.append(
                    f"{name} of camera {old.name}: expected {before:.5g} to {sigma:.2g}, as stated "
                    f"of it, found {after:.5g}"
                )
    return found


def _lens(camera: Camera) -> tuple[float, ...]:
    return camera.K[1, 1], camera.K[0, 2], camera.K[1, 2], camera.dist[0]


def _measures(cameras: Sequence[Camera], scores: dict[str, Score]) -> pd.DataFrame:
    """Return the held-out measures of all cameras, by camera where they have one."""
    rows: list[dict] = []
    for what in ("court", "static"):
        of = {way: one.rms_px(what) for way, one in scores.items()}
        if np.isfinite(of["base"]):
            rows.append({"what": f"{what}_px", "camera": "all", **of})
    of = {way: 1000 * s.typical() for way, s in scores.items()}
    rows.append({"what": "joints_permille", "camera": "all", **of})
    each = {way: one.accepted_percent() for way, one in scores.items()}
    for at, camera in enumerate(cameras):
        of = {way: shares[at] for way, shares in each.items()}
        rows.append({"what": "accepted_percent", "camera": camera.name, **of})
    return pd.DataFrame(rows, columns=list(COLUMNS))


def _numbers(ways: dict[str, list[Camera]], spread: CameraCovariance) -> pd.DataFrame:
    """Return each camera's numbers; `turned_deg` and `moved_cm` are from those of the base."""
    rows: list[dict] = []
    for at, base in enumerate(ways["base"]):
        here = {way: cameras[at] for way, cameras in ways.items()}
        sigma = [spread.sigma(base.name, name) for name in PARAMETERS]
        turned = {
            way: np.degrees(
                rotations.angles(one.cam_from_world[:, :3] @ base.cam_from_world[:, :3].T)
            )
            for way, one in here.items()
        }
        moved = {
            way: 100 * np.linalg.norm(one.centre_in_world - base.centre_in_world)
            for way, one in here.items()
        }
        of = {"what": "turned_deg", **turned, "sigma": np.degrees(np.linalg.norm(sigma[:3]))}
        own = [of, {"what": "moved_cm", **moved, "sigma": 100 * np.linalg.norm(sigma[3:6])}]
        for number, name in enumerate(LENS):
            of = {way: _lens(one)[number] for way, one in here.items()}
            own.append({"what": name, **of, "sigma": spread.sigma(base.name, name)})
        rows += [{"camera": base.name, **row} for row in own]
    return pd.DataFrame(rows, columns=list(COLUMNS))
