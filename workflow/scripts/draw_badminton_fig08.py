"""Draw errors by number of bridging images: evaluations of one session -> figure, CSV."""

from courtside.evaluation.tables import calibration
from courtside.figures.badminton import fig08
from courtside.figures.style import style
from courtside.study.execution.script import run


def main(errors_csv, pdf, png, csv):
    rows = calibration.read(errors_csv)
    layout = rows["layout"].iloc[0]
    numbers = fig08.table(rows, layout)
    title = f"{rows['session'].iloc[0]}: {rows['preset'].iloc[0]} hall, layout {layout}"
    style.save(fig08.draw(numbers, title, layout), numbers, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
