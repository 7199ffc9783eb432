"""The first page of the report, for a coach: what was measured in each take, how surely, what to look at."""

import math

from courtside.pages.page import text
from courtside.pages.report import warnings as warned

# Shape and word say what the colour says.
LIGHTS = {
    warned.GOOD: ("good", "●", "Good"),
    warned.LOOK: ("look", "▲", "Look"),
    warned.DOUBT: ("doubt", "■", "Doubt"),
}
ANGLES = {
    "knee_flexion": "knee, bend",
    "elbow_flexion": "elbow, bend",
    "hip_flexion": "hip, bend",
    "shoulder_elevation": "arm, raised from the trunk",
    "trunk_lean": "trunk, lean from upright",
    "trunk_lean_forward": "trunk, lean forwards",
}
DEGREES = "&deg;"


def light(level, words=""):
    """Return the mark of a level, as a shape, a colour and a word; `words` stand in place of the word."""
    name, shape, word = LIGHTS[level]
    return f'<span class="light {name}"><span aria-hidden="true">{shape}</span> {text(words or word)}</span>'


def with_error(value, half, unit):
    """Return a number with its error bar, as exact as the error allows; HTML.

    Parameters
    ----------
    value : float
    half : float
        Half of the interval that holds nine errors in ten; NaN where not known.
    unit : str
        m, m/s, degrees ...
    """
    if math.isnan(value):
        return "not known"
    known = math.isfinite(half) and half > 0
    size = half if known else max(abs(value) / 100, 1e-3)
    digits = min(max(0, 1 - math.floor(math.log10(size))), 3)
    sign = DEGREES if unit == "degrees" else f" {text(unit)}"
    number = f"{value:.{digits}f}".replace("-", "&minus;")
    return f"{number} &plusmn; {half:.{digits}f}{sign}" if known else f"{number}{sign}"


def take(said, facts, found, figures_id=None):
    """Return one take as HTML: its light, what was measured of each person, what to look at.

    Parameters
    ----------
    said : dict
        `id`, `name`, `links` ([(address, words)]) of the take.
    facts : dict
        As `facts.of_take` returns it.
    found : list of courtside.pages.report.warnings.Warned
    figures_id : str, optional
        Where its figures are on the page.
    """
    body = "".join(
        _person(person, measures, facts) for person, measures in facts["persons"].items()
    )
    if not facts["persons"]:
        body = _devices(facts)
    links = [f'<a href="{text(address)}">{text(words)}</a>' for address, words in said["links"]]
    links += [f'<a href="#{text(figures_id)}">figures</a>'] if figures_id else []
    more = f'<p class="links">{" &middot; ".join(links)}</p>' if links else ""
    head = f"<h4>{text(said['name'])} {light(warned.worst(found))}</h4>"
    return f'<article class="take" id="{text(said["id"])}">{head}{body}{warnings(found)}{more}</article>'


def warnings(found):
    """Return warnings as an HTML list, those worth knowing only folded away."""
    serious = [item for item in found if item.level > warned.GOOD]
    rest = [item for item in found if item.level == warned.GOOD]
    made = _items(serious)
    if rest:
        made += f"<details><summary>Worth knowing ({len(rest)})</summary>{_items(rest)}</details>"
    return made


def withheld(lines):
    """Return what is not made for want of consent, as an HTML paragraph; nothing where all is."""
    return f"<p class='soft'>Left out: {text('; '.join(lines))}.</p>" if lines else ""


def _items(found):
    if not found:
        return ""
    items = "".join(f"<li>{light(item.level)} {text(item.text)}</li>" for item in found)
    return f'<ul class="warnings">{items}</ul>'


def _person(person, measures, facts):
    """Return one person: a sentence, true values where there are any, a table of angles."""
    said = [f"<b>{text(person)}</b>"]
    distance = measures.get("neck_distance")
    if distance and not math.isnan(distance[0]):
        over = f" in {facts['seconds']:.1f} s" if facts["seconds"] else ""
        said.append(f"the neck travelled <b>{with_error(*distance[:3])}</b>{over}")
    for name, words in (("neck_speed_mean", "mean speed"), ("neck_speed_max", "largest speed")):
        if name in measures:
            said.append(f"{words} <b>{with_error(*measures[name][:3])}</b>")
    if facts["left_out"].get(person):
        lost, total, _ = facts["left_out"][person]
        said.append(f"from {total - lost} of {total} frames")
    known = ", ".join(said[1:]) or "nothing could be measured"
    return f"<p>{said[0]}: {known}.{_true(person, facts)}</p>{_angles(measures)}"


def _true(person, facts):
    """Return what a simulated session knows better; nothing of a real one."""
    for row in facts["true_paths"]:
        off = row["distance_error_percent"]
        if row["person"] == person and row["point"] == "neck" and not math.isnan(off):
            way = "long" if off > 0 else "short"
            return f" The truth of this simulated take is known: the distance is {abs(off):.1f} % too {way}."
    return ""


def _angles(measures):
    rows = []
    for name, words in ANGLES.items():
        for side in ("", "left_", "right_"):
            low, high = (measures.get(f"{side}{name}_{end}") for end in ("min", "max"))
            if low and high:
                joint = f"{side.rstrip('_')} {words}".strip()
                cells = f"<td>{with_error(*low[:3])}</td><td>{with_error(*high[:3])}</td>"
                rows.append(f"<tr><th scope='row'>{text(joint)}</th>{cells}</tr>")
    if not rows:
        return ""
    head = "<tr><th>joint angle</th><th>smallest</th><th>largest</th></tr>"
    table = f"<table><thead>{head}</thead><tbody>{''.join(rows)}</tbody></table>"
    return f"<details><summary>Joint angles</summary>{scrolling(table, 'joint angles')}</details>"


def _devices(facts):
    """Return what is said of a take without fixed cameras."""
    names = ", ".join(str(row["source"]) for row in facts["devices"])
    if not names:
        return "<p>Nobody was measured by fixed cameras.</p>"
    return f"<p>No fixed cameras: skeletons of {text(names)}, compared in the figures.</p>"


def scrolling(table, label):
    """Return a table that scrolls by itself where the window is too narrow, by keys too.

    Parameters
    ----------
    table, label : str
        HTML; what it holds, in words.
    """
    return (
        f'<div class="scroll" tabindex="0" role="region" aria-label="{text(label)}">{table}</div>'
    )
