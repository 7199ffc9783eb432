"""One look for all figures, and saving them with the numbers drawn."""

import matplotlib
from matplotlib.figure import Figure

from courtside.study.files import atomic

WIDTH_MM = 180
DOTS_PER_INCH = 150
MM_PER_INCH = 25.4
# Okabe & Ito 2008: told apart with any colour vision.
CYCLE = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]
LEFT, RIGHT, MIDDLE = "#0072B2", "#D55E00", "#666666"
DETECTED_BGR, REPROJECTED_BGR, REJECTED_BGR = (0, 255, 255), (255, 120, 0), (0, 0, 255)
SETTINGS = {
    "font.family": "DejaVu Sans",
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "pdf.fonttype": 42,
    "svg.hashsalt": "courtside",
}


def figure(height_mm):
    """Return an empty figure of page width.

    A `Figure` made without pyplot belongs to nobody else: no window, no global state.
    """
    matplotlib.rcParams.update(SETTINGS)
    size = (WIDTH_MM / MM_PER_INCH, height_mm / MM_PER_INCH)
    return Figure(figsize=size, dpi=DOTS_PER_INCH, layout="constrained")


def side_colour(joint):
    """Return the colour of a joint's body side."""
    if joint.startswith("left_"):
        return LEFT
    return RIGHT if joint.startswith("right_") else MIDDLE


def save(drawing, table, pdf, png, csv):
    """Write a figure and its numbers, the same bytes each time.

    Parameters
    ----------
    drawing : matplotlib.figure.Figure
    table : pandas.DataFrame
        What is drawn; float columns are kept to 4 decimals.
    pdf, png, csv : str or Path
    """
    with atomic(pdf) as temporary:
        drawing.savefig(
            temporary, metadata={"CreationDate": None, "Producer": None, "Creator": None}
        )
    with atomic(png) as temporary:
        drawing.savefig(temporary, metadata={"Software": None})
    with atomic(csv) as temporary:
        table.to_csv(temporary, index=False, float_format="%.4f", lineterminator="\n")
