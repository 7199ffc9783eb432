"""The report of a study: what was measured, all figures, the quality of each session, methods."""

from markupsafe import Markup

from courtside.pages import page
from courtside.pages.report import coach, figures, methods, quality, warnings
from courtside.pages.report import facts as report_facts
from courtside.pages.report.figures import identity


def build(study: dict) -> str:
    """Return the report, to be written by `page.write`; `InputError` if a file is missing or odd.

    `study` has `title`; `parameters` (the steps as configured); `sessions`, each with `name`,
    `description`, `virtual`, `calibration` (of its takes), `mapper`, `n_images`, `fusion`, `model`,
    `imported`, `overrides`, `limits` (`max_shift_px`, `max_zoom_percent`), perhaps `withheld`
    (lines that say what is missing for lack of consent) and `links` (address, words), `files` (of
    `facts.of_session`) and `takes`, each with `name`, `fusion`, `links` and `files` (of
    `facts.of_take`); `figures` as `figures.figure` takes them, with `take`; `tables` as
    `figures.table` takes them.
    """
    known = [_read(session) for session in study["sessions"]]
    grouped = figures.groups(study["figures"], [one["configured"]["name"] for one in known])
    drawn, images = _figures(grouped)
    reported = [one for one in known if one["takes"] or one["withheld"]]
    places = [(one["place"], one["configured"]["name"]) for one in reported]
    parts = [
        ("measured", "What was measured", _measured(known, reported, grouped), places),
        ("figures", "Figures", drawn, [(_group_id(key), _group_name(key)) for key in grouped]),
        ("quality", "How far to trust it", *_quality(known)),
        ("tables", "Tables", Markup().join(map(figures.table, study["tables"])), []),
        ("methods", "Methods", _methods(study, known), []),
    ]
    body = page.render("report.html", title=study["title"], parts=[one for one in parts if one[2]])
    return page.build(study["title"], body, css=["report.css"], js=["report.js"], images=images)


def _read(session: dict) -> dict:
    """Return what is known of a session: its facts and warnings, and those of its takes."""
    facts = report_facts.of_session(session["files"])
    found = warnings.of_session(facts, session["calibration"], **session["limits"])
    takes = []
    for take in session["takes"]:
        read = report_facts.of_take(take["files"])
        configured = {**take, "id": identity("take", session["name"], take["name"])}
        takes.append((configured, read, warnings.of_take(read, **session["limits"])))
    return {
        "configured": {**session, "id": identity("quality", session["name"])},
        "place": identity("session", session["name"]),
        "withheld": session.get("withheld", ()),
        "facts": facts,
        "found": found,
        "level": warnings.worst(found),
        "takes": takes,
    }


def _measured(known: list[dict], reported: list[dict], grouped: figures.Groups) -> Markup:
    """Return a table of all takes at a glance, then every take in words."""
    sessions = []
    for session in reported:
        written = []
        for take, facts, found in session["takes"]:
            key = (session["configured"]["name"], take["name"])
            figures_id = _group_id(key) if key in grouped else None
            written.append(coach.take(take, facts, found, figures_id))
        sessions.append(session | {"written": written})
    glance = [
        (session, take, warnings.worst(found), person, measures)
        for session in known
        for take, facts, found in session["takes"]
        for person, measures in facts["persons"].items()
    ]
    look = {"glance": glance, "with_error": coach.with_error}
    return page.render("report_measured.html", sessions=sessions, **look)


def _methods(study: dict, known: list[dict]) -> Markup:
    used_hz = {
        (session["configured"]["name"], take["name"]): facts["cutoffs"]
        for session in known
        for take, facts, _ in session["takes"]
    }
    told = [session["configured"] | _told(session) for session in known]
    return methods.paragraphs(study["parameters"], told, used_hz)


def _told(session: dict) -> dict[str, bool]:
    """Return what the methods need of the quality of a session's calibrations."""
    qualities, used = session["facts"]["quality"], session["configured"]["calibration"]
    known = used in qualities and warnings.has_covariance(used, qualities[used])
    return {"clicked": quality.clicked(qualities), "has_covariance": known}


def _figures(grouped: figures.Groups) -> tuple[Markup, dict[str, tuple[bytes, str]]]:
    groups: list[dict] = []
    images: dict[str, tuple[bytes, str]] = {}
    for key, group in grouped.items():
        drawn = []
        for entry in group:
            name = f"figure-{len(images)}"
            html, png = figures.figure(entry, name)
            images[name] = (png, page.PNG)
            drawn.append(html)
        groups.append({"id": _group_id(key), "name": _group_name(key), "figures": drawn})
    return page.render("report_figures.html", groups=groups), images


def _group_id(key: tuple[str, str]) -> str:
    return identity("figures", *key) if any(key) else "figures.all"


def _group_name(key: tuple[str, str]) -> str:
    return ", ".join(filter(None, key)) or "the whole study"


def _quality(known: list[dict]) -> tuple[Markup, list[tuple[str, str]]]:
    """Return the quality of all sessions as HTML, and where each stands: (id, name)."""
    sessions = [quality.session(s["configured"], s["facts"], s["found"], s["takes"]) for s in known]
    html = page.render("report_qualities.html", sessions=sessions, limits=quality.limits())
    return html, [(session["configured"]["id"], session["configured"]["name"]) for session in known]
