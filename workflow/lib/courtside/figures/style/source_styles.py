"""The look of each source of motion: one colour for each kind, in all figures."""

from collections.abc import Iterable
from dataclasses import dataclass

from matplotlib.lines import Line2D

from courtside.figures.style import bars, style

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
MARKERS = "osD^v"


@dataclass(frozen=True)
class Look:
    """The look of one source; those of one kind share the colour, and differ in line and marker.

    `kind` is one of `COLOURS`, or `other`.
    """

    kind: str
    colour: str
    line: str
    marker: str


def kind_of(source: str, kinds: dict[str, str] | None = None) -> str:
    """Return the kind of a source such as `mocopi-corrected`, `other` if it is unknown.

    `kinds` are by source or by device, as the session states them. Endings of names come first: a
    device of kind `rgbd` also gives a source of kind `rgb`.
    """
    for ending, kind in ENDINGS.items():
        if source.endswith(ending):
            return kind
    return (kinds or {}).get(source) or WHOLE.get(source, "other")


def marks(shown: dict[str, Look]) -> list[Line2D]:
    """Return the marks of sources for a legend."""
    return [bars.mark(one.colour, marker=one.marker, label=name) for name, one in shown.items()]


def looks(sources: Iterable[str], kinds: dict[str, str] | None = None) -> dict[str, Look]:
    """Return the look of each source, in the order given; `kinds` as for `kind_of`."""
    found: dict[str, Look] = {}
    count: dict[str, int] = {}
    for source in dict.fromkeys(sources):
        kind = kind_of(source, kinds)
        at = count[kind] = count.get(kind, -1) + 1
        colour = COLOURS.get(kind, OTHER)
        line, marker = (looks[at % len(looks)] for looks in (style.LINES, MARKERS))
        found[source] = Look(kind, colour, line, marker)
    return found
