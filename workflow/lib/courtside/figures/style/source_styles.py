"""How each source of motion is drawn: one colour for each kind, in all figures."""

from dataclasses import dataclass

from courtside.figures.style import style

COLOURS = {
    "inertial": style.CYCLE[0],
    "rgb": style.CYCLE[1],
    "rgbd": style.CYCLE[2],
    "nuitrack": style.CYCLE[3],
    "cameras": style.CYCLE[4],
    "corrected": style.CYCLE[5],
    "truth": style.CYCLE[6],
}
OTHER = "#888888"
ENDINGS = {"-rgb": "rgb", "-depth": "rgbd", "-corrected": "corrected"}
WHOLE = {"mocopi": "inertial", "nuitrack": "nuitrack", "cameras": "cameras", "truth": "truth"}
LINES, MARKERS = ("-", "--", "-.", ":"), "osD^v"


@dataclass(frozen=True)
class Look:
    """How one source is drawn.

    Attributes
    ----------
    kind : str
        One of `COLOURS`, or `other`.
    colour, line, marker : str
        Sources of one kind share the colour and differ in line and marker.
    """

    kind: str
    colour: str
    line: str
    marker: str


def kind_of(source, kinds=None):
    """Return the kind of a source.

    Parameters
    ----------
    source : str
        As in the tables: `mocopi`, `d415-rgb`, `d415-depth`, `mocopi-corrected`, `cameras`, `truth`.
    kinds : dict of str to str, optional
        What the session says of it, by source or by device. Endings of names come first: a device of kind
        `rgbd` gives a source of kind `rgb`, too.

    Returns
    -------
    kind : str
        `other` if nothing tells.
    """
    for ending, kind in ENDINGS.items():
        if source.endswith(ending):
            return kind
    return (kinds or {}).get(source) or WHOLE.get(source, "other")


def looks(sources, kinds=None):
    """Return the look of each source, dict in the order given.

    Parameters
    ----------
    sources : iterable of str
        Repeated names count once.
    kinds : dict of str to str, optional
        As for `kind_of`.
    """
    found, count = {}, {}
    for source in dict.fromkeys(sources):
        kind = kind_of(source, kinds)
        at = count[kind] = count.get(kind, -1) + 1
        colour = COLOURS.get(kind, OTHER)
        found[source] = Look(kind, colour, LINES[at % len(LINES)], MARKERS[at % len(MARKERS)])
    return found
