"""The quality page of a session: cameras, residuals, clocks, camera movement, missing joints."""

import math
from collections.abc import Iterable, Sequence

from markupsafe import Markup

from courtside.pages import page
from courtside.pages.report import warnings as warned

STAGES = {"pose3d": "raw", "pose3d_filtered": "filtered", "pose3d_corrected": "corrected"}


def session(
    configured: dict,
    facts: dict,
    found: Sequence[warned.Warned],
    takes: Iterable[tuple[dict, dict, Sequence[warned.Warned]]],
) -> Markup:
    """Return the quality page of a session as HTML.

    `configured` has `name`, `id` and `calibration` (that of its takes), `facts` are of
    `facts.of_session`, and `takes` are each take as configured, its facts and its warnings.
    """
    return page.render(
        "report_quality.html",
        configured=configured,
        level=warned.worst(found),
        found=found,
        model=facts["model"],
        calibrations=_calibrations(configured, facts["quality"]),
        static=_movement(facts["static"]),
        takes=[_take(*one) for one in takes],
        number=number,
    )


def _take(take: dict, known: dict, found: Sequence[warned.Warned]) -> dict:
    """Return what the template says of a take: the rows of its tables, and more."""
    views = sorted(known.get("views", {}).items(), reverse=True)
    reasons = list(dict.fromkeys(why for row in known["joints"].values() for why in row["reasons"]))
    return {
        "name": take["name"],
        "level": warned.worst(found),
        "clocks": _clocks(known),
        "movement": _movement(known["movement"]),
        "shake": known["shake"],
        "cameras": [
            (camera, percent(each["accepted"]), number(each["median_px"]))
            for camera, each in known["cameras"].items()
        ],
        "views": ", ".join(f"{share:.0%} on {n}" for n, share in views),
        "reasons": [why.replace("_", " ") for why in reasons],
        "joints": [
            (
                joint.replace("_", " "),
                percent(row["missing"]),
                *(percent(row["reasons"].get(why, 0.0)) for why in reasons),
                percent(row["few"]),
            )
            for joint, row in known["joints"].items()
        ],
        "truth": _truth(take, known),
    }


def _calibrations(configured: dict, quality: dict) -> list[tuple]:
    rows = []
    for calibration, content in quality.items():
        left = content.get("left_out")
        points = left.values() if isinstance(left, dict) else ()
        errors = [row["error_cm"] for row in points if row["error_cm"] is not None]
        values = (
            warned.left_out_cm(content),
            max(errors, default=None),
            content.get("expected_volume_rms_cm"),
            content.get("tie_residual_px"),
        )
        name = calibration + (" (takes)" if calibration == configured["calibration"] else "")
        rows.append((name, *map(number, values), len(content.get("warnings", ()))))
    return rows


def _movement(rows: Iterable[dict]) -> list[tuple]:
    found = []
    for row in rows:
        shift = number(math.hypot(row["shift_x_px"], row["shift_y_px"]))
        found.append((row["camera"], shift, number(row["zoom_percent"], 4), row["n_matches"]))
    return found


def _clocks(known: dict) -> list[tuple]:
    rows = [
        (camera, each.status, each.offset_s, each.uncertainty_s, each.note)
        for camera, each in known["clocks"].items()
    ]
    rows += [
        (row["source"], row["status"], row["offset_s"], row["uncertainty_s"], "")
        for row in known["devices"]
    ]
    return [
        (name, status, number(offset_s, 4), number(warned.MS_90 * sigma_s or None), note)
        for name, status, offset_s, sigma_s, note in rows
    ]


def _truth(take: dict, known: dict) -> list[tuple]:
    """Return errors against the truth, and the coverage of the stated ellipsoids."""
    return [
        (
            STAGES.get(row["stage"], row["stage"]),
            number(row["median_mm"], 0),
            number(row["p95_mm"], 0),
            percent(row["coverage_90_percent"] / 100),
            row["n"],
        )
        for row in known["truth"]
        if (row["fusion"], row["person"], row["joint"]) == (take["fusion"], "all", "limbs")
    ]


def limits() -> Markup:
    """Return how the marks are set, as an HTML table."""
    rows = [(words, f"{look:g}", f"{doubt:g}") for look, doubt, words in warned.LIMITS.values()]
    table = page.macro("report_parts.html", "table")
    return table(("what", "Look from", "Doubt from"), rows, "limits of the lights")


def number(value: float | None, digits: int = 2) -> str:
    """Return a number with so many digits after the point; a dash if unknown."""
    return f"{value:.{digits}f}" if value is not None and not math.isnan(value) else "–"


def percent(share: float | None) -> str:
    """Return a share of 0 to 1 in percent; a dash if unknown."""
    return f"{100 * share:.1f} %" if share is not None and not math.isnan(share) else "–"
