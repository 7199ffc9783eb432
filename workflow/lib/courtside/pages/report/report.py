"""The report of a study: a page that a coach can read, then every figure, each session's quality, methods."""

from courtside.pages import page
from courtside.pages.page import text
from courtside.pages.report import coach, methods, quality, warnings
from courtside.pages.report import facts as report_facts
from courtside.pages.report import figures as report_figures
from courtside.pages.report.figures import identity

LEAD = (
    "Every number comes with the interval that holds nine errors in ten, as far as the pictures "
    "themselves can "
    "show. The mark of a take says whether something asks for attention: {good} nothing found; "
    "{look} usable, "
    "read what it says; {doubt} do not rest a decision on it."
)


def build(study):
    """Put the report together.

    Parameters
    ----------
    study : dict
        `title`; `parameters` (the steps as configured); `sessions`, each with `name`, `description`,
        `virtual`, `way`, `mapper`, `n_images`, `fusion`, `model`, `overrides`, `limits` (`max_shift_px`,
        `max_zoom_percent`), perhaps `withheld` (lines that say what is not made for want of consent), `files`
        (of `facts.of_session`) and `takes`, each with `name`, `fusion`, `links` and `files` (of
        `facts.of_take`); `figures` as `figures.figure` takes them, with `session` and `take`;
        `tables` as `figures.table` takes them.

    Returns
    -------
    page : str
        For `page.write`.

    Raises
    ------
    InputError
        If a file is missing or not what it should be.
    """
    known = [_read(session) for session in study["sessions"]]
    names = [session["name"] for session in study["sessions"]]
    grouped = report_figures.groups(study["figures"], names)
    drawn, images = _figures(grouped)
    parts = {
        "measured": ("What was measured", _measured(known, grouped)),
        "figures": ("Figures", drawn),
        "quality": ("How far to trust it", _quality(known)),
        "tables": ("Tables", "".join(map(report_figures.table, study["tables"]))),
        "methods": ("Methods", methods.paragraphs(study["parameters"], study["sessions"])),
    }
    parts = {key: part for key, part in parts.items() if part[1]}
    sections = "".join(
        f'<section id="{key}"><h2>{words}</h2>{html}</section>'
        for key, (words, html) in parts.items()
    )
    body = (
        f"<header><h1>{text(study['title'])}</h1><p>{_lead()}</p>{_contents(parts, known, grouped)}</header>"
        f'<main>{sections}</main><a class="top" href="#top" aria-label="to the top">↑</a>'
    )
    body = f'<div id="top" class="report">{body}</div>'
    return page.build(study["title"], body, css=["report.css"], js=["report.js"], images=images)


def _read(session):
    """Return what is known of a session: what is said of it, facts and warnings of itself and its takes."""
    facts = report_facts.of_session(session["files"])
    found = warnings.of_session(facts, session["way"], **session["limits"])
    takes = []
    for take in session["takes"]:
        read = report_facts.of_take(take["files"])
        said = {**take, "id": identity("take", session["name"], take["name"])}
        takes.append((said, read, warnings.of_take(read, **session["limits"])))
    said = {**session, "id": identity("quality", session["name"])}
    return {"said": said, "facts": facts, "found": found, "takes": takes}


def _lead():
    levels = zip(("good", "look", "doubt"), coach.LIGHTS, strict=True)
    return LEAD.format(**{name: coach.light(level) for name, level in levels})


def _contents(parts, known, grouped):
    inner = {
        "measured": [
            (identity("session", s["said"]["name"]), s["said"]["name"])
            for s in known
            if s["takes"] or s["said"].get("withheld")
        ],
        "figures": [(_group_id(key), _group_name(key)) for key in grouped],
        "quality": [(s["said"]["id"], s["said"]["name"]) for s in known],
    }
    items = []
    for key, (words, _) in parts.items():
        links = "".join(
            f'<li><a href="#{at}">{text(name)}</a></li>' for at, name in inner.get(key, ())
        )
        items.append(f'<li><a href="#{key}">{words}</a>{f"<ul>{links}</ul>" if links else ""}</li>')
    return f'<nav aria-label="contents"><h2>Contents</h2><ol>{"".join(items)}</ol></nav>'


def _measured(known, grouped):
    """Return a table of all takes at a glance, then every take in words."""
    made = [_glance(known)]
    for session in known:
        said = session["said"]
        if not session["takes"] and not said.get("withheld"):
            continue
        kind = ' <span class="badge">simulated</span> ' if said["virtual"] else " "
        if session["facts"]["quality"]:
            kind += coach.light(warnings.worst(session["found"]), "Cameras")
        made.append(
            f'<h3 id="{identity("session", said["name"])}">{text(said["name"])}{kind}</h3>'
            f"<p>{text(said['description'])}</p>{coach.withheld(said.get('withheld', ()))}"
            f"{coach.warnings(session['found'])}"
        )
        for take, facts, found in session["takes"]:
            key = (said["name"], take["name"])
            figures = _group_id(key) if key in grouped else None
            made.append(coach.take(take, facts, found, figures))
    return "".join(made)


def _glance(known):
    rows = []
    for session in known:
        for take, facts, found in session["takes"]:
            level = max(warnings.worst(found), warnings.worst(session["found"]))
            for person, measures in facts["persons"].items():
                cells = [
                    coach.with_error(*measures[name][:3]) if name in measures else "–"
                    for name in ("neck_distance", "neck_speed_mean", "neck_speed_max")
                ]
                link = f'<a href="#{take["id"]}">{text(session["said"]["name"])}, {text(take["name"])}</a>'
                link += "&nbsp;*" if session["said"]["virtual"] else ""
                values = [coach.light(level), link, text(person), *cells]
                rows.append("".join(f"<td>{value}</td>" for value in values))
    if not rows:
        return ""
    names = ("", "take", "person", "distance of the neck", "mean speed", "largest speed")
    head = "".join(f"<th scope='col'>{name}</th>" if name else "<td></td>" for name in names)
    body = "".join(f"<tr>{row}</tr>" for row in rows)
    table = f"<table class='glance'><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
    note = '<p class="soft">* simulated: nobody was filmed.</p>' if "&nbsp;*</td>" in body else ""
    return coach.scrolling(table, "all takes at a glance") + note


def _figures(grouped):
    made, images = [], {}
    for key, figures in grouped.items():
        made.append(f'<h3 id="{_group_id(key)}">{text(_group_name(key))}</h3>')
        for said in figures:
            name = f"figure-{len(images)}"
            html, images[name] = report_figures.figure(said, name)
            made.append(html)
    return "".join(made), images


def _group_id(key):
    return identity("figures", *key) if any(key) else "figures.all"


def _group_name(key):
    return ", ".join(filter(None, key)) or "the whole study"


def _quality(known):
    made = [
        quality.session(session["said"], session["facts"], session["found"], session["takes"])
        for session in known
    ]
    if not made:
        return ""
    about = "How the marks are set; a warning of the study itself asks for a look at least."
    return f"<details><summary>{about}</summary>{quality.limits()}</details>{''.join(made)}"
