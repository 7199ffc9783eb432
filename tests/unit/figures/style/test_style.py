"""A figure has the same bytes whenever and wherever it is made."""

import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from courtside.figures.style import style

LIBRARY = Path(__file__).parents[4] / "workflow" / "lib"
# All parts of our figures: lines, points, bars with hatches, signs and Greek letters, pictures,
# filled areas, arrows, transparent collections, 3D axes, legends.
PROGRAM = """
import sys
sys.path.insert(0, {library!r})
import numpy as np
import pandas as pd
from courtside.figures.style import style
drawing = style.figure(120)
axes = drawing.subplots(2, 3)
x = np.linspace(0, 6, 50)
axes[0, 0].plot(x, np.sin(x), "--", label="a")
axes[0, 0].scatter(x, np.cos(x), c=x, cmap="viridis", alpha=0.5, label="b")
axes[0, 0].legend()
axes[0, 1].bar(["left", "right"], [1, -2], hatch="//", color=style.CYCLE[:2])
axes[0, 1].set_title("\u03b1 = \u22121 \u00b1 2 \u00b0, $x^2$ \u00b5m")
drawing.colorbar(axes[0, 2].imshow(np.outer(x, x)), ax=axes[0, 2])
axes[1, 0].fill_between(x, 0, x, alpha=0.3, rasterized=True)
axes[1, 0].annotate("here", (1, 1), (3, 5), arrowprops=dict(arrowstyle="->"))
axes[1, 1].hexbin(x, np.sin(x), gridsize=8)
axes[1, 1].errorbar(x[::9], x[::9], yerr=1, capsize=2)
axes[1, 2].remove()
cube = drawing.add_subplot(2, 3, 6, projection="3d")
cube.plot(x, np.sin(x), np.cos(x))
table = pd.DataFrame({{"x": [1.23456, None]}})
style.save(drawing, table, *[{folder!r} + "/f." + kind for kind in ("pdf", "png", "csv")])
"""


def drawn(folder, **environment):
    """Return the bytes of the three files, drawn by a process of its own."""
    program = PROGRAM.format(library=str(LIBRARY), folder=str(folder))
    folder.mkdir()
    subprocess.run(
        [sys.executable, "-c", program], check=True, cwd=folder, env={**os.environ, **environment}
    )
    return [(folder / f"f.{kind}").read_bytes() for kind in ("pdf", "png", "csv")]


@pytest.fixture(scope="module")
def both(tmp_path_factory):
    """Return the files of two processes with other environments, more than a second apart."""
    root = tmp_path_factory.mktemp("drawn")
    one = {"PYTHONHASHSEED": "1", "TZ": "UTC", "LC_ALL": "C", "COLUMNS": "80"}
    two = {"PYTHONHASHSEED": "2", "TZ": "Asia/Tokyo", "LC_ALL": "C.UTF-8", "COLUMNS": "200"}
    first = drawn(root / "one", **one)
    time.sleep(1.1)  # dates in files have whole seconds
    return first, drawn(root / "two", SOURCE_DATE_EPOCH="0", **two)


def test_two_processes_make_the_same_bytes(both):
    """Independent of the order of sets, time zone, language, date and width of the terminal."""
    assert both[0] == both[1]


def test_files_hold_neither_date_nor_program(both):
    pdf, png, csv = both[1]
    for word in (b"CreationDate", b"ModDate", b"Producer", b"/ID", b"1970"):
        assert word not in pdf
    for word in (b"tEXt", b"tIME", b"Matplotlib"):
        assert word not in png
    assert csv == b"x\n1.2346\n\n" or csv == b'x\n1.2346\n""\n'


@pytest.mark.parametrize(
    ("joint", "colour"),
    [("left_knee", style.LEFT), ("right_ear", style.RIGHT), ("nose", style.MIDDLE)],
)
def test_sides_have_colours(joint, colour):
    assert style.side_colour(joint) == colour


def test_the_layout_does_not_depend_on_the_last_digits_of_the_solver():
    drawing = style.figure(80)
    for part in drawing.subfigures(1, 2, width_ratios=(1, 2)):
        part.suptitle("Title")
        axes = part.subplots(2, 1)
        axes[0].set_ylabel("wide label")
    drawing.draw_without_rendering()
    boxes = [axes.get_position().bounds for axes in drawing.axes]
    boxes += [part.bbox_relative.bounds for part in drawing.subfigs]
    np.testing.assert_allclose(boxes, np.round(boxes, 6), rtol=0, atol=1e-15)
    assert len({round(x, 4) for x, *_ in boxes}) > 2  # it has been laid out
