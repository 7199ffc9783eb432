"""Draw errors with two, three and four cameras: evaluations of takes -> figure, CSV."""

from courtside.figures import players_table, style, three_cameras
from courtside.study import log


def main(errors_csv, kinematics_csv, pdf, png, csv, *, cameras):
    parts = players_table.read(errors_csv), players_table.read(kinematics_csv)
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
