"""Draw the walked camera's estimated path by number of bridging images.

Reads ties and court; writes figure and CSV.
"""

import json
from pathlib import Path

from courtside.calibration.court import court
from courtside.calibration.records import tie_points
from courtside.figures.badminton import fig06
from courtside.figures.style import style
from courtside.study.execution.script import run


def main(ties_npz, summary_json, court_yaml, pdf, png, csv, *, n_images, mapper):
    rows = fig06.table(
        {count: tie_points.read(path) for count, path in zip(n_images, ties_npz, strict=True)}
    )
    n_all = {
        count: json.loads(Path(path).read_text(encoding="utf-8"))["n_images"]
        for count, path in zip(n_images, summary_json, strict=True)
    }
    drawing = fig06.draw(rows, court.read(court_yaml), n_all, mapper)
    style.save(drawing, rows, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
