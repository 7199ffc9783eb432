"""Draw the effect of unmodelled deviations: evaluations of sessions, quality -> figure, CSV."""

import json
from collections import Counter
from pathlib import Path

from courtside.evaluation.tables import calibration
from courtside.figures.calibration import worlds
from courtside.figures.style import style
from courtside.study.execution.script import run


def main(errors_csv, quality_json, pdf, png, csv):
    warnings = Counter()  # of each session
    for path in map(Path, quality_json):  # results/{session}/calibration/{calibration}/quality.json
        warnings[path.parts[-4]] += len(json.loads(path.read_text(encoding="utf-8"))["warnings"])
    rows = calibration.read(errors_csv)
    numbers = worlds.table(rows, warnings)
    style.save(worlds.draw(numbers), numbers, pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
