"""Every input format under seeded mutation: a value or one clear line, soon, and nothing else."""

import sys
from pathlib import Path

_UNIT = Path(__file__).parents[1] / "unit"
# What the unit tests make their files with.
sys.path += [str(_UNIT / room) for room in ("devices", "pose", "sfm")]
