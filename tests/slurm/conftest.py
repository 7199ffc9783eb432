"""The tiny study on one machine, to compare with."""

from smoke.conftest import tiny_study

__all__ = ["tiny_study"]
