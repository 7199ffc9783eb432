"""Where the repository is that the benchmarks are a part of."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
