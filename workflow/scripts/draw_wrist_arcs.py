"""Draw the wrists' arcs of all sources side by side: paths, distortion -> figure, CSV."""

from courtside.figures.devices import thesis_fig3
from courtside.figures.style import style
from courtside.records import tables
from courtside.study.execution.script import run


def main(paths_csv, distortion_csv, truth_csv, pdf, png, csv, *, kinds):
    paths = tables.read(paths_csv, "a table of paths")
    distortion = tables.read(distortion_csv, "a table of distortion")
    truth = tables.read(truth_csv, "a table of distortion") if truth_csv else None
    drawing = thesis_fig3.draw_all(paths, distortion, kinds=kinds, truth=truth)
    style.save(drawing, thesis_fig3.table(paths, distortion), pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
