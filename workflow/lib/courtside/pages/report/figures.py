"""Figures of the report with their captions, and CSV files as tables."""

import math
import re
from collections.abc import Iterable
from pathlib import Path

import pandas as pd
from markupsafe import Markup

from courtside.pages import page, pictures
from courtside.pages.report import captions, columns
from courtside.records import tables
from courtside.study.errors import InputError

NUMBER = re.compile(r"-?\d+(\.\d*)?(e[+-]?\d+)?")
# Columns of names that a user gives, as 2026_03, 1e3 or 007: no numbers.
NAMES = (*tables.LABELS, "calibration", "model", "preset", "layout")
TITLES = {
    "overlay": "What the network saw, and the reconstruction",
    "skeletons": "Skeletons and cameras",
    "reprojection": "Reprojection errors",
    "visibility": "Confidence, and cameras per joint",
    "kinematics": "Paths, speeds, angles",
    "footwork": "Footwork: where and when the feet stood",
    "rally": "Rally: strokes and steps over time",
    "strokes": "Strokes laid over one another",
    "shake": "Camera shake",
    "three_cameras": "Two, three and four cameras against the truth",
    "error_map": "Expected error over the court",
    "coverage": "Coverage of the error bars",
    "growth": "Time of each step",
    "court_points": "Court points",
    "clock_errors": "Errors of clocks against the truth",
    "reliability": "How far stated errors of joints hold",
    "agreement": "Agreement of two networks",
    "archive": "One subject over sessions",
    "wrist_distance": "Distance of the wrists, and claps",
    "wrist_arcs": "Wrists from T-pose to clap",
    "skeleton_plates": "Skeletons of all sources",
    "source_errors": "Errors of each source against the truth",
    "smoothness": "Smoothness and accuracy",
}
PLANNED = {
    "growth": "Expected error and number of pictures of the walk",
    "map": "Expected error over the court",
}
PLANS = "planned sessions"  # where the figures of plans belong
PAPERS = {
    "badminton_fig": "Shishido & Kitahara 2020, figure",
    "badminton_tab": "Shishido & Kitahara 2020, table",
    "thesis_fig": "Homma 2023, figure",
}

FOUR_DIGITS = 1000  # before the point

Groups = dict[tuple[str, str], list[dict]]  # figures by session and take


def title(stem: str, planned: bool = False) -> tuple[str, str]:
    """Return the heading of a figure, and how it was made, from the name of its file.

    Such as `overlay.sfm-n40.all-robust.blazepose-full`; a `planned` session has headings of its
    own.
    """
    name, _, way = stem.partition(".")
    for start, words in PAPERS.items():
        if name.startswith(start):
            number = name.removeprefix(start).replace("_", ".").lstrip("0")
            return f"{words} {number}", way
    titles = PLANNED if planned else TITLES
    return titles.get(name, name.replace("_", " ").replace("-", " ").capitalize()), way


def figure(entry: dict, name: str) -> tuple[Markup, bytes]:
    """Return a figure as HTML, and its picture as PNG; `InputError` if this cannot be read.

    `entry` has `png` and `caption` (paths), `wildcards`, `params`, `session` and `links`
    ([(address, words)]); `name` is that of the picture on the page.
    """
    try:
        png, size = pictures.shrunk(Path(entry["png"]).read_bytes())
    except OSError as error:
        raise InputError(f"{entry['png']}: expected a PNG, found: {error}; draw it again") from None
    source = Path(entry["caption"]).read_text(encoding="utf-8")
    heading, way = title(Path(entry["png"]).stem, entry["session"] == PLANS)
    html = page.render(
        "report_figure.html",
        name=name,
        size=size,
        heading=heading,
        way=way,
        caption=captions.render(source, entry["wildcards"], entry["params"]),
        places=entry["links"],
    )
    return html, png


def groups(figures: Iterable[dict], sessions: Iterable[str]) -> Groups:
    """Return figures by (session, take), in the order of the sessions; those of no session last.

    Each has `session` and `take`, empty if it belongs to none.
    """
    order = {name: at for at, name in enumerate(sessions)}

    def place(entry: dict) -> tuple[int, bool]:
        return order.get(entry["session"], len(order)), bool(entry["take"])

    found: Groups = {}
    for entry in sorted(figures, key=place):
        found.setdefault((entry["session"], entry["take"]), []).append(entry)
    return found


def identity(*parts: str) -> str:
    """Return an id of the page that an address may hold."""
    return re.sub(r"[^a-z0-9_.-]+", "-", ".".join(filter(None, parts)).lower())


def table(entry: dict) -> Markup:
    """Return a CSV file as HTML, folded away, without the columns that are empty throughout.

    Columns have headings in words; one that differs from its name in the file has it as a tip.
    `entry` has `file` (path), `title`, `words` and `link` (address).
    """
    found = pd.read_csv(entry["file"], dtype=str, keep_default_na=False)
    found = found.loc[:, (found != "").any()]
    head = [(name, columns.words(Path(entry["file"]).stem, name)) for name in found]
    named = [name in NAMES for name in found]
    cells = [
        [(value, False) if name else _cell(value) for value, name in zip(row, named, strict=True)]
        for row in found.to_numpy()
    ]
    return page.render("report_table.html", entry=entry, head=head, rows=cells)


def _cell(value: str) -> tuple[str, bool]:
    """Return a value, fractions with four digits or to whole numbers, and whether it is one."""
    if not NUMBER.fullmatch(value):
        return value, False
    number = float(value)
    if value.isdigit():  # a name such as 01 keeps its zero
        return value, True
    whole = number.is_integer() or FOUR_DIGITS <= abs(number) < math.inf
    return (f"{number + 0.0:.0f}" if whole else f"{number:.4g}"), True
