"""Draw how a condition of filming changes the error: evaluations of its sessions -> figure, CSV."""

from courtside.evaluation.tables import calibration
from courtside.figures.calibration import conditions
from courtside.figures.style import style
from courtside.study.execution.script import run


def main(errors_csv, pdf, png, csv, *, x, group, n_bridging):
    rows = calibration.read(errors_csv)
    numbers = conditions.table(rows, x, group, n_bridging)
    about = [f"{rows['preset'].iloc[0]} hall, layout {rows['layout'].iloc[0]}"]
    about += [] if n_bridging is None else [f"N = {n_bridging}"]
    style.save(conditions.draw(numbers, x, group, ", ".join(about)), numbers, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
