"""Calibrating fixed cameras from known court points alone: the methods of the study by name."""

import re
from dataclasses import dataclass

import numpy as np

from courtside.calibration.court import joint_adjustment, resection
from courtside.study.errors import InputError

NAME = re.compile(r"(dlt|known)(\d+)(-board)?")


@dataclass(frozen=True, eq=False)
class Method:
    """One way to calibrate from known points.

    Attributes
    ----------
    linear : bool
        By DLT; otherwise by least squares.
    board : bool
        With the lens known from a chessboard; otherwise focal length and k1 are found too.
    points : (n,) int
        Court points used.
    """

    linear: bool
    board: bool
    points: np.ndarray


def method(name, court):
    """Return the `Method` that a calibration's name means.

    Parameters
    ----------
    name : str
        `known18`, `known8-board`, `dlt18`: the number is that of the court's points or of a set of them.
    court : courtside.calibration.court.court.Court

    Raises
    ------
    InputError
        If the court has no set of that many points.
    """
    kind, number, board = NAME.fullmatch(name).groups()
    sets = [points for points in court.sets.values() if len(points) == int(number)]
    if not sets:
        there = {key: len(points) for key, points in court.sets.items()}
        raise InputError(
            f"calibration {name}: expected a set of {number} points in court {court.name}, found {there}; "
            "name one of these numbers"
        )
    return Method(kind == "dlt", board is not None, court.indices(sets[0]))


def calibrate(way, court, clicks, sizes, lenses, *, click_sigma_px):
    """Calibrate each camera from its clicks.

    Parameters
    ----------
    way : Method
    court : courtside.calibration.court.court.Court
    clicks : dict of str to (P, 2) float
        By camera; NaN where not clicked.
    sizes : dict of str to (int, int)
        Of the pictures, px.
    lenses : dict of str to Camera
        K and dist by camera, for methods with a board.
    click_sigma_px : float
        At a picture width of 3840 px.

    Returns
    -------
    found : dict of str to resection.Linear or resection.Fitted

    Raises
    ------
    InputError
        If the points do not determine a camera.
    """
    found = {}
    for name, size in sizes.items():
        xyz, xy = court.xyz[way.points], clicks[name][way.points]
        if way.linear:
            found[name] = resection.dlt(xyz, xy, size=size, name=name)
            continue
        known = {"K": lenses[name].K, "dist": lenses[name].dist} if way.board else {}
        found[name] = resection.nonlinear(
            xyz,
            xy,
            size,
            sigma_px=joint_adjustment.click_sigma(click_sigma_px, size),
            xyz_sigma=court.sigma_m[way.points],
            name=name,
            **known,
        )
    return found


def cameras(found):
    """Return the cameras of `calibrate`'s results, or raise `InputError` where a linear one is none."""
    for name, result in found.items():
        if result.camera is None:
            raise InputError(
                result.reason
                or f"camera {name}: expected a linear calibration that is a camera, found one that is none; "
                "click more points, more exactly, or calibrate by least squares"
            )
    return [result.camera for result in found.values()]
