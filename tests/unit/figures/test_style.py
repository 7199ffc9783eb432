"""A figure has the same bytes whenever and wherever it is made."""

import subprocess
import sys
from pathlib import Path

import pytest

from courtside.figures import style

LIBRARY = Path(__file__).parents[3] / "workflow" / "lib"
PROGRAM = """
import sys
sys.path.insert(0, {library!r})
import pandas as pd
from courtside.figures import style
drawing = style.figure(60)
drawing.subplots().plot([1, 2, 3], label="a")
table = pd.DataFrame({{"x": [1.23456, None]}})
style.save(drawing, table, *[{folder!r} + "/f." + kind for kind in ("pdf", "png", "csv")])
"""


def test_two_processes_make_the_same_bytes(tmp_path):
    contents = []
    for name in ("one", "two"):
        folder = tmp_path / name
        program = PROGRAM.format(library=str(LIBRARY), folder=str(folder))
        subprocess.run([sys.executable, "-c", program], check=True)
        contents.append([(folder / f"f.{kind}").read_bytes() for kind in ("pdf", "png", "csv")])
    assert contents[0] == contents[1]
    assert b"CreationDate" not in contents[0][0]
    assert contents[0][2] == b"x\n1.2346\n\n" or contents[0][2] == b'x\n1.2346\n""\n'


@pytest.mark.parametrize(
    ("joint", "colour"),
    [("left_knee", style.LEFT), ("right_ear", style.RIGHT), ("nose", style.MIDDLE)],
)
def test_sides_have_colours(joint, colour):
    assert style.side_colour(joint) == colour
