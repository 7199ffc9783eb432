"""Draw smoothness against accuracy.

Reads distortion of takes, and errors where a truth is known; writes figure and CSV.
"""

from courtside.figures.devices import smoothness_accuracy
from courtside.figures.style import style
from courtside.study.execution.script import run


def main(distortion_csv, errors_csv, truth_csv, pdf, png, csv, *, labels, kinds):
    rows = smoothness_accuracy.read(distortion_csv, labels, errors_csv, truth_csv)
    style.save(smoothness_accuracy.draw(rows, kinds=kinds), rows, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
