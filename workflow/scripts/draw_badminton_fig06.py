"""Draw the walked camera's estimated path by number of bridging images: ties, court -> figure, CSV."""

import json
from pathlib import Path

from courtside.calibration.court import court
from courtside.calibration.records import tie_points
from courtside.figures.badminton import fig06
from courtside.figures.style import style
from courtside.study.execution import log


def main(ties_npz, summary_json, court_yaml, pdf, png, csv):
    rows = fig06.table({count: tie_points.read(path) for count, path in ties_npz.items()})
    n_images = {
        count: json.loads(Path(path).read_text())["n_images"]
        for count, path in summary_json.items()
    }
    drawing = fig06.draw(rows, court.read(court_yaml), n_images)
    style.save(drawing, rows, pdf, png, csv)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        dict(zip(snakemake.params.n_images, snakemake.input.ties, strict=True)),
        dict(zip(snakemake.params.n_images, snakemake.input.summaries, strict=True)),
        snakemake.input.court,
        snakemake.output.pdf,
        snakemake.output.png,
        snakemake.output.csv,
    )
