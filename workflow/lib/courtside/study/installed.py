"""Whether the packages of environment.lock are there: a program started without them says so."""

import importlib.util
import sys

LIKELY_MISSING = ("numpy", "pandas", "scipy", "cv2", "yaml", "jsonschema", "av", "snakemake")


def require() -> None:
    """End the program with one line if packages are missing: nobody activated the environment."""
    missing = [name for name in LIKELY_MISSING if importlib.util.find_spec(name) is None]
    if missing:
        sys.exit(
            f"Error: {sys.executable}: expected a Python with the packages of environment.lock, "
            f"found no {', '.join(missing)}: activate the environment that README.md installs"
        )
