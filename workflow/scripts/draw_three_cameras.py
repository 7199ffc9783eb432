"""Draw errors with two, three and four cameras: evaluations of takes -> figure, CSV."""

from courtside.evaluation.tables import players
from courtside.figures.badminton import three_cameras
from courtside.figures.style import style
from courtside.study.execution.script import run


def main(errors_csv, kinematics_csv, pdf, png, csv, *, cameras):
    numbers = three_cameras.table(players.read(errors_csv), players.read(kinematics_csv))
    style.save(three_cameras.draw(numbers, cameras), numbers, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
