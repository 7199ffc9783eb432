"""The quality page of a session: cameras, residuals, clocks, camera movement, missing joints."""

import math
from collections.abc import Iterable, Sequence

from markupsafe import Markup

from courtside.pages import page
from courtside.pages.report import methods
from courtside.pages.report import warnings as warned
from courtside.study.methods import STAGE_WORDS, Calibration

NO_VOLUME = "neither a court nor points on a floor say where the volume is"
NO_COVARIANCE = "the error of these cameras is not known"
UNMEASURED = {
    **dict.fromkeys(("shift_x_px", "shift_y_px", "zoom_percent"), math.nan),
    "n_matches": "–",
}
OF_HEIGHT = "reprojection"  # the measure of a verdict that is no share in percent


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
        facts=facts,
        calibrations=[_calibration(*one) for one in facts["quality"].items()],
        used=_used(configured["calibration"], facts["quality"]),
        takes=[_take(*one) for one in takes],
        stages=STAGE_WORDS,
        number=number,
        percent=percent,
        limit=limit,
        movement_px=lambda row: math.hypot(row["shift_x_px"], row["shift_y_px"]),
        clock_ms=lambda sigma_s: number(warned.MS_90 * sigma_s or None),
    )


def _take(take: dict, known: dict, found: Sequence[warned.Warned]) -> dict:
    """Return what the template says of a take besides its facts."""
    devices = [
        (row["source"], {**row, "note": "", "doubt": warned.doubt_of(row)})
        for row in known["devices"]
    ]
    reasons = [why for row in known["joints"].values() for why in row["reasons"]]
    still = {row["camera"] for row in known["movement"]}
    unknown = [{"camera": name, **UNMEASURED} for name in known["cameras"] if name not in still]
    return {
        **known,
        "name": take["name"],
        "fusion": take["fusion"],
        "level": warned.worst(found),
        "clocks": [*known["clocks"].items(), *devices],
        "movement": known["movement"] + unknown if still else [],
        "shake": [warned.shaken(line).text for line in known["shake"]],
        "reasons": list(dict.fromkeys(reasons)),
    }


def _calibration(name: str, content: dict) -> dict:
    """Return what the template says of a calibration besides its content."""
    left = content.get("left_out")
    points = left.values() if isinstance(left, dict) else ()
    errors = [row["error_cm"] for row in points if row["error_cm"] is not None]
    median = warned.left_out_cm(content)
    return {"name": name, "median_cm": median, "largest_cm": max(errors, default=None), **content}


def _used(name: str | None, known: dict[str, dict]) -> dict | None:
    """Return what the template says of the calibration that takes are measured with, and why.

    `words`: what it is; `expected_cm`, why it is `unknown`, and, of one refined by people, `base`,
    `before_cm`, `line` (which cameras were taken, by what was held out), `wrong` (numbers named)
    and `others` (what else its `warnings` and `remarks` say).
    """
    if not name or name not in known:
        return None
    content, way = known[name], Calibration.parse(name)
    found: dict = {"name": name, "words": _words(name, known), "base": way.base}
    found["expected_cm"] = content.get("expected_volume_rms_cm")
    found["unknown"] = NO_VOLUME if warned.has_covariance(name, content) else NO_COVARIANCE
    if way.base:
        line, wrong = content["line"], content["wrong"]
        found |= {"line": line, "wrong": wrong, "before_cm": content.get("expected_before_cm")}
        told = [*content["warnings"], *content["remarks"]]
        found["others"] = [one for one in told if not one.endswith((line, *wrong))]
        found |= {"of_base": _words(way.base, known)}
    return found


def _words(name: str, known: dict[str, dict]) -> str:
    """Return in words how the cameras of a calibration were found, by the files of the quality."""
    own = {key: value for key, value in known.items() if key == name}
    stated = warned.has_covariance(name, own.get(name, {}))
    return methods.calibrated(Calibration.parse(name), clicked=clicked(own), has_covariance=stated)


def clicked(qualities: dict[str, dict]) -> bool:
    """Return whether a session's cameras rest on clicked points, by the files of their quality.

    Those of structure from motion without a court leave no point out.
    """
    alone = [
        "left_out" not in content
        for name, content in qualities.items()
        if Calibration.parse(name).kind == "sfm"
    ]
    return not alone or not all(alone)


def limits() -> Markup:
    """Return how the marks are set, as an HTML table."""
    rows = [
        (words, f"{doubtful:g}", f"{failed:g}")
        for doubtful, failed, words in warned.LIMITS.values()
    ]
    table = page.macro("report_parts.html", "table")
    return table(("what", "doubtful from", "failed from"), rows, "limits of the marks")


def limit(row: dict, key: str) -> str:
    """Return a limit of a verdict as its sentence states the value; a dash if never reached."""
    falling, value = row["doubtful_from"] > row["failed_from"], row[key]
    if math.isnan(value) or (falling and value == 0):
        return "–"
    stated = f"{value:g}" if row["measure"] == OF_HEIGHT else f"{value:.0%}"
    return f"{'below' if falling else 'above'} {stated}"


def number(value: float | None, digits: int = 2) -> str:
    """Return a number with so many digits after the point; a dash if unknown."""
    return f"{value:.{digits}f}" if value is not None and not math.isnan(value) else "–"


def percent(share: float | None) -> str:
    """Return a share of 0 to 1 in percent; a dash if unknown."""
    return f"{100 * share:.1f} %" if share is not None and not math.isnan(share) else "–"
