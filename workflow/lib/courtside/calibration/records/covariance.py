"""The joint covariance of a session's fixed cameras: npz with its parameters named."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.bundle.problem import FLEX, IMAGE, LENS, POSE
from courtside.records import npz
from courtside.study.errors import StrPath

FORM = "courtside camera covariance 2"
PARAMETERS = POSE + LENS
SPEC = {
    "camera": ("str", ("C",)),
    "parameter": ("str", (str(len(PARAMETERS)),)),
    "covariance": ("float", ("K", "K")),
    "frame": ("float", ("3", "3")),
}


@dataclass(frozen=True, eq=False)
class CameraCovariance:
    """Covariance (14 C, 14 C) of the poses and lenses of named cameras.

    Camera after camera, each in the order of `PARAMETERS`: a small rotation of the camera in its
    own frame (rad, applied on the left of cam_from_world), translation of cam_from_world (m), focal
    length along y (px), focal length along x over that along y, principal point (px), k1, k2, p1,
    p2.

    `frame` (3, 3) is the covariance of the world frame itself where people or the pictures define
    it: a small rotation of the world about its x and y axes (rad), and a shift along z (m). The
    other errors do not contain it. It is 0 where a file defines the frame, and where court points,
    or a wand or a board on the floor do: `covariance` contains their errors.
    """

    cameras: list[str]
    covariance: NDArray
    frame: NDArray = field(default_factory=lambda: np.zeros((3, 3)))

    def of_columns(self) -> NDArray:
        """Return the covariance in the order of a network's columns, (K, K); 0 for the flex."""
        size = (IMAGE + len(LENS)) * len(self.cameras)
        at = columns(len(self.cameras))
        whole = np.zeros((size, size))
        whole[np.ix_(at, at)] = self.covariance
        return whole

    def sigma(self, camera: str, parameter: str) -> float:
        """Return the standard deviation of one of a camera's `PARAMETERS`."""
        at = len(PARAMETERS) * self.cameras.index(camera) + PARAMETERS.index(parameter)
        return float(np.sqrt(self.covariance[at, at]))

    def place_sigma_m(self, camera: str) -> float:
        """Return that of a camera's place, root of the sum over axes: as of its translation."""
        return float(np.linalg.norm([self.sigma(camera, f"t{axis}_m") for axis in "xyz"]))

    def of(self, cameras: Sequence[str]) -> "CameraCovariance":
        """Return the covariance of some cameras, in order; `ValueError` names a missing one."""
        for name in cameras:
            if name not in self.cameras:
                raise ValueError(f"expected a camera of {self.cameras}, found {name!r}")
        at = [self.cameras.index(name) for name in cameras]
        size = len(PARAMETERS)
        rows = np.concatenate([size * k + np.arange(size) for k in at])
        return CameraCovariance(list(cameras), self.covariance[np.ix_(rows, rows)], self.frame)


def columns(n_cameras: int) -> NDArray:
    """Return the indices of the cameras' parameters among their network's columns, (14 C,) int."""
    at = np.arange(n_cameras)[:, None]
    poses = IMAGE * at + np.arange(IMAGE - len(FLEX))
    lenses = IMAGE * n_cameras + len(LENS) * at + np.arange(len(LENS))
    return np.concatenate([poses, lenses], axis=1).ravel()


def of_network(
    cameras: Sequence[str], covariance: NDArray, frame: NDArray | None = None
) -> CameraCovariance:
    """Build a `CameraCovariance` from the covariance of a network's columns (K, K).

    `frame` (3, 3) is that of the world frame; without it the frame is exact.
    """
    at = columns(len(cameras))
    exact = np.zeros((3, 3))
    own = covariance[np.ix_(at, at)]
    return CameraCovariance(list(cameras), own, exact if frame is None else frame)


def write(path: StrPath, found: CameraCovariance) -> None:
    """Write a `CameraCovariance`."""
    arrays = {
        "camera": np.array(found.cameras, dtype=str),
        "parameter": np.array(PARAMETERS, dtype=str),
        "covariance": np.asarray(found.covariance, dtype=float),
        "frame": np.asarray(found.frame, dtype=float),
    }
    npz.write(path, FORM, SPEC, arrays)


def read(path: StrPath) -> CameraCovariance:
    """Read a `CameraCovariance`; an `InputError` says what is wrong with the file."""
    found = npz.read(path, FORM, SPEC)
    names = [str(name) for name in found["camera"]]
    return CameraCovariance(names, found["covariance"], found["frame"])
