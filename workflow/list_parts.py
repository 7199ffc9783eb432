"""List what the study is made of from outside, as CycloneDX.

Usage: `python workflow/list_parts.py > sbom.json`.

Packages of environment.lock and artefacts of config/external.yaml, with versions, checksums and
licences.
"""

import argparse
import json
import sys
import tomllib
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(REPOSITORY / "workflow" / "lib"))

from courtside.study import installed

installed.require()

from courtside.study.errors import InputError
from courtside.study.execution import artefacts, files
from courtside.study.provenance import sbom


def main(repository):
    """Return the list of parts of a repository."""
    about = tomllib.loads((repository / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return sbom.of_study(
        (repository / "environment.lock").read_text(encoding="utf-8"),
        artefacts.read(repository / "config" / "external.yaml").values(),
        name=about["name"],
        version=about["version"],
        licence=about["license"],
    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=" ".join(__doc__.split("\n\n")[:2]))
    parser.add_argument("--output", type=Path, help="a file, such as results/sbom.json")
    given = parser.parse_args()
    try:
        listed = main(REPOSITORY)
        if given.output:
            files.write_json(given.output, listed)
        else:
            print(json.dumps(listed, indent=2, ensure_ascii=False))
    except (InputError, OSError) as error:
        sys.exit(f"Error: {error}")
