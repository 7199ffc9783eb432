"""Where the real recordings lie; tests that use them are skipped where they are absent."""

from pathlib import Path

import pytest

REAL = Path(__file__).parents[2] / "shared" / "real"
needs_real = pytest.mark.skipif(
    not REAL.is_dir(), reason=f"real recordings are not at {REAL}: see tests/README.md"
)
