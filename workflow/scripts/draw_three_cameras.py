"""Draw errors with two, three and four cameras: evaluations of takes -> figure, CSV."""

from courtside.evaluation.tables import players
from courtside.figures.badminton import three_cameras
from courtside.figures.style import style
from courtside.study.execution import log


def main(errors_csv, kinematics_csv, pdf, png, csv, *, cameras):
    parts = players.read(errors_csv), players.read(kinematics_csv)
    numbers = three_cameras.table(*parts)
    style.save(three_cameras.draw(numbers, cameras), numbers, pdf, png, csv)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.errors,
        snakemake.input.kinematics,
        snakemake.output.pdf,
        snakemake.output.png,
        snakemake.output.csv,
        cameras=snakemake.params.cameras,
    )
