"""Draw figure 3.1 or 3.2 of the thesis: one source's wrist paths, distortion -> figure, CSV."""

from courtside.figures.devices import thesis_fig3
from courtside.figures.style import style
from courtside.records import tables
from courtside.study.execution.script import run


def main(paths_csv, distortion_csv, truth_csv, pdf, png, csv, *, source, kinds):
    paths = tables.read(paths_csv, "a table of paths")
    distortion = tables.read(distortion_csv, "a table of distortion")
    truth = tables.read(truth_csv, "a table of distortion") if truth_csv else None
    drawing = thesis_fig3.draw(paths, distortion, source, kinds=kinds, truth=truth)
    style.save(drawing, thesis_fig3.table(paths, distortion, [source]), pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
