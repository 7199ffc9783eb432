"""Calibrate fixed cameras from known court points alone: the methods of the study by name."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

from courtside.calibration.court import joint_adjustment, line_edges, misfits, resection
from courtside.calibration.court.court import ClickedPoints, Court
from courtside.geometry.camera import Camera
from courtside.study.errors import InputError
from courtside.study.methods import Calibration

Found = resection.Linear | resection.Fitted
# Sigma of a good click, as a share of the scatter that all clicks are expected to have. Points
# alone carry the camera here, and with the whole scatter mirrored points and another court find
# cameras that nearly fit.
GOOD_CLICK = 0.43


@dataclass(frozen=True, eq=False)
class Method:
    """One way to calibrate from known points."""

    linear: bool  # by DLT; otherwise by least squares
    board: bool  # the lens is known from a chessboard; otherwise focal length and k1 are found too
    points: NDArray  # (n,) int: indices of the court points used


def method(name: str, court: Court) -> Method:
    """Return the `Method` that the name of a calibration denotes.

    `known18`, `known8-board`, `dlt18`: the number is that of the court's points or of a set of
    them. Raises `InputError` if the court has no set of that many points.
    """
    parsed = Calibration.parse(name)
    sets = [points for points in court.sets.values() if len(points) == parsed.n_points]
    if not sets:
        there = {key: len(points) for key, points in court.sets.items()}
        raise InputError(
            f"calibration {name}: expected a set of {parsed.n_points} points in court "
            f"{court.name}, found {there}; name one of these numbers"
        )
    return Method(parsed.kind == "dlt", parsed.board, court.indices(sets[0]))


def calibrate(
    way: Method,
    court: Court,
    clicks: ClickedPoints,
    sizes: Mapping[str, tuple[int, int]],
    lenses: Mapping[str, Camera],
    *,
    click_sigma_px: float,
) -> dict[str, Found]:
    """Calibrate each camera, whose pictures have the given size (px), from its clicks.

    `lenses` give K and dist, for methods with a board; `click_sigma_px` is that at a longer
    side of 3840 px. Raises `InputError` if the points do not determine a camera.
    """
    found: dict[str, Found] = {}
    for name, size in sizes.items():
        xyz, xy = court.xyz[way.points], clicks[name][way.points]
        if way.linear:
            found[name] = resection.dlt(xyz, xy, size=size, name=name)
            continue
        known: dict[str, Any] = {}
        if way.board:
            known = {"K": lenses[name].K, "dist": lenses[name].dist}
        found[name] = misfits.fitted(
            xyz,
            xy,
            size,
            sigma_px=GOOD_CLICK * joint_adjustment.click_sigma(click_sigma_px, size),
            xyz_sigma=court.sigma_m[way.points],
            edges=line_edges.on_lines(court)[way.points],
            name=name,
            **known,
        )
    return found


def cameras(found: Mapping[str, Found]) -> list[Camera]:
    """Return the cameras of `calibrate`; raise `InputError` where DLT gave no valid camera."""
    calibrated = []
    for name, result in found.items():
        if result.camera is None:
            reason = result.reason if isinstance(result, resection.Linear) else ""
            raise InputError(
                reason
                or f"camera {name}: expected a valid camera from DLT, found none; "
                "click more points, more exactly, or calibrate by least squares"
            )
        calibrated.append(result.camera)
    return calibrated


def matrices(found: Mapping[str, Found]) -> dict[str, NDArray]:
    """Return the projection matrices (3, 4) that DLT gives, by camera."""
    return {name: one.matrix for name, one in found.items() if isinstance(one, resection.Linear)}
