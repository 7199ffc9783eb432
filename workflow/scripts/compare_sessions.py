"""Compare the sessions of one subject: table of the study -> values, changes, figure."""

from courtside.figures.comparison import archive
from courtside.figures.style import style
from courtside.records import study_table, tables
from courtside.statistics import agreement, longitudinal
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(
    study_csv, agreement_csv, pdf, png, csv, *, ways, networks, subject, measures, allow_mixed
):
    rows = longitudinal.of_study(study_table.read(study_csv), ways)
    rows = longitudinal.of_subject(rows, subject, measures, allow_mixed=allow_mixed)
    models, known = rows["model"].unique(), None
    if agreement_csv and len(models) == 1:  # of several networks, their own repeats tell the errors
        table = tables.read(agreement_csv, "a table of agreement")
        known = agreement.detectable_of(table, networks, models[0])
    values = longitudinal.over_sessions(rows)
    changes = longitudinal.changes(values, longitudinal.errors_of_measurement(rows, known))
    log.logger.info("%s: %s", subject, changes["verdict"].value_counts().to_dict())
    numbers = archive.table(values, changes)
    style.save(archive.draw(numbers, subject), numbers, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
