"""Draw the comparisons: one panel each, processor time per unit against the amount of work."""

import matplotlib.ticker
import numpy as np

import rows
from courtside.figures.style import style
from courtside.study.execution.files import atomic

COLUMNS, HEIGHT_MM = 3, 75
MARKERS = "os^vDP"
MARGIN = 1.5  # of the axis of times, so that lines do not end at the frame


def draw(found, limits):
    """Return the figure.

    Parameters
    ----------
    found : pandas.DataFrame
        Of `rows.table`.
    limits : dict of str to str
        What the machine's least counts, by comparison.
    """
    names = list(dict.fromkeys(found["comparison"]))
    lines = -(-len(names) // COLUMNS)
    drawing = style.figure(HEIGHT_MM * lines)
    panels = drawing.subplots(lines, COLUMNS, squeeze=False).ravel()
    for panel, name in zip(panels, names, strict=False):
        _panel(panel, found[found["comparison"] == name], limits[name])
    for panel in panels[len(names) :]:
        panel.set_visible(False)
    return drawing


def _panel(panel, found, limit):
    unit = found["unit"].iloc[0]
    peers = 0
    for method, group in found.groupby("method", sort=False):
        ours = group["ours"].iloc[0]
        colour = style.CYCLE[0] if ours else style.CYCLE[1 + peers]
        marker = MARKERS[0] if ours else MARKERS[1 + peers]
        peers += not ours
        label = rows.OURS if ours else method
        panel.loglog(group["work"], group["us_per_unit"], marker=marker, markersize=4,
                     linewidth=2 if ours else 1, color=colour, label=label)  # fmt: skip
    least = found[found["ours"] & np.isfinite(found["limit_s"])]
    if len(least):
        panel.loglog(least["work"], 1e6 * least["limit_s"] / least["work"], ":", color="0.4",
                     label="machine's least" if "over" in limit else "without Snakemake",
                     )  # fmt: skip
    low, high = panel.get_ylim()
    panel.set_ylim(low / MARGIN, high * MARGIN)
    title = found["comparison"].iloc[0].replace(", ", ",\n")
    panel.set(title=title, xlabel=f"{unit}s", ylabel=f"CPU us per {unit}")
    panel.xaxis.set_minor_formatter(matplotlib.ticker.NullFormatter())
    panel.legend(fontsize=6, handlelength=1.5, loc="upper left", bbox_to_anchor=(0, -0.32))


def save(drawing, png, svg):
    """Write the figure, the same bytes for the same numbers."""
    with atomic(png) as temporary:
        drawing.savefig(temporary, metadata={"Software": None})
    with atomic(svg) as temporary:
        drawing.savefig(temporary, metadata={"Date": None, "Creator": None})
