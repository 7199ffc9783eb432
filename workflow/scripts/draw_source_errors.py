"""Draw the errors of all sources, of joint angles, and parts of errors: tables -> figure, CSV."""

from courtside.figures.devices import source_errors
from courtside.figures.style import style
from courtside.records import tables
from courtside.study.execution.script import run


def main(errors_csv, angles_csv, parts_csv, pdf, png, csv, *, kinds):
    parts = [tables.read(path, "a table of errors") for path in (errors_csv, angles_csv, parts_csv)]
    drawing = source_errors.draw(*parts, kinds=kinds)
    style.save(drawing, source_errors.table(*parts), pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
