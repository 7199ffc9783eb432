"""A flat calibration board of known size: its corners, and their detection in a picture."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.study.errors import InputError

LEAST_SQUARES = 4  # of a chessboard along one side: OpenCV finds no smaller ones
MARKER_SHARE = 0.75  # of a square, where the session does not say it: as most programs print them
# Of Kalibr's AprilGrid: family, cells of black around the bits, and the share as in its examples.
FAMILY, BORDER, GRID_SHARE = "DICT_APRILTAG_36h11", 2, 1 / 1.3
SADDLE_SHARE = 0.12  # of a tag: looked so far around its corners; its bits begin at 0.2
# Of a tag: looked so far from its edges, but this or more; its bits begin at 0.11 or more.
EDGE_SHARE, LEAST_REACH_PX = 0.06, 1.5
STEEPEST = 4  # rounds in which the steepest points of an edge stand still
Y_UP = np.array([1.0, -1.0, 1.0])  # OpenCV's boards have y down: with y up, z points at who looks


@dataclass(frozen=True)
class Board:
    """A ChArUco board, a chessboard, a grid of tags as OpenCV's `aruco` prints them, an AprilGrid.

    Kalibr's AprilGrid has tag 0 at the bottom left, wide borders and squares between the tags; its
    corners are numbered row by row from the bottom left, x to the right and y up from there
    (`GridCalibrationTargetAprilgrid`).

    Raises `InputError` if the board is impossible or rotationally symmetric.
    """

    kind: str  # "charuco", "chessboard", "tags" or "aprilgrid"
    squares: tuple[int, int]  # columns and rows; of tags: these
    square_m: float  # side of a square; of tags: from one tag to the next
    marker_m: float  # side of a marker or tag
    dictionary: str | None = None  # of markers, as OpenCV calls it
    inverted: bool = False  # whether black and white are exchanged
    legacy: bool = False  # a ChArUco board of OpenCV before 4.6 with an even number of rows
    square_sigma_m: float = 0.0  # standard deviation of `square_m`, as of all its lengths

    @classmethod
    def of(cls, given: Mapping[str, Any]) -> "Board":
        """Build a board from the keys of a session."""
        grid = given["kind"] == "aprilgrid"
        name = given.get("dictionary", FAMILY if grid else None)
        if given["kind"] != "chessboard" and (name is None or not hasattr(cv2.aruco, name)):
            known = [key for key in dir(cv2.aruco) if key.startswith("DICT_")]
            raise InputError(
                f"board.dictionary: expected one of {', '.join(known)}, found {name}; it stands "
                "where the board was printed"
            )
        square_m = float(given["square_m"])
        marker_m = float(given.get("marker_m", (GRID_SHARE if grid else MARKER_SHARE) * square_m))
        columns, rows = given["squares"]
        made = cls(
            given["kind"],
            (columns, rows),
            square_m,
            marker_m,
            name,
            given.get("inverted", False),
            given.get("legacy", False),
            float(given.get("square_sigma_m", 0.0)),
        )
        if made.kind == "chessboard" and (columns - rows) % 2 == 0:
            raise InputError(
                f"board.squares: expected an odd and an even number of squares, found {columns} "
                f"and {rows}; such a chessboard looks the same when it is turned round: use another"
            )
        if made.kind == "chessboard" and min(columns, rows) < LEAST_SQUARES:
            raise InputError(
                f"board.squares: expected {LEAST_SQUARES} or more along both sides, found "
                f"{columns} and {rows}; count squares, not the corners between them"
            )
        if not 0 < marker_m < square_m:
            raise InputError(
                f"board.marker_m: expected less than square_m ({square_m:g}), found {marker_m:g}; "
                "measure both"
            )
        return made

    @cached_property
    def corners(self) -> NDArray:
        """The corners (N, 3) m by their numbers: x to the right, y up, z towards the viewer."""
        if self.kind == "tags":
            return np.concatenate(self._printed.getObjPoints()).reshape(-1, 3) * Y_UP
        if self.kind == "aprilgrid":
            x, y = (
                (np.arange(n)[:, None] * self.square_m + [0, self.marker_m]).ravel()
                for n in self.squares
            )
            return np.column_stack(
                [np.tile(x, len(y)), np.repeat(y, len(x)), 0 * np.tile(x, len(y))]
            )
        columns, rows = (count - 1 for count in self.squares)
        y, x = np.mgrid[1 : rows + 1, 1 : columns + 1].reshape(2, -1) * self.square_m
        return np.column_stack([x, -y, np.zeros(len(x))])

    @cached_property
    def neighbours(self) -> NDArray:
        """Numbers (E, 2) of corners that lie one square apart; of tags, one side of a tag."""
        apart = np.linalg.norm(self.corners[:, None] - self.corners, axis=-1)
        return np.argwhere(np.triu(np.abs(apart - self.side_m) < 1e-3 * self.side_m))

    @property
    def side_m(self) -> float:
        """Distance between neighbouring corners."""
        return self.marker_m if self.kind in ("tags", "aprilgrid") else self.square_m

    def find(self, image: NDArray) -> tuple[NDArray, NDArray]:
        """Return the numbers (K,) and px (K, 2) of the corners in a grey picture; K may be 0."""
        image = 255 - image if self.inverted else image
        if self.kind == "charuco":
            return self._charuco(image)
        return self._chessboard(image) if self.kind == "chessboard" else self._tags(image)

    @cached_property
    def _printed(self) -> Any:
        words = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, self.dictionary or ""))
        if self.kind in ("tags", "aprilgrid"):
            gap = self.square_m - self.marker_m
            return cv2.aruco.GridBoard(self.squares, self.marker_m, gap, words)
        made = cv2.aruco.CharucoBoard(self.squares, self.square_m, self.marker_m, words)
        made.setLegacyPattern(self.legacy)
        return made

    def _charuco(self, image: NDArray) -> tuple[NDArray, NDArray]:
        xy, ids, *_ = cv2.aruco.CharucoDetector(self._printed).detectBoard(image)
        return _pairs(ids, xy)

    def _tags(self, image: NDArray) -> tuple[NDArray, NDArray]:
        looks = cv2.aruco.DetectorParameters()
        grid = self.kind == "aprilgrid"
        looks.markerBorderBits = BORDER if grid else 1
        detector = cv2.aruco.ArucoDetector(self._printed.getDictionary(), looks)
        squares, ids, _ = detector.detectMarkers(image)
        known = self._printed.getIds().ravel().tolist()
        seen = {} if ids is None else dict(zip(ids.ravel().tolist(), squares, strict=True))
        numbers = [self._numbers(known.index(tag)) for tag in seen if tag in known]
        xy = [square.reshape(4, 2) for tag, square in seen.items() if tag in known]
        fine, shades = (_saddles, image) if grid else (_ends, image.astype(np.float32))
        xy = [fine(shades, square) for square in xy]
        return _pairs(np.array(numbers), np.array(xy)) if numbers else _pairs(None, None)

    def _numbers(self, tag: int) -> NDArray:
        """Return the numbers of a tag's corners in OpenCV's order: from its top left, clockwise.

        Kalibr prints OpenCV's tags rotated by 180 degrees.
        """
        if self.kind == "tags":
            return 4 * tag + np.arange(4)
        width = 2 * self.squares[0]
        row, column = divmod(tag, self.squares[0])
        left = 2 * row * width + 2 * column
        return left + np.array([1, 0, width, width + 1])

    def _chessboard(self, image: NDArray) -> tuple[NDArray, NDArray]:
        columns, rows = (count - 1 for count in self.squares)
        seen, xy = cv2.findChessboardCornersSB(
            image, (columns, rows), flags=cv2.CALIB_CB_EXHAUSTIVE
        )
        if not seen:
            return _pairs(None, None)
        grid = xy.reshape(rows, columns, 2)
        first, last = (
            _brightness(image, part.reshape(-1, 2).mean(axis=0))
            for part in (grid[:2, :2], grid[-2:, -2:])
        )
        # Which end is which: the squares beside opposite corners have different colours.
        grid = grid[::-1, ::-1] if first > last else grid
        return _pairs(np.arange(rows * columns), grid)


def _saddles(image: NDArray, square: NDArray) -> NDArray:
    """Refine the corners (4, 2) px of a tag to the nearby points where four squares meet."""
    side_px = np.linalg.norm(np.roll(square, 1, axis=0) - square, axis=1).min()
    reach = max(2, round(SADDLE_SHARE * float(side_px)))
    stop = cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 40, 0.01
    start = np.ascontiguousarray(square, dtype=np.float32)
    return cv2.cornerSubPix(image, start, (reach, reach), (-1, -1), stop)


def _ends(image: NDArray, square: NDArray) -> NDArray:
    """Refine the corners (4, 2) px of a dark tag to where straight lines along its edges meet.

    Blur rounds a corner off: its own brightness says it lies up to 0.4 px inside the tag, so that
    all tags look too small. Where an edge is steepest does not depend on blur.
    """
    for _ in range(2):  # from the corners of the first round, edges are seen square on
        side = np.roll(square, -1, axis=0) - square
        length = np.linalg.norm(side, axis=1)
        inwards = np.column_stack([-side[:, 1], side[:, 0]]) / length[:, None]
        reach = max(LEAST_REACH_PX, EDGE_SHARE * float(length.min()))
        off = np.linspace(-reach, reach, 2 * int(np.ceil(4 * reach)) + 1)
        along = np.linspace(0.1, 0.9, max(8, int(length.max())))
        at = square[:, None] + along[:, None] * side[:, None]
        steepest = _steepest(image, at[:, :, None] + off[:, None] * inwards[:, None, None], off)
        start, rise = np.polynomial.polynomial.polyfit(along, steepest.T, 1)
        # Each corner begins one edge and ends the one before it.
        both = np.stack([inwards, np.roll(inwards, 1, axis=0)], axis=1)
        shift = np.stack([start, np.roll(start + rise, 1)], axis=1)
        square = square + np.linalg.solve(both, shift[:, :, None])[:, :, 0]
    return square


def _steepest(image: NDArray, at: NDArray, off: NDArray) -> NDArray:
    """Return at which of the distances `off` (K,) it darkens most, of places (4, L, K, 2) px."""
    places = at.reshape(-1, len(off), 2).astype(np.float32)
    seen = cv2.remap(image, places, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    slope = np.maximum(-np.gradient(seen.astype(float), axis=1), 0.0) ** 2 + 1e-6
    found = np.zeros((len(seen), 1))
    for _ in range(STEEPEST):
        weight = slope * np.exp(-0.5 * ((off - found) / (0.4 * off[-1])) ** 2)
        found = (weight @ off)[:, None] / weight.sum(axis=1, keepdims=True)
    return found.reshape(at.shape[:2])


def _brightness(image: NDArray, xy: NDArray) -> float:
    column, row = np.round(xy).astype(int)
    return float(image[max(row - 1, 0) : row + 2, max(column - 1, 0) : column + 2].mean())


def _pairs(ids: NDArray | None, xy: NDArray | None) -> tuple[NDArray, NDArray]:
    if ids is None or xy is None:
        return np.zeros(0, dtype=int), np.zeros((0, 2))
    return np.asarray(ids, dtype=int).ravel(), np.asarray(xy, dtype=float).reshape(-1, 2)
