"""Corners of a board as seen by several cameras, picture by picture.

A *picture* is one position of the board. It is either the pictures with one name from several
cameras, which need not be simultaneous if the board is at rest, or the frames of synchronised
videos at one time.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.calibration.boards import chessboard
from courtside.calibration.boards.board import Board
from courtside.records.user_tables import number, table
from courtside.study.errors import InputError, StrPath
from courtside.video import images, reader

# Our columns, and those of Caliscope's `xy.csv`, with what else it writes.
OURS = ("picture", "camera", "corner", "x_px", "y_px")
THEIRS = ("sync_index", "cam_id", "keypoint_id", "img_loc_x", "img_loc_y")
PLACES = (("board_loc_x", "board_loc_y"), ("obj_loc_x", "obj_loc_y"))  # on the board, m
MORE = ("frame_index", "frame_time", "object_id", "obj_loc_z", *PLACES[0], *PLACES[1])
LOOKED_AT = 5  # ASSUME: pictures that tell which other dictionary a board has


@dataclass(frozen=True, eq=False)
class Corners:
    """Corners of one board, seen by some cameras."""

    cameras: tuple[str, ...]
    pictures: tuple[str, ...]
    sizes: dict[str, tuple[int, int]]  # of the pictures of each camera, px; of a table: none
    camera: NDArray  # (M,) int: index of the camera
    picture: NDArray  # (M,) int: index of the picture
    corner: NDArray  # (M,) int: number of the corner
    xy: NDArray  # (M, 2) px
    step: NDArray | None = None  # (P,) int: of each picture in time; None: in no order
    every_s: float | None = None  # from step to step, where it is known


def of_pictures(folders: Mapping[str, StrPath], board: Board) -> Corners:
    """Find a board in folders of pictures, one per camera; one name is one position of it."""
    found, sizes = {}, {}
    for name, folder in folders.items():
        size: list[tuple[int, int]] = []
        found[name] = _seen(folder, name, _grey(chessboard.pictures_of(folder), size), board)
        sizes[name] = size[0]
    return _together(found, sizes)


def _grey(paths: Sequence[Path], size: list[tuple[int, int]]) -> Iterator[tuple[str, NDArray]]:
    """Yield pictures of one size by name; append the size, px, to the empty list `size`."""
    by_name: dict[str, Path] = {}
    for path in paths:
        if by_name.setdefault(path.stem, path) != path:
            raise InputError(
                f"{path}: expected one picture of each name, found {by_name[path.stem].name} "
                "beside it; remove or rename one"
            )
        image = images.read(path, cv2.IMREAD_GRAYSCALE, advice="delete or replace it")
        size[:] = [chessboard.same_size(path, image, size[0] if size else None)]
        yield path.stem, image


def of_videos(paths: Mapping[str, StrPath], board: Board, *, every_s: float) -> Corners:
    """Find a board in synchronised videos, in one frame every `every_s`."""
    found, sizes = {}, {}
    for name, path in paths.items():
        sizes[name] = reader.probe(path).size
        grey = (
            (f"{round(time_s / every_s):06d}", cv2.cvtColor(image, cv2.COLOR_BGR2GRAY))
            for _, time_s, image in reader.extract_frames(path, every_s)
        )
        found[name] = _seen(path, name, grey, board)
    return replace(_in_time(_together(found, sizes)), every_s=every_s)


def of_table(path: StrPath, cameras: Mapping[str, str], board: Board) -> Corners:
    """Read corners from a CSV: `OURS`, or `THEIRS` of Caliscope, whose cameras are `cam_<id>`.

    `cameras` maps the name in the session to that in the table. Raises `InputError` if a number is
    invalid, a corner is given twice, or the table's own coordinates of corners contradict the
    board.
    """
    try:
        rows, names = table(path, OURS), OURS
    except InputError as fault:
        if THEIRS[0] not in str(fault):  # not Caliscope's either
            raise
        rows, names = table(path, THEIRS, MORE), THEIRS
    if not rows:
        raise InputError(f"{path}: expected corners of a board, found none; write it again")
    boards = sorted({row["object_id"] for _, row in rows if "object_id" in row})
    if len(boards) > 1:
        raise InputError(
            f"{path}: expected corners of one board, found object_id {', '.join(boards)[:80]}; "
            "delete the rows of the others"
        )
    return _in_time(_together(_of_rows(path, rows, names, cameras, board), {}))


def _of_rows(path: StrPath, rows, names, cameras: Mapping[str, str], board: Board) -> dict:
    """Return the pictures of each camera that show corners, from the rows of a table."""
    wanted = {theirs: name for name, theirs in cameras.items()}
    found: dict[str, dict[str, tuple[list, list]]] = {name: {} for name in cameras}
    for line, row in rows:
        name = wanted.get(("" if names is OURS else "cam_") + row[names[1]])
        if name is None:
            continue
        where = f"{path}: line {line}"
        corner = _corner(where, names[2], row, board)
        ids, xy = found[name].setdefault(row[names[0]], ([], []))
        if corner in ids:
            raise InputError(
                f"{where}: expected one row for corner {corner} of picture {row[names[0]]} in "
                f"camera {row[names[1]]}, found a second one; delete one"
            )
        ids.append(corner)
        xy.append([number(where, key, row[key]) for key in names[3:]])
    seen = {
        name: [(key, np.array(ids), np.array(xy)) for key, (ids, xy) in by_picture.items()]
        for name, by_picture in found.items()
    }
    for name, theirs in cameras.items():
        if not seen[name]:
            raise InputError(
                f"{path}: expected corners of camera {name} ({theirs}), found none; give it its "
                "`name_in_calibration`"
            )
    return seen


def _corner(where: str, key: str, row: Mapping[str, str], board: Board) -> int:
    """Return the number of a row's corner; check its coordinates against the board."""
    corner = number(where, key, row[key])
    if corner not in range(len(board.corners)):
        raise InputError(
            f"{where}: expected {key} from 0 to {len(board.corners) - 1}, found {row[key]}; "
            "correct board.squares"
        )
    for keys in PLACES:
        if set(keys) <= set(row):
            theirs = np.array([number(where, one, row[one]) for one in keys])
            there = np.abs(board.corners[int(corner), :2])
            if np.abs(theirs - there).max() > 1e-3 * board.square_m:
                raise InputError(
                    f"{where}: expected corner {row[key]} at {there.round(4).tolist()} m of the "
                    f"board, found {theirs.round(4).tolist()}; correct board.square_m or squares"
                )
    return int(corner)


def _seen(source: StrPath, name: str, grey: Iterable[tuple[str, NDArray]], board: Board) -> list:
    """Return the pictures of a camera that show corners; raise `InputError` if none does."""
    found: list = []
    first: list[NDArray] = []
    count = 0
    for picture, image in grey:
        ids, xy = board.find(image)
        count += 1
        if len(ids):
            found.append((picture, ids, xy))
        elif len(first) < LOOKED_AT and not found:
            first.append(image)
    if not found:
        raise InputError(
            f"{source}: camera {name}: expected a {board.kind} of {board.squares[0]}x"
            f"{board.squares[1]} squares{f' in {board.dictionary}' if board.dictionary else ''}, "
            f"found none in {count} pictures{_other(first, board)}; correct `board`"
        )
    return found


def _other(pictures: Sequence[NDArray], board: Board) -> str:
    """Name what the pictures show instead: another form of the board, or another dictionary."""
    seen = {
        words: sum(len(other.find(picture)[0]) > 0 for picture in pictures)
        for words, other in _forms(board).items()
    }
    best = max(seen, key=lambda words: seen[words])
    if seen[best]:
        return f" but one with `{best}` in {seen[best]} of the first {len(pictures)}"
    if board.dictionary is None:
        return ""
    counts = {}
    for name in (one for one in dir(cv2.aruco) if one.startswith("DICT_")):
        words = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, name))
        looks = cv2.aruco.ArucoDetector(words)
        each = (looks.detectMarkers(255 - p if board.inverted else p)[1] for p in pictures)
        counts[name] = sum(0 if ids is None else len(ids) for ids in each)
    best = max(counts, key=lambda name: counts[name])
    return f" but {counts[best]} markers of {best}" if counts[best] else ""


def _forms(board: Board) -> dict[str, Board]:
    """Return the board as it would be if one key of the session were wrong, by that key."""
    forms = {
        f"inverted: {str(not board.inverted).lower()}": replace(board, inverted=not board.inverted)
    }
    columns, rows = board.squares
    counts = {"charuco": [(rows, columns)], "chessboard": [(columns + 1, rows + 1)]}
    if board.kind == "charuco":
        forms[f"legacy: {str(not board.legacy).lower()}"] = replace(board, legacy=not board.legacy)
    for squares in counts.get(board.kind, []):  # exchanged; inner corners in place of squares
        forms[f"squares: {list(squares)}"] = replace(board, squares=squares)
    return forms


def _in_time(seen: Corners) -> Corners:
    """Return the corners of pictures that follow each other, if all are numbered."""
    numbered = all(name.isdecimal() for name in seen.pictures)
    return replace(seen, step=np.array([int(name) for name in seen.pictures]) if numbered else None)


def _together(found: Mapping[str, list], sizes: dict[str, tuple[int, int]]) -> Corners:
    pictures = sorted({picture for views in found.values() for picture, _, _ in views})
    at = {picture: k for k, picture in enumerate(pictures)}
    views = [
        (c, at[picture], ids, xy)
        for c, name in enumerate(found)
        for picture, ids, xy in found[name]
    ]
    lengths = [len(ids) for _, _, ids, _ in views]
    return Corners(
        tuple(found),
        tuple(pictures),
        sizes,
        np.repeat([c for c, _, _, _ in views], lengths),
        np.repeat([p for _, p, _, _ in views], lengths),
        np.concatenate([ids for _, _, ids, _ in views]),
        np.concatenate([xy for _, _, _, xy in views]),
    )
