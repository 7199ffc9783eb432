"""Whether the packages of environment.lock are there: a program started without them says so."""

import importlib.util
import sys


def require() -> None:
    """End the program with one line if there is no numpy: nobody activated the environment."""
    if importlib.util.find_spec("numpy") is None:
        sys.exit(
            f"Error: {sys.executable}: expected a Python with the packages of environment.lock, "
            "found none of them: activate the environment that README.md installs"
        )
