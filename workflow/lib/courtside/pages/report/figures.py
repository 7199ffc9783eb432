"""Figures and tables of the report: pictures with their captions, CSV files that scroll by themselves."""

import re
from pathlib import Path

from courtside.pages import pictures
from courtside.pages.page import text
from courtside.pages.report import captions, facts
from courtside.pages.report.coach import scrolling
from courtside.study.errors import InputError

TITLES = {
    "overlay": "What the network saw, and what was made of it",
    "skeletons": "Skeletons and cameras",
    "reprojection": "Do the views agree?",
    "visibility": "Confidence, and cameras per joint",
    "kinematics": "Paths, speeds, angles",
    "shake": "How the cameras shook",
    "three_cameras": "Two, three and four cameras against the truth",
    "error_map": "Expected error over the court",
    "coverage": "Do the error bars hold what they say?",
    "growth": "Time and memory",
    "court_points": "Points of the court",
    "clock_errors": "Clocks against the truth",
    "agreement": "May one network replace the other?",
    "archive": "One subject over sessions",
    "wrist_distance": "Claps and clocks",
    "wrist_arcs": "Wrists from T-pose to clap",
    "skeleton_plates": "What each source calls a body",
    "source_errors": "Each source against the truth",
    "smoothness": "Smooth is not accurate",
}
PLANNED = {
    "growth": "How many pictures of the walk are enough?",
    "map": "Expected error over the court",
}
PLANS = "planned sessions"  # where the figures of plans belong
PAPERS = {
    "badminton_fig": "Shishido & Kitahara 2020, figure",
    "badminton_tab": "Shishido & Kitahara 2020, table",
}
PAPERS |= {"thesis_fig": "Homma 2023, figure"}


def title(stem, planned=False):
    """Return the heading of a figure from the name of its file, and how it was made.

    Parameters
    ----------
    stem : str
        Such as `overlay.sfm-n40.all-robust.blazepose-full`.
    planned : bool
        Whether it is of a session that is only planned.

    Returns
    -------
    heading, way : str
        Words; the rest of the name.
    """
    name, _, way = stem.partition(".")
    for start, words in PAPERS.items():
        if name.startswith(start):
            number = name.removeprefix(start).replace("_", ".").lstrip("0")
            return f"{words} {number}", way
    titles = PLANNED if planned else TITLES
    return titles.get(name, name.replace("_", " ").replace("-", " ").capitalize()), way


def figure(said, name):
    """Return a figure as HTML, and its picture.

    Parameters
    ----------
    said : dict
        `png` and `caption` (paths), `wildcards`, `params`, `links` ([(address, words)]).
    name : str
        Of the picture on the page.

    Returns
    -------
    html : str
    png : bytes

    Raises
    ------
    InputError
        If the picture is missing or none.
    """
    try:
        png, (width, height) = pictures.shrunk(Path(said["png"]).read_bytes())
    except OSError as error:
        raise InputError(f"{said['png']}: expected a PNG, found: {error}; draw it again") from None
    source = Path(said["caption"]).read_text(encoding="utf-8")
    caption = captions.render(source, said["wildcards"], said["params"])
    heading, way = title(Path(said["png"]).stem, said["session"] == PLANS)
    links = " &middot; ".join(
        f'<a href="{text(a)}">{text(words)}</a>' for a, words in said["links"]
    )
    made = f'<code class="soft">{text(way)}</code> ' if way else ""
    return (
        f"<figure><h4>{text(heading)}</h4>"
        f'<img src="image:{name}" alt="{text(heading)}: described below" width="{width}" height="{height}">'
        f"<figcaption>{caption}<p>{made}{links}</p></figcaption></figure>"
    ), png


def groups(figures, sessions):
    """Return figures by where they belong: {(session, take): figures}, those of no session last.

    Parameters
    ----------
    figures : list of dict
        Each with `session` and `take`, empty where it belongs to none.
    sessions : list of str
        In the order of the report.
    """
    order = {name: at for at, name in enumerate(sessions)}
    found = {}
    for said in sorted(
        figures, key=lambda one: (order.get(one["session"], len(order)), bool(one["take"]))
    ):
        found.setdefault((said["session"], said["take"]), []).append(said)
    return found


def identity(*parts):
    """Return a name for a place on the page that an address may hold."""
    return re.sub(r"[^a-z0-9_.-]+", "-", ".".join(filter(None, parts)).lower())


def table(said):
    """Return a CSV file as HTML: columns that are empty throughout left out, folded away.

    Parameters
    ----------
    said : dict
        `file` (path), `title`, `words`, `link` (address).
    """
    columns, rows = facts.whole_table(said["file"])
    full = [at for at, _ in enumerate(columns) if any(row[at] for row in rows)]
    head = "".join(f"<th scope='col'>{text(columns[at].replace('_', ' '))}</th>" for at in full)
    body = "".join(f"<tr>{''.join(_cell(row[at]) for at in full)}</tr>" for row in rows)
    made = f"<table class='dense'><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
    count = f"{len(rows)} rows" if len(rows) != 1 else "1 row"
    return (
        f"<h3>{text(said['title'])}</h3><p>{text(said['words'])} "
        f'<a href="{text(said["link"])}">The file</a>.</p>'
        f"<details><summary>{count}, {len(full)} columns</summary>"
        f"{scrolling(made, said['title']).replace('scroll', 'scroll tall', 1)}</details>"
    )


def _cell(value):
    try:
        number = float(value)
    except ValueError:
        return f"<td>{text(value)}</td>"
    short = value if number == int(number) and "." not in value else f"{number:.4g}"
    return f'<td class="number">{short}</td>'
