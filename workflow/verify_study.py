"""List the files of a study that are out of date, and why.

Usage: `python workflow/verify_study.py`.

It computes again the checksums of raw inputs, artefacts, networks, lock and code, asks Snakemake
which settings the jobs would have, and compares these with what the sidecars in results/run say.
Recordings that are not here are told apart from those that changed. With `--against OTHER/results`
it compares two results trees file by file instead: bit-equal, equal within the tolerances of
courtside/study/provenance/comparison.py, or different. The exit status is 1 if anything differs,
and 3 if nothing does but something cannot be compared: recordings that are not here, for instance.

Two machines that cannot reach each other's files compare checksums: `--write-checksums TABLE.csv`
on one of them, `--against TABLE.csv` on the other. It counts the files of each stage that are
bit-equal and names the first stage that is not. Pose networks give bit-equal keypoints with
`detect_pose: providers: [cpu]`, the default, only: by cuda and others they differ a little.

It also counts the numbers of README.md and docs/measured/ that these results would change;
`--numbers` lists them, as they are printed and as they would be, and its exit status is 1 if there
is one.
"""

import argparse
import os
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(REPOSITORY / "workflow" / "lib"))

from courtside.study import installed

installed.require()

from courtside.evaluation.numbers import study as numbers
from courtside.study.errors import InputError
from courtside.study.provenance import comparison, stage_checksums, verification
from courtside.study.targets import numbers as tables

RESULTS = Path("results")
DIFFERENT, NOT_COMPARED = 1, 3  # exit status


def main(against):
    """Return (lines to print, exit status)."""
    check_results()
    if against is None:
        lines, n_faults, n_unseen = verification.report(RESULTS / "run", RESULTS, REPOSITORY)
        status = DIFFERENT if n_faults else NOT_COMPARED if n_unseen else 0
        return [*lines, numbers_in_short()], status
    if against.is_file():
        own, other = stage_checksums.measure(RESULTS), stage_checksums.read(against)
        lines, n_faults = stage_checksums.table(own, other)
        return lines, DIFFERENT if n_faults else 0
    if not against.is_dir():
        raise InputError(
            f"{against}: expected a folder of results or a table of checksums, found neither; "
            "correct --against"
        )
    verdicts = comparison.compare(RESULTS, against)
    is_different = any(v.outcome in comparison.FAULTS for v in verdicts)
    return comparison.table(verdicts), DIFFERENT if is_different else 0


def check_results():
    """Refuse a folder without results."""
    if not RESULTS.is_dir():
        raise InputError(
            f"{Path.cwd()}: expected a folder {RESULTS}, found none; "
            "go where the study ran, or give --directory"
        )


def numbers_in_short():
    """Return how many numbers of the documents are stale; a study other than the default has none.

    They are no fault of the results: the documents are of another run.
    """
    try:
        n_stale = len(numbers.report(RESULTS, REPOSITORY, tables.made(REPOSITORY)))
    except (InputError, OSError):
        return (
            f"{numbers.REGISTER}: not compared, because it is of a full default run; --numbers "
            "says what was found"
        )
    return f"{numbers.REGISTER}: {n_stale} numbers would change" + (
        "; --numbers lists them" if n_stale else ""
    )


def stale_numbers():
    """Return (a line for each stale number, exit status)."""
    check_results()
    lines = numbers.report(RESULTS, REPOSITORY, tables.made(REPOSITORY))
    if not lines:
        return [f"{numbers.REGISTER}: all numbers are those of these results"], 0
    return lines, DIFFERENT


def write_checksums(table):
    """Write the table to compare another machine's results with; return (lines to print, 0)."""
    check_results()
    rows = stage_checksums.measure(RESULTS)
    stage_checksums.write(table, rows)
    return [f"{table}: checksums of {len(rows)} files"], 0


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=" ".join(__doc__.split("\n\n")[:2]))
    parser.add_argument("--directory", type=Path, default=Path(), help="where the study ran")
    parser.add_argument(
        "--against", type=Path, help="another results folder, or a table of its checksums"
    )
    parser.add_argument("--write-checksums", type=Path, help="write such a table (CSV), and end")
    parser.add_argument(
        "--numbers", action="store_true", help="list the stale numbers of the documents, and end"
    )
    given = parser.parse_args()
    other = given.against.resolve() if given.against else None
    table = given.write_checksums.resolve() if given.write_checksums else None
    try:
        os.chdir(given.directory)
        if given.numbers:
            lines, status = stale_numbers()
        else:
            lines, status = write_checksums(table) if table else main(other)
    except (InputError, OSError) as error:
        sys.exit(f"Error: {error}")
    print("\n".join(lines))
    sys.exit(status)
