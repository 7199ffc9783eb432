"""Write the tables of README.md and docs/measured/, and their register docs/numbers.csv.

`snakemake`, then `python docs/make_tables.py [results]`. With `--documents` the tables are written
from the register as it is, without results.
"""

import argparse
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "workflow" / "lib"))

from courtside.evaluation.numbers import study
from courtside.study.errors import InputError
from courtside.study.targets import numbers as tables


def main(results, documents_only):
    """Return the lines to print."""
    found = study.kept(ROOT) if documents_only else study.numbers(results, ROOT, tables.made(ROOT))
    changed = study.write(found, ROOT)
    return [f"{len(found)} numbers; changed: {', '.join(changed) or 'nothing'}"]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument(
        "results",
        type=Path,
        nargs="?",
        default=ROOT / "results",
        help="folder of a default run (default: results)",
    )
    parser.add_argument(
        "--documents",
        action="store_true",
        help="write the documents from docs/numbers.csv, without results",
    )
    given = parser.parse_args()
    try:
        print("\n".join(main(given.results, given.documents)))
    except (InputError, OSError) as error:
        sys.exit(f"Error: {error}")
