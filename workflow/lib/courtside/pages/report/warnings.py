"""What in a take or a session asks for a second look, in words for those who were not there."""

import math
from typing import NamedTuple

GOOD, LOOK, DOUBT = 0, 1, 2
WRIST_M_S = 12.0  # of a fast stroke: what an error of a clock costs
# quantity: (from here "look", from here "doubt", what it is)
LIMITS = {
    "moved": (0.5, 1.0, "movement of a fixed camera, as a share of what the configuration allows"),
    "clock_ms": (8, 20, "stated error of a clock, ms, nine times in ten"),
    "left_out_cm": (2, 5, "median error of court points, each left out in turn, cm"),
    "expected_cm": (2, 5, "error that the calibration expects over the playing volume, cm"),
    "tie_px": (1, 2, "scatter of the points that tie the pictures of the walk together, px"),
    "unregistered": (0.1, 0.3, "share of the walk's pictures that found no place in the model"),
    "contradicts": (0.25, 0.5, "share of a camera's limb joints that the other cameras contradict"),
    "missing": (0.05, 0.2, "share of the limb joints that have no place, unfiltered"),
    "two_views": (0.5, 0.8, "share of the placed limb joints that only two cameras see"),
    "distance": (0.05, 0.2, "error bar of the neck's distance, as a share of the distance"),
    "frames": (0.05, 0.2, "share of the frames that distance and speed leave out"),
}


class Warned(NamedTuple):
    """How serious (`GOOD`: only worth knowing, `LOOK`, `DOUBT`), and one sentence."""

    level: int
    text: str


def level_of(quantity, value):
    """Return the level of a value of `LIMITS`; what is not known asks for a look."""
    if value is None or math.isnan(value):
        return LOOK
    look, doubt, _ = LIMITS[quantity]
    return DOUBT if value >= doubt else LOOK if value >= look else GOOD


def worst(warned):
    """Return the highest level of some warnings."""
    return max((item.level for item in warned), default=GOOD)


def of_take(facts, *, max_shift_px, max_zoom_percent):
    """Return what to say of a take, the most serious first.

    Parameters
    ----------
    facts : dict
        As `facts.of_take` returns it.
    max_shift_px, max_zoom_percent : float
        What the configuration lets a fixed camera move.

    Returns
    -------
    warned : list of Warned
    """
    found = [moved(row, max_shift_px, max_zoom_percent) for row in facts["movement"]]
    found += [shaken(line) for line in facts["shake"]]
    found += [clock(camera, each) for camera, each in facts["clocks"].items()]
    found += [device(row) for row in facts["devices"]]
    found += [contradicts(camera, each) for camera, each in facts["cameras"].items()]
    found += joints(facts["joints"])
    found += [frames(person, *each) for person, each in facts["left_out"].items()]
    found += [distance(person, measures) for person, measures in facts["persons"].items()]
    found += [true_path(row) for row in facts["true_paths"]]
    return sorted(filter(None, found), key=lambda item: -item.level)


def of_session(facts, way, *, max_shift_px, max_zoom_percent):
    """Return what to say of a session's cameras, the most serious first.

    Parameters
    ----------
    facts : dict
        As `facts.of_session` returns it.
    way : str or None
        The calibration that its takes are measured with; None without one.
    max_shift_px, max_zoom_percent : float
        As for `of_take`.
    """
    found = [moved(row, max_shift_px, max_zoom_percent) for row in facts["static"]]
    found += calibration(way, facts["quality"][way]) if way in facts["quality"] else []
    found += [registered(facts["model"])] if facts["model"] else []
    return sorted(filter(None, found), key=lambda item: -item.level)


def moved(row, max_shift_px, max_zoom_percent):
    """Return a warning where a camera moved, or where nobody can tell.

    Parameters
    ----------
    row : dict
        Of a table of movement.
    max_shift_px, max_zoom_percent : float
        What is allowed.
    """
    shift = math.hypot(row["shift_x_px"], row["shift_y_px"])
    share = max(shift / max_shift_px, abs(row["zoom_percent"]) / max_zoom_percent)
    if math.isnan(share):
        text = "the picture shows too little background to tell whether it moved"
        return Warned(LOOK, f"Camera {row['camera']}: {text}.")
    level = level_of("moved", share)
    said = f"it moved by {shift:.2g} px and zoomed by {row['zoom_percent']:.2g} %"
    return Warned(level, f"Camera {row['camera']}: {said}.") if level else None


def shaken(line):
    """Return what a line about the shake of a camera says, now that the shake has been taken out."""
    said = line.rpartition("): ")[0] + ")" if "): " in line else line
    text = said[:1].upper() + said[1:]
    if "too little" in line or "no frame" in line:
        return Warned(LOOK, f"{text}.")
    if "knocked" in line or "stood" in line:
        return Warned(LOOK, f"{text}. This was measured on the background and taken out.")
    return Warned(GOOD, f"{text}; taken out.")


def clock(camera, found):
    """Return a warning where a camera's clock is unsure.

    Parameters
    ----------
    camera : str
    found : courtside.records.devices.clocks.Clock
    """
    if found.status == "reference":
        return None
    if found.status == "assumed":
        return Warned(
            GOOD, f"Camera {camera}: its clock is taken as the first camera's; not checked."
        )
    if not found.usable:
        words = {
            "ambiguous": "several offsets explain the recording",
            "unknown": "it was not found",
        }
        return Warned(DOUBT, f"Camera {camera}: its clock is not known: {words[found.status]}.")
    ms = 1645 * found.uncertainty_s
    level = level_of("clock_ms", ms)
    if not level:
        return None
    price = f"a wrist at {WRIST_M_S:.0f} m/s is off by up to {ms * WRIST_M_S / 10:.0f} cm"
    return Warned(level, f"Camera {camera}: its clock is known to {ms:.0f} ms only; {price}.")


def device(row):
    """Return a warning where the clock of a device's skeleton is unsure; `row` of the table of checks."""
    source = row["source"]
    if row["status"] in ("unknown", "ambiguous"):
        return Warned(
            DOUBT, f"{source}: its clock was not found; do not compare it with the others."
        )
    ms = 1645 * row.get("uncertainty_s", 0.0)
    level = level_of("clock_ms", ms)
    text = f"{source}: its clock is known to {ms:.0f} ms only (nine times in ten)."
    return Warned(min(level, LOOK), text) if level else None


def calibration(way, quality):
    """Return what to say of a calibration.

    Parameters
    ----------
    way : str
    quality : dict
        Content of its quality.json.
    """
    found = [Warned(LOOK, f"Calibration: {text}.") for text in quality.get("warnings", ())]
    error, expected = left_out_cm(quality), quality.get("expected_volume_rms_cm")
    ties = quality.get("tie_residual_px")
    for quantity, value, said in (
        ("left_out_cm", error, "a court point that was left out lies {:.1f} cm off, in the median"),
        ("expected_cm", expected, "expect errors of {:.1f} cm over the playing volume"),
        ("tie_px", ties, "the pictures of the walk fit together to {:.1f} px only"),
    ):
        if value is not None and level_of(quantity, value):
            found.append(
                Warned(level_of(quantity, value), f"Calibration {way}: {said.format(value)}.")
            )
    if isinstance(quality.get("left_out"), str):
        found.append(Warned(LOOK, f"Calibration {way}: {quality['left_out']}."))
    if error is None and expected is None:
        made = "made elsewhere" if way == "file" else way
        text = "nothing says how exact it is, so that no error bar holds its share"
        found.append(Warned(LOOK, f"Calibration {made}: {text}."))
    return found


def left_out_cm(quality):
    """Return the median error of the court points, each left out in turn, cm; None where not known."""
    table = quality.get("left_out")
    errors = [row["error_cm"] for row in table.values()] if isinstance(table, dict) else []
    errors = sorted(error for error in errors if error is not None)
    return errors[len(errors) // 2] if errors else None


def registered(model):
    """Return a warning where pictures found no place in a structure from motion; `model` is its summary."""
    lost = model["n_images"] - model["n_registered"]
    level = level_of("unregistered", lost / model["n_images"])
    text = f"{lost} of {model['n_images']} pictures of cameras and walk found no place in the model"
    return Warned(level, f"Structure from motion: {text}.") if level else None


def contradicts(camera, found):
    """Return a warning where the other cameras contradict one; `found` as `report_facts` gives it."""
    if found["accepted"] is None:
        return Warned(LOOK, f"Camera {camera}: nobody was followed in it.")
    level = level_of("contradicts", 1 - found["accepted"])
    text = f"the others contradict {1 - found['accepted']:.0%} of its joints"
    hint = "it may have moved, be calibrated wrongly, or be on another clock"
    return Warned(level, f"Camera {camera}: {text}; {hint}.") if level else None


def joints(found):
    """Return warnings about joints without a place, or with two views only.

    Parameters
    ----------
    found : dict
        `joints` as `facts.of_skeleton` gives them.
    """
    if not found:
        return []
    missing = sum(row["missing"] for row in found.values()) / len(found)
    few = [row["few"] for row in found.values() if row["few"] is not None]
    alone = sum(few) / len(few) if few else math.nan
    made, level = [], level_of("missing", missing)
    if level:
        name, row = max(found.items(), key=lambda pair: pair[1]["missing"])
        worst_one = f"most often the {name.replace('_', ' ')} ({row['missing']:.0%})"
        made.append(Warned(level, f"{missing:.0%} of the joints are missing, {worst_one}."))
    if few and level_of("two_views", alone):
        text = f"{alone:.0%} of the joints are seen by two cameras only: nothing checks them."
        made.append(Warned(min(level_of("two_views", alone), LOOK), text))
    return made


def distance(person, measures):
    """Return a warning where a distance is hardly known.

    Parameters
    ----------
    person : str
    measures : dict
        As `facts.of_take` gives them.
    """
    value, half = measures.get("neck_distance", (math.nan, math.nan))[:2]
    if math.isnan(value):
        return Warned(DOUBT, f"{person}: the distance of the neck could not be measured.")
    share = half / value if value > 0 else math.nan
    level = level_of("distance", share)
    if math.isnan(share):
        return Warned(level, f"{person}: the error of the distance is not known.")
    return Warned(level, f"{person}: the distance is known to {share:.0%} only.") if level else None


def true_path(row):
    """Return a warning where a simulated take shows that an error bar does not hold the true distance.

    Parameters
    ----------
    row : dict
        Of the evaluation of kinematics.
    """
    off, sigma = row["distance_error_percent"], row["distance_sigma_percent"]
    if row["point"] != "neck" or math.isnan(off) or abs(off) <= 1.645 * sigma:
        return None
    text = f"the true distance, known because the take is simulated, is {abs(off):.1f} % "
    text += f"{'smaller' if off > 0 else 'larger'}: outside the error bar"
    return Warned(LOOK, f"{row['person']}: {text}.")


def frames(person, lost, total, why):
    """Return a warning where distance and speed leave frames out.

    Parameters
    ----------
    person : str
    lost, total : int
        Frames left out; all frames.
    why : dict of str to int
        Frames by reason.
    """
    level = level_of("frames", lost / total) if total else LOOK
    if not level:
        return None
    words = {"uncertain": "the neck is known too badly there"}
    most = max(why, key=why.get, default="")
    reason = words.get(most, f"mostly {most.replace('_', ' ')}" if most else "nobody was found")
    return Warned(
        level, f"{person}: distance and speed leave out {lost} of {total} frames; {reason}."
    )
