"""Clicked points of a session: what their file says, and whether it fits the pictures."""

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court import place_checks, resection
from courtside.records.cameras import placed_points
from courtside.study.configuration.session_files import is_there
from courtside.study.configuration.sessions import Session
from courtside.study.errors import InputError

SLACK = 0.01  # ASSUME: of a picture's size: clicks that are not exact lie farther out by less

Sizes = Mapping[str, tuple[int, int]]  # by camera: width and height, px


def check(session: Session, court_yaml: Path | None, sizes: Sizes) -> tuple[list[str], list[str]]:
    """Return faults of the clicked points of a session, and remarks; both begin with their file.

    A file that is not there is told elsewhere.
    """
    path, cameras = session.court_points, list(session.cameras)
    if path is None or not is_there(Path(path)) or not (session.placed or court_yaml):
        return [], []
    remarks: list[str] = []
    try:
        if session.placed:
            points = placed_points.read(path, cameras)
            clicks, others = place_checks.as_court(path, points)[1], points.left_out
            remarks += place_checks.unit_doubt(points.xyz, clicks)
        else:
            clicks, others = place_checks.read(path, court_yaml or "", cameras, False)[1], ()
    except InputError as error:
        return error.lines, []
    seen = {name: xy[np.isfinite(xy).all(axis=1)] for name, xy in clicks.items()}
    faults = [*_outside(seen, sizes)]
    if session.placed and "known" in session.calibrations():
        faults += _few(seen, others)
    remarks += _in_a_quarter(seen, sizes)
    if others:
        remarks.append(f"rows of {', '.join(others)} are left out: the session has no such cameras")
    return [f"{path}: {line}" for line in faults], [f"{path}: {line}" for line in remarks]


def _outside(seen: Mapping[str, NDArray], sizes: Sizes) -> Iterator[str]:
    """Yield the cameras with clicks outside of their pictures."""
    for name, xy in seen.items():
        if name not in sizes:
            continue
        size = np.array(sizes[name])
        out = ~_inside(xy, size)
        if out.any():
            (x, y), more = xy[out][0], f" and {out.sum() - 1} more" if out.sum() > 1 else ""
            mend = "they are px of the videos' own size"
            if _inside(xy[:, ::-1], size).all():
                mend = f"x_px and y_px seem to be exchanged: {place_checks.RENAME}"
            yield (
                f"camera {name}: expected clicks in its picture of {size[0]} x {size[1]} px, found "
                f"({x:g}, {y:g}){more}; {mend}"
            )


def _inside(xy: NDArray, size: NDArray) -> NDArray:
    return np.asarray(((xy > -SLACK * size) & (xy < (1 + SLACK) * size)).all(axis=1))


def _few(seen: Mapping[str, NDArray], others: tuple[str, ...]) -> Iterator[str]:
    """Yield the cameras with too few points for a calibration from points alone."""
    fewest = resection.FEWEST["lens"]
    for name, xy in seen.items():
        if len(xy) < fewest:
            named = f"; the file has points of {', '.join(others)}" * (bool(others) and not len(xy))
            yield (
                f"camera {name}: expected {fewest} points or more, found {len(xy)}; add some{named}"
            )


def _in_a_quarter(seen: Mapping[str, NDArray], sizes: Sizes) -> Iterator[str]:
    """Yield whether the clicks of all cameras lie in the upper left quarter of their pictures."""
    clicked = {name: xy.max(axis=0) for name, xy in seen.items() if len(xy) and name in sizes}
    if clicked and all((far < np.array(sizes[name]) / 2).all() for name, far in clicked.items()):
        name, (x, y) = next(iter(clicked.items()))
        yield (
            "all clicks lie in the upper left quarter of the pictures (camera "
            f"{name}: up to {x:.0f}, {y:.0f} of {sizes[name][0]} x {sizes[name][1]} px): right if "
            "they are px of the videos' own size, not of a smaller copy"
        )
