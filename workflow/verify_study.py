"""Say which files of a study would come out otherwise now, and why: `python workflow/verify_study.py`.

It computes again the checksums of raw inputs, artefacts, networks, lock and code, and compares them with what
the sidecars in results/run say. With `--against OTHER/results` it compares two results trees file by file
instead: bit-equal, equal within the tolerances that courtside/study/comparison.py states, or different. The
exit status is 1 if anything is otherwise.
"""

import argparse
import os
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(REPOSITORY / "workflow" / "lib"))

from courtside.study import comparison, verification  # noqa: E402
from courtside.study.errors import InputError  # noqa: E402

RESULTS = Path("results")


def main(against):
    """Return (lines to print, number of files that are otherwise)."""
    if not RESULTS.is_dir():
        raise InputError(
            f"{Path.cwd()}: expected a folder {RESULTS}, found none; "
            "go where the study ran, or give --directory"
        )
    if against is None:
        return verification.report(RESULTS / "run", RESULTS, REPOSITORY)
    if not against.is_dir():
        raise InputError(f"{against}: expected a folder of results, found none; correct --against")
    verdicts = comparison.compare(RESULTS, against)
    return comparison.table(verdicts), sum(v.outcome in comparison.FAULTS for v in verdicts)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--directory", type=Path, default=Path(), help="where the study ran")
    parser.add_argument(
        "--against", type=Path, help="another results folder, say of another machine"
    )
    given = parser.parse_args()
    other = given.against.resolve() if given.against else None
    try:
        os.chdir(given.directory)
        lines, n_faults = main(other)
    except (InputError, OSError) as error:
        sys.exit(f"Error: {error}")
    print("\n".join(lines))
    sys.exit(1 if n_faults else 0)
