"""Boards that a session states: a size that no board has, lenses that no calibration reads."""

from collections.abc import Iterator, Mapping
from typing import Any

from courtside.study.configuration.sessions import Session

READERS = "`board` and `wand` (without `lenses`), `people` and `known18-board`"
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


def unread_lenses(session: Session) -> Iterator[str]:
    """Yield a line if no calibration that takes are measured with reads a camera's `chessboard`."""
    ways = session.take_calibrations() or session.calibrations()
    read = {camera for way in ways for camera in session.chessboards_of(way)}
    unread = [name for name, one in session.cameras.items() if one.chessboard and name not in read]
    if ways and unread:
        yield (
            f"cameras: the lenses from `chessboard` of {', '.join(unread)} are not used by "
            f"{', '.join(ways)}; {READERS} use them"
        )
