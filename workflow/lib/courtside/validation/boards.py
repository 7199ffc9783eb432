"""Boards that a session states: a size that no board has."""

from collections.abc import Iterator, Mapping
from typing import Any

BOARD_M = (0.05, 2.0)  # ASSUME: longer side of boards that people print and hold


def remarks(board: Mapping[str, Any] | None) -> Iterator[str]:
    """Yield one line if a board is smaller or larger than boards are."""
    if board is None:
        return
    (columns, rows), square_m = board["squares"], board["square_m"]
    if not BOARD_M[0] <= max(columns, rows) * square_m <= BOARD_M[1]:
        yield (
            f"board: expected a longer side of {BOARD_M[0]:g} to {BOARD_M[1]:g} m, found a board "
            f"of {columns * square_m:.3g} x {rows * square_m:.3g} m ({columns} x {rows} times "
            f"{square_m:g} m): check square_m, which is in m"
        )
