"""Warnings of a take or a session, in words for readers who were not there."""

import math
import statistics
from collections.abc import Sequence
from typing import NamedTuple

from courtside.records.devices.clocks import WRIST_M_S, Clock
from courtside.statistics.normal_errors import WITHIN_90
from courtside.study.execution import verdicts
from courtside.study.methods import Calibration

GOOD, DOUBTFUL, FAILED = range(len(verdicts.ORDER))  # marks: LIGHTS in assets/report_parts.html
MS_90 = 1645  # half of the 90 % interval of a normal error with a sigma of 1 s, in ms
VAGUE_CLOCK = "the uncertainty of its clock is unknown"
# {quantity: (DOUBTFUL from, FAILED from, what it is)}
# ASSUME: chosen so that a usual recording gives no warning; no study backs them.
LIMITS = {
    "moved": (0.5, 1.0, "movement of a fixed camera, as a share of the configured limit"),
    "clock_ms": (8, 20, "90 % error of a clock, ms"),
    "left_out_cm": (2, 5, "median error of clicked points, cm (no expected error known)"),
    "expected_cm": (2, 5, "expected error of the calibration over the playing volume, cm"),
    "tie_px": (1, 2, "residual of the tie points between pictures of the walk, px"),
    "unregistered": (0.1, 0.3, "share of the pictures that were not registered in the model"),
    "missing": (
        0.05,
        0.2,
        "share of limb joints missing while a person is there, before filtering",
    ),
    "two_views": (0.5, 0.8, "share of the reconstructed limb joints that only two cameras see"),
    "distance": (0.05, 0.2, "error bar of the neck's distance, as a share of the distance"),
    "frames": (0.05, 0.2, "share of a person's frames in which the path of the neck is unknown"),
}


class Warned(NamedTuple):
    """The level (`GOOD`: for information only, `DOUBTFUL`, `FAILED`), and one sentence."""

    level: int
    text: str


def _level_of(quantity: str, value: float | None) -> int:
    """Return the level of a quantity of `LIMITS`; `DOUBTFUL` if its value is unknown."""
    if value is None or math.isnan(value):
        return DOUBTFUL
    doubtful, failed, _ = LIMITS[quantity]
    return FAILED if value >= failed else DOUBTFUL if value >= doubtful else GOOD


def worst(warned: Sequence[Warned]) -> int:
    """Return the highest level of some warnings."""
    return max((item.level for item in warned), default=GOOD)


def of_take(facts: dict, *, max_shift_px: float, max_zoom_percent: float) -> list[Warned]:
    """Return the warnings of a take, the most serious first; `facts` are of `facts.of_take`.

    `max_shift_px` and `max_zoom_percent` are how far a fixed camera may move.
    """
    found = [moved(row, max_shift_px, max_zoom_percent) for row in facts["movement"]]
    found += [shaken(line) for line in facts["shake"]]
    found += [clock(camera, each) for camera, each in facts["clocks"].items()]
    found += [doubted(f"Camera {camera}", each.doubt) for camera, each in facts["clocks"].items()]
    found += [device(row) for row in facts["devices"]]
    found += [doubted(row["source"], doubt_of(row)) for row in facts["devices"]]
    found += [no_tpose(row) for row in facts["devices"]]
    found += judged(facts["quality"])
    found += joints(facts["joints"])
    found += [frames(person, *each) for person, each in facts["left_out"].items()]
    found += [part(person, when) for person, when in facts["part"].items()]
    found += [distance(person, measures) for person, measures in facts["persons"].items()]
    found += [true_path(row) for row in facts["true_paths"]]
    return sorted(filter(None, found), key=lambda item: -item.level)


def of_session(
    facts: dict, used: str | None, *, max_shift_px: float, max_zoom_percent: float
) -> list[Warned]:
    """Return the warnings of a session's cameras, the most serious first.

    `facts` are of `facts.of_session`, `used` is the calibration of its takes, the limits are as for
    `of_take`.
    """
    found = [stood_still(row, max_shift_px, max_zoom_percent) for row in facts["static"]]
    found += calibration(used, facts["quality"][used]) if used and used in facts["quality"] else []
    found += [registered(facts["model"])] if facts["model"] else []
    return sorted(filter(None, found), key=lambda item: -item.level)


def moved(row: dict, max_shift_px: float, max_zoom_percent: float) -> Warned | None:
    """Return a warning if a camera moved further than allowed, or if that is unknown."""
    shift = math.hypot(row["shift_x_px"], row["shift_y_px"])
    share = max(shift / max_shift_px, abs(row["zoom_percent"]) / max_zoom_percent)
    if math.isnan(share):
        text = "the picture shows too little background to tell whether it moved"
        return Warned(DOUBTFUL, f"Camera {row['camera']}: {text}.")
    level = _level_of("moved", share)
    text = f"it moved by {shift:.2g} px and zoomed by {row['zoom_percent']:.2g} %"
    return Warned(level, f"Camera {row['camera']}: {text}.") if level else None


def stood_still(row: dict, max_shift_px: float, max_zoom_percent: float) -> Warned | None:
    """Return a warning if a camera moved within its static recording, as `moved` has it.

    This is measured wherever there are pictures enough: it is unknown of a photo alone.
    """
    if math.isnan(row["zoom_percent"]):
        text = "its static recording is a photo or one or two frames, which show no movement"
        return Warned(GOOD, f"Camera {row['camera']}: {text}.")
    return moved(row, max_shift_px, max_zoom_percent)


def shaken(line: str) -> Warned:
    """Return a line of `camera_shake.say` about a camera whose shake is corrected, as a sentence.

    Without the advice to correct it.
    """
    text = line.partition(": steady")[0]
    text = text[:1].upper() + text[1:]
    if "too little" in line or "no frame" in line or "zoomed" in line:
        return Warned(DOUBTFUL, f"{text}.")
    if "knocked" in line or "off its static picture" in line:
        return Warned(DOUBTFUL, f"{text}. This was measured on the background and corrected.")
    return Warned(GOOD, f"{text}; corrected.")


def clock(camera: str, found: Clock) -> Warned | None:
    """Return a warning if a camera's clock is uncertain.

    One that the session states is judged by the uncertainty that it states.
    """
    if found.status == "reference":
        return None
    if found.status == "assumed" and not _level_of("clock_ms", MS_90 * found.uncertainty_s):
        stated = bool(found.offset_s or found.drift_ppm)
        said = "as the session states it" if stated else "assumed to be that of the first camera"
        text = f"its clock is {said}; this was not checked"
        return Warned(GOOD, f"Camera {camera}: {text}.")
    if not found.usable:
        words = {"ambiguous": "several offsets fit the recording", "unknown": "no offset was found"}
        return Warned(FAILED, f"Camera {camera}: its clock is unknown: {words[found.status]}.")
    ms = MS_90 * found.uncertainty_s
    level = _level_of("clock_ms", ms)
    if not level:
        return None
    if math.isnan(ms):
        return Warned(level, f"Camera {camera}: {VAGUE_CLOCK}.")
    price = f"a wrist at {WRIST_M_S:.0f} m/s is off by up to {ms * WRIST_M_S / 10:.0f} cm"
    return Warned(level, f"Camera {camera}: its clock is known only to {ms:.0f} ms; {price}.")


def device(row: dict) -> Warned | None:
    """Return a warning if the clock of a device is uncertain; `row` is of the table of checks."""
    source = row["source"]
    if row["status"] in ("unknown", "ambiguous"):
        text = "its clock is unknown; do not compare it with the other sources"
        return Warned(FAILED, f"{source}: {text}.")
    ms = MS_90 * row.get("uncertainty_s", 0.0)
    level = _level_of("clock_ms", ms)
    text = VAGUE_CLOCK if math.isnan(ms) else f"its clock is known only to {ms:.0f} ms (90 %)"
    return Warned(min(level, DOUBTFUL), f"{source}: {text}.") if level else None


def doubted(whose: str, doubt: str) -> Warned | None:
    """Return a warning of what speaks against a clock that is used, if anything does."""
    return Warned(DOUBTFUL, f"{whose}: its clock is in doubt: {doubt}.") if doubt else None


def doubt_of(row: dict) -> str:
    """Return what speaks against a device's clock; `row` is of the table of checks.

    Empty cells are NaN, and older tables have no such column.
    """
    doubt = row.get("doubt")
    return doubt if isinstance(doubt, str) else ""


def no_tpose(row: dict) -> Warned | None:
    """Return a warning if a device shows no T-pose; `row` is of the table of checks."""
    if row.get("n_tposes", 1):
        return None
    text = "it shows no T-pose, so that it has no body frame of its own and no arcs of the wrists"
    return Warned(DOUBTFUL, f"{row['source']}: {text}; film a T-pose and a clap.")


def calibration(name: str, quality: dict) -> list[Warned]:
    """Return the warnings of a calibration; `quality` is the content of its quality.json.

    Errors of points contain those of their own clicks, which the cameras average, and hide what the
    cameras owe to these clicks: the error expected of the cameras says more, where it is known.
    """
    found = said("Calibration", quality)
    error, expected = left_out_cm(quality), quality.get("expected_volume_rms_cm")
    ties = quality.get("tie_residual_px")
    for quantity, value, words in (
        ("expected_cm", expected, "the expected error over the playing volume is {:.1f} cm"),
        (
            "left_out_cm",
            error if expected is None else None,
            "the median error of clicked points, each aligned to the others, is {:.1f} cm"
            + _fitted(name),
        ),
        ("tie_px", ties, "the residual of tie points between pictures of the walk is {:.1f} px"),
    ):
        if value is not None and _level_of(quantity, value):
            text = f"Calibration {name}: {words.format(value)}."
            found.append(Warned(_level_of(quantity, value), text))
    if isinstance(quality.get("left_out"), str):
        found.append(Warned(DOUBTFUL, f"Calibration {name}: {quality['left_out']}."))
    if not has_covariance(name, quality) and expected is None:
        made = "made elsewhere" if name == "file" else name
        text = "its accuracy is unknown, so that " if error is None else ""
        text += "the error bars do not include its error"
        found.append(Warned(DOUBTFUL if error is None else GOOD, f"Calibration {made}: {text}."))
    return found


def _fitted(name: str) -> str:
    """Return what a calibration whose cameras were fitted to the points hides of their errors."""
    if Calibration.parse(name).kind in ("sim3", "paper"):
        return ""
    return "; the cameras were fitted to these points, which hides a part of the error"


def has_covariance(name: str, quality: dict) -> bool:
    """Return whether the errors of a calibration's cameras are known, by its quality.json.

    A calibration file tells under `covariance` where they come from, or that they are unknown.
    """
    of_file = not quality.get("covariance", "unknown").startswith("unknown")
    return of_file or Calibration.parse(name).has_covariance


def said(what: str, content: dict) -> list[Warned]:
    """Return the warnings and remarks of a calibration's file or check, as sentences on `what`."""
    return [
        Warned(level, f"{what}: {text}.")
        for key, level in (("warnings", DOUBTFUL), ("remarks", GOOD))
        for text in content.get(key, ())
    ]


def left_out_cm(quality: dict) -> float | None:
    """Return the median error (cm) of the points, each aligned to the others; None if unknown."""
    table = quality.get("left_out")
    errors = [row["error_cm"] for row in table.values()] if isinstance(table, dict) else []
    known = [error for error in errors if error is not None]
    return statistics.median_high(known) if known else None


def registered(model: dict) -> Warned | None:
    """Return a warning if pictures were not registered; `model` is the summary of the model."""
    lost = model["n_images"] - model["n_registered"]
    level = _level_of("unregistered", lost / model["n_images"])
    text = f"{lost} of {model['n_images']} pictures of cameras and walk were not registered"
    return Warned(level, f"Structure from motion: {text}.") if level else None


def judged(rows: Sequence[dict]) -> list[Warned]:
    """Return a warning of each camera and person that is not good, else of a take that is not.

    `rows` are those of the verdicts' table.
    """
    wholes = [row for row in rows if row["measure"] == verdicts.WHOLE]
    bad = [row for row in wholes if row["verdict"] != verdicts.GOOD]
    each = [row for row in bad if not row["camera"] == row["person"] == verdicts.ALL]
    return [Warned(verdicts.ORDER.index(row["verdict"]), row["sentence"]) for row in each or bad]


def joints(found: dict) -> list[Warned]:
    """Return warnings of joints that are missing or seen by two cameras; `found` is of `facts`."""
    if not found:
        return []
    missing = sum(row["missing"] for row in found.values()) / len(found)
    few = [row["few"] for row in found.values() if row["few"] is not None]
    alone = sum(few) / len(few) if few else math.nan
    made, level = [], _level_of("missing", missing)
    if level:
        name, row = max(found.items(), key=lambda pair: pair[1]["missing"])
        worst_one = f"most often the {name.replace('_', ' ')} ({row['missing']:.0%})"
        made.append(Warned(level, f"{missing:.0%} of the joints are missing, {worst_one}."))
    if few and _level_of("two_views", alone):
        text = f"only two cameras see {alone:.0%} of the joints: no third camera can confirm these."
        made.append(Warned(min(_level_of("two_views", alone), DOUBTFUL), text))
    return made


def distance(person: str, measures: dict) -> Warned | None:
    """Return a warning if a distance is known badly; `measures` are those of `facts.of_take`."""
    value, half, _ = measures.get("neck_distance", (math.nan, math.nan, "m"))
    if math.isnan(value):
        text = f"the distance of the neck is unknown: {_unknown_distance(measures)}"
        return Warned(FAILED, f"{person}: {text}.")
    share = half / value if value > 0 else math.nan
    level = _level_of("distance", share)
    if math.isnan(share):
        return Warned(level, f"{person}: the error of the distance is unknown.")
    return Warned(level, f"{person}: the distance is known only to {share:.0%}.") if level else None


def _unknown_distance(measures: dict) -> str:
    """Return why a distance is unknown, and what to do; `measures` are as for `distance`."""
    bias, length, gaps = (
        measures.get(f"neck_distance{what}", (math.nan,))[0]
        for what in ("_noise_bias", "_measured", "_in_gaps")
    )
    if math.isnan(bias) and not length > 0:
        return "its path is known in no frame; see which joints are missing, and why"
    if math.isnan(bias):
        why = "the errors of the joints are not known, as of 3D joints of another program"
        return f"{why}; measure with videos, or with keypoints of the pictures (`pose2d`)"
    if math.isnan(gaps):
        why = "a gap in its path is too long to bridge"
        return f"{why}; cut the take to a part without it (`trim_s`), or film with more cameras"
    return "its table has no value"


def true_path(row: dict) -> Warned | None:
    """Return a warning if an error bar does not contain the true distance of a simulated take."""
    off, sigma = row["distance_error_percent"], row["distance_sigma_percent"]
    if row["point"] != "neck" or math.isnan(off) or abs(off) <= WITHIN_90 * sigma:
        return None
    text = f"the distance is {abs(off):.1f} % too {'long' if off > 0 else 'short'}"
    said = "the true one of this simulated take is outside its error bar"
    return Warned(DOUBTFUL, f"{row['person']}: {text}; {said}.")


def part(person: str, when: str) -> Warned:
    """Return a remark on who is there for a small part of a take: lost, or no longer in view."""
    return Warned(GOOD, f"{person}: two cameras see this person only {when}.")


def frames(
    person: str, lost: int, total: int, why: dict[str, int], when: str = ""
) -> Warned | None:
    """Return a warning if the neck's path is unknown in many frames; `why` counts reasons.

    `when` says which part of the take these frames are; empty: the whole take.
    """
    level = _level_of("frames", lost / total) if total else DOUBTFUL
    if not level:
        return None
    words = {"uncertain": "the position of the neck is too uncertain there"}
    most = max(why, key=lambda word: why[word], default="")
    reason = words.get(most, f"mostly {most.replace('_', ' ')}" if most else "nobody was found")
    text = f"the path of the neck is unknown in {lost} of {total} frames{f' {when}' * bool(when)}"
    return Warned(level, f"{person}: {text}; {reason}.")
