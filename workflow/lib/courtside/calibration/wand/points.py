"""Positions of a wand's markers in the pictures, by frame, read from CSV files.

Rows of one frame show the wand in one position: frames of synchronised videos, or pictures of a
wand at rest. Files are in the format of the study, or of DLTdv, Argus and easyWand.
"""

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import camera_fields
from courtside.records.user_tables import lines, number, table
from courtside.study.errors import InputError, StrPath

OURS = ("camera", "marker", "x_px", "y_px")
TIMES = ("frame", "time_s")  # one of them
# Columns of DLTdv and of Argus: point, camera, axis.
THEIRS = re.compile(r"(?P<point>[^;\t]+)_cam_?(?P<camera>[0-9]+)_(?P<axis>[xXyY])")
# Coordinates of the first pixel's centre; y is None where it runs up: y of the lowest row is then 1
# in DLTdv, and an error of half a pixel does not matter.
PROGRAMS = {"dltdv8": (1.0, 1.0), "dltdv": (1.0, None), "argus": (0.0, None)}
LONGEST_GAP = 2.5  # ASSUME: frame periods across which markers are interpolated
SIGMA_M = 5e-4  # ASSUME: of a length measured with a tape
MARGIN, MOST_OUTSIDE = 0.02, 0.05  # ASSUME: of a picture's size; share of markers beyond it


@dataclass(frozen=True, eq=False)
class Wand:
    """The markers on a wand."""

    markers: tuple[str, ...]  # names in the file, in the order along the wand; empty: not stated
    along_m: NDArray  # (M,): distances from the first marker, increasing from 0
    sigma_m: float  # of the length

    @property
    def length_m(self) -> float:
        """The distance of the first marker from the last."""
        return float(self.along_m[-1])

    @classmethod
    def of(cls, given: Mapping[str, Any]) -> "Wand":
        """Build a wand from `wand` of a session, which `session_faults` has checked."""
        middle_m = [float(given["middle_m"])] if "middle_m" in given else []
        along_m = np.array([0.0, *middle_m, float(given["length_m"])])
        markers = tuple(str(name) for name in given.get("markers", ()))
        return cls(markers, along_m, float(given.get("length_sigma_m", SIGMA_M)))


@dataclass(frozen=True, eq=False)
class Seen:
    """The positions of a wand's markers in the pictures of cameras."""

    cameras: tuple[str, ...]
    frames: NDArray  # (F,): frame numbers, or times in s; increasing
    xy: NDArray  # (C, F, M, 2) px, NaN where missing


def read(
    given: Mapping[str, Any],
    wand: Wand,
    names: Mapping[str, str],
    sizes: Mapping[str, tuple[int, int]],
) -> Seen:
    """Read the positions of a wand's markers from the file of a session.

    `names` maps the session's cameras to their names in the study's format. Other programs number
    them, in the order of `given["cameras"]`, and some let y run up from the lower edge: `sizes` are
    those of the pictures, px. Raises `InputError` if the file has another format, or a camera has
    no marker.
    """
    path = given["points"]
    if "program" in given:
        order = given.get("cameras", list(names))
        theirs = _theirs(path, wand, [sizes[name] for name in order], given["program"])
        at = [order.index(name) for name in names]
        found = Seen(tuple(names), np.arange(theirs.shape[1], dtype=float), theirs[at])
    else:
        found = _ours(path, wand, names, given.get("floor", ()))
    _check_cameras(path, names, {
        name for name, xy in zip(found.cameras, found.xy, strict=True) if np.isfinite(xy).any()
    })  # fmt: skip
    _check_inside(path, found, sizes)
    return found


def _check_inside(path: StrPath, found: Seen, sizes: Mapping[str, tuple[int, int]]) -> None:
    """Raise an `InputError` if many markers of a camera are outside its picture."""
    for name, xy in zip(found.cameras, found.xy, strict=True):
        size = np.array(sizes[name])
        known = np.isfinite(xy[..., 0])
        outside = ((xy < -MARGIN * size) | (xy > (1 + MARGIN) * size)).any(axis=-1)
        if outside.sum() > MOST_OUTSIDE * known.sum():
            raise InputError(
                f"{path}: camera {name}: expected markers inside its picture of {size[0]} x "
                f"{size[1]} px, found {outside.sum()} of {known.sum()} outside; check the size of "
                "the digitised video, and the order of the cameras"
            )


def _check_cameras(
    path: StrPath,
    names: Mapping[str, str],
    seen: Collection[str],
    listed: Iterable[str] = (),
) -> None:
    """Raise an `InputError` if a camera has no marker; the file's own names are `listed`."""
    for name, theirs in names.items():
        if name not in seen:
            others = [one for one in dict.fromkeys(listed) if one not in names.values()]
            found = f"markers of {camera_fields.short(', '.join(others))}" if others else "none"
            raise InputError(
                f"{path}: expected markers of the wand for camera {name} ({theirs}), found "
                f"{found}; correct the name in the file, or set `name_in_calibration` of the camera"
            )


def _ours(path: StrPath, wand: Wand, names: Mapping[str, str], floor: Iterable[float]) -> Seen:
    rows = table(path, OURS, TIMES)
    if not rows:
        raise InputError(f"{path}: expected rows of a wand's markers, found none; export it again")
    times = [key for key in TIMES if key in rows[0][1]]
    if len(times) != 1:
        raise InputError(
            f"{path}: expected one column frame or time_s, found {' and '.join(times) or 'none'}; "
            "keep the one that gives the time of each row"
        )
    markers = _points(path, wand, (row["marker"] for _, row in rows))
    wanted = {theirs: name for name, theirs in names.items()}
    each: dict[str, dict[float, NDArray]] = {name: {} for name in names}
    for line, row in rows:
        if row["marker"] not in markers or row["camera"] not in wanted:
            continue
        where, at = f"{path}: line {line}", markers.index(row["marker"])
        time = number(where, times[0], row[times[0]])
        places = each[wanted[row["camera"]]]
        xy = places.setdefault(time, np.full((len(markers), 2), np.nan))
        if np.isfinite(xy[at]).any():
            raise InputError(
                f"{where}: expected one row for marker {row['marker']} in camera {row['camera']} "
                f"at {times[0]} {row[times[0]]}, found a second one; delete one"
            )
        xy[at] = [number(where, key, row[key]) for key in OURS[2:]]
    seen = [name for name, places in each.items() if places]
    _check_cameras(path, names, seen, (row["camera"] for _, row in rows))
    return _at_frames(each) if times == ["frame"] else _at_times(each, floor)


def _at_frames(each: Mapping[str, Mapping[float, NDArray]]) -> Seen:
    frames = sorted({frame for places in each.values() for frame in places})
    n_markers = next(len(xy) for places in each.values() for xy in places.values())
    none = np.full((n_markers, 2), np.nan)
    xy = [[places.get(frame, none) for frame in frames] for places in each.values()]
    return Seen(tuple(each), np.array(frames), np.array(xy))


def _at_times(each: Mapping[str, Mapping[float, NDArray]], floor: Iterable[float]) -> Seen:
    """Return markers at the times of the camera with most times, interpolated.

    The times at which the wand lies on the floor are added: they may be of any camera.
    """
    most = max(each.values(), key=len)
    times = np.union1d(list(most), [float(time) for time in floor])
    xy = []
    for places in each.values():
        own = np.array(sorted(places))
        every = np.array([places[time] for time in own]).reshape(len(own), -1)
        xy.append(_between(own, every, times).reshape(len(times), -1, 2))
    return Seen(tuple(each), times, np.array(xy))


def _between(own: NDArray, values: NDArray, times: NDArray) -> NDArray:
    """Return values (T, K) at `times`; NaN outside, and in long gaps.

    They are interpolated by the cubic through the four nearest times: a line shortens the arcs of a
    wand. Linearly where one of the four is missing or beyond a long gap.
    """
    if len(own) < 2:
        return np.full((len(times), values.shape[1]), np.nan)
    gap = LONGEST_GAP * float(np.median(np.diff(own)))
    after = np.clip(np.searchsorted(own, times), 1, len(own) - 1)
    start, stop = own[after - 1], own[after]
    share = ((times - start) / (stop - start))[:, None]
    found = (1 - share) * values[after - 1] + share * values[after]
    inside = (times >= own[0]) & (times <= own[-1]) & (stop - start <= gap)
    found = np.where(inside[:, None], found, np.nan)
    found = np.where(share == 0, values[after - 1], np.where(share == 1, values[after], found))
    cubic = _cubic(own, values, times, after, gap)
    return np.where(np.isfinite(found) & np.isfinite(cubic), cubic, found)


def _cubic(own: NDArray, values: NDArray, times: NDArray, after: NDArray, gap: float) -> NDArray:
    """Return values (T, K) by Lagrange's cubic through two times before and two after; NaN: none.

    `after` (T,) is the index of the first time after each.
    """
    at = after[:, None] + np.arange(-2, 2)
    outside = (at < 0) | (at >= len(own))
    at = np.clip(at, 0, len(own) - 1)
    near = own[at]
    there = ~outside.any(axis=1) & (np.diff(near, axis=1) <= gap).all(axis=1)
    found = np.zeros((len(times), values.shape[1]))
    for k in range(4):
        others = np.delete(near, k, axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):  # times twice at the ends
            weight = ((times[:, None] - others) / (near[:, [k]] - others)).prod(axis=1)
        found += np.where(there, weight, 0.0).reshape(-1, 1) * values[at[:, k]]
    found[~there] = np.nan
    return found


def _theirs(path: StrPath, wand: Wand, sizes: Sequence[tuple[int, int]], program: str) -> NDArray:
    """Return px (C, F, M, 2) of an `xypts.csv`: a row per frame, columns by point and camera."""
    # A row of empty cells is a frame in which nothing is seen, an empty line is none.
    each = lines(path, "export it again as CSV (dense, not sparse)")
    rows = [(line, row) for line, row in each if len(row) > 1 or any(row)]
    header = rows[0][1] if rows else []
    plain = bool(header) and all(_is_number(cell) for cell in header if cell)
    columns = _numbered(wand, len(sizes)) if plain else _named(path, header)
    order = _points(path, wand, (point for point, _, _ in columns))
    if sorted({camera for _, camera, _ in columns}) != list(range(1, len(sizes) + 1)):
        raise InputError(
            f"{path}: expected columns of {len(sizes)} cameras, numbered from 1, found columns of "
            f"{len({camera for _, camera, _ in columns})}; the session must have the same cameras, "
            "in the order of `wand.cameras`"
        )
    values = _values(path, rows[0 if plain else 1 :], len(columns))
    xy = np.full((len(sizes), len(values), len(order), 2), np.nan)
    for column, (point, camera, axis) in enumerate(columns):
        if point in order:
            xy[camera - 1, :, order.index(point), "xy".index(axis)] = values[:, column]
    xy[~np.isfinite(xy).all(axis=-1)] = np.nan
    first_x, first_y = PROGRAMS[program]
    for one, (_, height) in zip(xy, sizes, strict=True):
        one[..., 0] -= first_x
        one[..., 1] = height - one[..., 1] if first_y is None else one[..., 1] - first_y
    return xy


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _named(path: StrPath, header: Sequence[str]) -> list[tuple[str, int, str]]:
    """Return the point, camera and axis of each column of a header."""
    found = [THEIRS.fullmatch(cell) for cell in header]
    columns = [(m["point"], int(m["camera"]), m["axis"].lower()) for m in found if m]
    if not columns or len(columns) < len(header) or len(set(columns)) < len(columns):
        raise InputError(
            f"{path}: expected columns such as pt1_cam1_X or Track_1_cam_1_x, each once, found "
            f"{','.join(header)[:80] or 'an empty file'}; give the xypts.csv of DLTdv or Argus, "
            "with commas between the cells"
        )
    return columns


def _numbered(wand: Wand, n_cameras: int) -> list[tuple[str, int, str]]:
    """Return the same for a file without a header (easyWand): by point, camera and axis."""
    points = range(1, len(wand.along_m) + 1)
    each = ((p, c) for p in points for c in range(1, n_cameras + 1))
    return [(f"pt{point}", camera, axis) for point, camera in each for axis in "xy"]


def _points(path: StrPath, wand: Wand, names: Iterable[str]) -> list[str]:
    """Return the wand's markers in the order along it; `names` are those of the file's points."""
    points = list(dict.fromkeys(names))
    order = list(wand.markers) or points
    if len(order) != len(wand.along_m):
        raise InputError(
            f"{path}: expected {len(wand.along_m)} markers, found {', '.join(order)[:80]}; list "
            "the wand's markers in their order along it in `wand.markers`"
        )
    if missing := [name for name in order if name not in points]:
        raise InputError(
            f"{path}: expected markers of {', '.join(points)[:80]}, found {', '.join(missing)}; "
            "correct `wand.markers`"
        )
    return order


def _values(path: StrPath, rows: Sequence[tuple[int, Sequence[str]]], width: int) -> NDArray:
    """Return the numbers (F, K) of rows with their line numbers, NaN for empty cells."""
    found = np.full((len(rows), width), np.nan)
    for at, (line, row) in enumerate(rows):
        where = f"{path}: line {line}"
        if len(row) != width:
            raise InputError(f"{where}: expected {width} cells, found {len(row)}; correct it")
        for k, cell in enumerate(row):
            if cell and cell.lower() != "nan":
                found[at, k] = number(where, f"column {k + 1}", cell)
    if not len(found):
        raise InputError(f"{path}: expected rows of a wand's markers, found none; export it again")
    return found
