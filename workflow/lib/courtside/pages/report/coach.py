"""The first part of the report, for a coach: measures of each take, their errors, and warnings."""

import math
from collections.abc import Sequence

from markupsafe import Markup

from courtside.pages import page
from courtside.pages.report import warnings as warned
from courtside.statistics import normal_errors

ANGLES = {
    "knee_flexion": "knee, bend",
    "elbow_flexion": "elbow, bend",
    "hip_flexion": "hip, bend",
    "shoulder_elevation": "arm, raised from the trunk",
    "trunk_lean": "trunk, lean from upright",
    "trunk_lean_forward": "trunk, lean forwards",
}


def with_error(value: float, half: float, unit: str) -> Markup:
    """Return a number with its error bar as HTML, with two digits of the error.

    `half` is half of the 90 % interval, NaN if unknown.
    """
    if math.isnan(value):
        return Markup("not known")
    known = math.isfinite(half) and half > 0
    # Without an error, whole degrees, and two digits of anything else.
    rough = 10.0 if unit == "degrees" else max(abs(value), 1e-3)
    digits = normal_errors.decimals(half if known else rough)
    error = Markup(f" &plusmn; {half:.{digits}f}") if known else ""
    sign = Markup("&deg;") if unit == "degrees" else f" {unit}"
    last = "" if known else " (error unknown)"
    return Markup(f"{value:.{digits}f}".replace("-", "&minus;")) + error + sign + last


def take(
    configured: dict, facts: dict, found: Sequence[warned.Warned], figures_id: str | None = None
) -> Markup:
    """Return one take as HTML: its mark, the measures of each person, its warnings.

    `configured` has `id`, `name` and `links` ([(address, words)]) of the take, `facts` are of
    `facts.of_take`, and `figures_id` is where its figures are on the page.
    """
    return page.render(
        "report_take.html",
        configured=configured,
        level=warned.worst(found),
        persons=[_person(name, facts) for name in facts["persons"]],
        sources=[row["source"] for row in facts["devices"]],
        found=found,
        places=configured["links"] + ([(f"#{figures_id}", "figures")] if figures_id else []),
    )


def _person(person: str, facts: dict) -> dict:
    """Return what the template says of a person: `phrases` are [(words, value, words after it)]."""
    measures = facts["persons"][person]
    phrases: list[tuple] = []
    distance = measures.get("neck_distance")
    if distance and not math.isnan(distance[0]):
        seconds, when = facts["seconds"].get(person, (0.0, ""))
        over = f" in {seconds:.1f} s" * (seconds > 0) + f", {when}" * bool(when)
        phrases.append(
            ("the neck travelled", with_error(*distance), f"{over}, up and down included")
        )
        if "neck_ground_distance" in measures:
            on_ground = with_error(*measures["neck_ground_distance"])
            phrases.append(("on the ground", on_ground, ""))
    for name, words in (("neck_speed_mean", "mean speed"), ("neck_speed_max", "largest speed")):
        if name in measures:
            phrases.append((words, with_error(*measures[name]), ""))
    if facts["left_out"].get(person):
        lost, total, *_ = facts["left_out"][person]
        phrases.append((f"from {total - lost} of {total} frames", "", ""))
    phrases += _strokes(facts["strokes"].get(person, []))
    phrases += _steps(facts["footwork"].get(person, {}))
    own = [row for row in facts["true_paths"] if (row["person"], row["point"]) == (person, "neck")]
    off = [value for row in own if not math.isnan(value := row["distance_error_percent"])]
    return {"name": person, "phrases": phrases, "off": off[:1], "angles": _angles(measures)}


def _strokes(rows: list[dict]) -> list[tuple]:
    """Return a phrase on the strokes; nothing of a take without one."""
    over = sum(bool(row["overhead"]) for row in rows)
    also = f" ({rows[0]['hand']} hand; {over} overhead)" if rows else ""
    return [("strokes", f"{len(rows)}", also)] if rows else []


def _steps(measures: dict) -> list[tuple]:
    """Return phrases on the feet; nothing of a take in which no step was found."""
    n = {name: measures.get(name, (0.0,))[0] for name in ("steps", "lunges", "split_steps")}
    if not n["steps"]:
        return []
    also = f" (lunges: {n['lunges']:.0f}, split steps: {n['split_steps']:.0f})"
    phrases: list[tuple] = [("landings of a foot", f"{n['steps']:.0f}", also)]
    verbs = {"stance_time": "stands for", "swing_time": "swings for"}
    known = [name for name in verbs if not math.isnan(measures[name][0])]
    for name, start in zip(known, ("a foot", "and"), strict=False):
        words = f"{start} {verbs[name]}"
        phrases.append((words, with_error(*measures[name]), " on average"))
    return phrases


def _angles(measures: dict) -> list[tuple]:
    """Return (joint, smallest, largest) of each measured angle."""
    rows = []
    for name, words in ANGLES.items():
        for side in ("", "left_", "right_"):
            low, high = (measures.get(f"{side}{name}_{end}") for end in ("min", "max"))
            if low and high:
                joint = f"{side.rstrip('_')} {words}".strip()
                rows.append((joint, with_error(*low), with_error(*high)))
    return rows
