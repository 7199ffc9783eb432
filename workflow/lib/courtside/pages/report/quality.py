"""The quality page of a session: cameras, residuals, clocks, movement, and what became of the joints."""

import math

from courtside.pages.page import text
from courtside.pages.report import warnings as warned
from courtside.pages.report.coach import light, scrolling, warnings


def table(head, rows, label):
    """Return a table that scrolls by itself.

    Parameters
    ----------
    head : sequence of str
    rows : list of sequences
        Cells: text or numbers.
    label : str
        What it holds.
    """
    if not rows:
        return ""
    top = "".join(f"<th scope='col'>{text(name)}</th>" for name in head)
    body = "".join(f"<tr>{''.join(map(_cell, row))}</tr>" for row in rows)
    made = f"<table><thead><tr>{top}</tr></thead><tbody>{body}</tbody></table>"
    return scrolling(made, label)


def session(said, facts, found, takes):
    """Return the quality page of a session as HTML.

    Parameters
    ----------
    said : dict
        `name`, `id`, `way` (the calibration of its takes), `cameras` of the session.
    facts : dict
        As `facts.of_session` returns it.
    found : list of courtside.pages.report.warnings.Warned
    takes : list of (dict, dict, list)
        What is said of each take, its facts and its warnings.
    """
    parts = [f"<h3 id='{text(said['id'])}'>{text(said['name'])} {light(warned.worst(found))}</h3>"]
    parts += [warnings(found), _model(facts["model"]), _calibrations(said, facts["quality"])]
    parts.append(_movement("Movement within the static recording", facts["static"]))
    parts += [_take(take, known, level) for take, known, level in takes]
    return "".join(filter(None, parts))


def _take(take, known, found):
    parts = [_clocks(known), _movement("Movement since the static recording", known["movement"])]
    parts += [_shake(known), _cameras(known), _joints(known), _truth(take, known)]
    head = f"<summary>Take {text(take['name'])} {light(warned.worst(found))}</summary>"
    return f"<details class='quality'>{head}{''.join(filter(None, parts))}</details>"


def _model(model):
    if not model:
        return ""
    return (
        f"<p>Structure from motion ({text(model['mapper'])}): {model['n_registered']} of "
        f"{model['n_images']} "
        f"pictures registered, {model['n_points3d']} points, mean reprojection error "
        f"{number(model['reprojection_px'])} px.</p>"
    )


def _calibrations(said, quality):
    rows = []
    for way, content in quality.items():
        left = content.get("left_out")
        errors = (
            [e for row in left.values() if (e := row["error_cm"]) is not None]
            if isinstance(left, dict)
            else []
        )
        rows.append(
            (
                f"{way} (takes)" if way == said["way"] else way,
                number(warned.left_out_cm(content)),
                number(max(errors, default=None)),
                number(content.get("expected_volume_rms_cm")),
                number(content.get("tie_residual_px")),
                len(content.get("warnings", ())),
            )
        )
    head = (
        "calibration", "left-out point, median cm", "largest cm", "expected over the volume, cm",
        "ties, px", "warnings",
    )  # fmt: skip
    return table(head, rows, f"calibrations of {said['name']}")


def _movement(title, rows):
    cells = [
        (
            row["camera"],
            number(math.hypot(row["shift_x_px"], row["shift_y_px"])),
            number(row["zoom_percent"], 4),
            row["n_matches"],
        )
        for row in rows
    ]
    made = table(("camera", "shift, px", "zoom, %", "places compared"), cells, title)
    return f"<h5>{title}</h5>{made}" if made else ""


def _clocks(known):
    rows = [
        (
            camera,
            each.status,
            number(each.offset_s, 4),
            number(1645 * each.uncertainty_s or None),
            each.note,
        )
        for camera, each in known["clocks"].items()
    ]
    rows += [
        (
            row["source"],
            row["status"],
            number(row["offset_s"], 4),
            number(1645 * row["uncertainty_s"] or None),
            "",
        )
        for row in known["devices"]
    ]
    head = ("camera or source", "clock", "offset, s", "90 % within, ms", "how")
    made = table(head, rows, "clocks")
    return f"<h5>Synchronisation</h5>{made}" if made else ""


def _shake(known):
    lines = "".join(f"<li>{text(line)}</li>" for line in known["shake"])
    return f"<h5>Shake and knocks, taken out</h5><ul>{lines}</ul>" if lines else ""


def _cameras(known):
    rows = [
        (camera, percent(each["accepted"]), number(each["median_px"]))
        for camera, each in known["cameras"].items()
    ]
    head = ("camera", "limb joints used", "their median reprojection error, px")
    made = table(head, rows, "views")
    if not made:
        return ""
    views = ", ".join(
        f"{share:.0%} on {n}" for n, share in sorted(known["views"].items(), reverse=True)
    )
    return f"<h5>Views</h5>{made}<p>Of all limb joints in all frames, by the number of views: {views}.</p>"


def _joints(known):
    words = list(dict.fromkeys(word for row in known["joints"].values() for word in row["reasons"]))
    rows = [
        (
            joint.replace("_", " "),
            percent(row["missing"]),
            *(percent(row["reasons"].get(word, 0.0)) for word in words),
            percent(row["few"]),
        )
        for joint, row in known["joints"].items()
    ]
    head = ("limb joint", "missing", *(word.replace("_", " ") for word in words), "two views only")
    made = table(head, rows, "joints lost, and why")
    return f"<h5>Joints lost, unfiltered, and why</h5>{made}" if made else ""


def _truth(take, known):
    """Return errors against a truth and how often the stated ellipsoids hold it, of simulated takes."""
    stages = {"pose3d": "raw", "pose3d_filtered": "filtered", "pose3d_corrected": "corrected"}
    rows = [
        (
            stages.get(row["stage"], row["stage"]),
            number(row["median_mm"], 0),
            number(row["p95_mm"], 0),
            percent(row["coverage_90_percent"] / 100),
            row["n"],
        )
        for row in known["truth"]
        if (row["fusion"], row["person"], row["joint"]) == (take["fusion"], "all", "limbs")
    ]
    head = (
        "12 limb joints",
        "median error, mm",
        "95 % within, mm",
        "inside their 90 % ellipsoid",
        "n",
    )
    made = table(head, rows, "errors against the truth")
    return f"<h5>Against the truth of the simulation</h5>{made}" if made else ""


def limits():
    """Return how the lights are set, as an HTML table."""
    rows = [(words, f"{look:g}", f"{doubt:g}") for look, doubt, words in warned.LIMITS.values()]
    return table(("what", "Look from", "Doubt from"), rows, "limits of the lights")


def number(value, digits=2):
    """Return a number with so many digits behind the point; a dash where there is none."""
    return f"{value:.{digits}f}" if value is not None and not math.isnan(value) else "–"


def percent(share):
    """Return a share of 0 to 1 in percent; a dash where there is none."""
    return f"{100 * share:.1f} %" if share is not None and not math.isnan(share) else "–"


def _cell(value):
    said = text(value)
    numeric = said[:1] in "–-0123456789" and not said.startswith("0x")
    return f'<td class="number">{said}</td>' if numeric else f"<td>{said}</td>"
