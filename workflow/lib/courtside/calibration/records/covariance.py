"""The joint covariance of a session's fixed cameras: npz with its parameters named."""

from dataclasses import dataclass

import numpy as np

from courtside.calibration.bundle.problem import FLEX, IMAGE, LENS, POSE
from courtside.records import npz

FORM = "courtside camera covariance 1"
PARAMETERS = POSE + LENS
SPEC = {
    "camera": ("str", ("C",)),
    "parameter": ("str", (str(len(PARAMETERS)),)),
    "covariance": ("float", ("K", "K")),
}


@dataclass(frozen=True, eq=False)
class CameraCovariance:
    """Covariance of poses and lenses of cameras.

    Attributes
    ----------
    cameras : list of str
    covariance : (14 C, 14 C) float
        Camera after camera, each in the order of `PARAMETERS`: a small turn of the camera in its own
        frame (rad,
        applied on the left of cam_from_world), translation of cam_from_world (m), focal length along y (px),
        focal length along x over that along y, principal point (px), k1, k2, p1, p2.
    """

    cameras: list
    covariance: np.ndarray

    def of_columns(self):
        """Return the same in the order of a network's columns, (K, K); 0 for the flex."""
        size = (IMAGE + len(LENS)) * len(self.cameras)
        at = columns(len(self.cameras))
        whole = np.zeros((size, size))
        whole[np.ix_(at, at)] = self.covariance
        return whole

    def of(self, cameras):
        """Return that of some of the cameras, in their order; `ValueError` names one that is not there."""
        for name in cameras:
            if name not in self.cameras:
                raise ValueError(f"expected a camera of {self.cameras}, found {name!r}")
        at = [self.cameras.index(name) for name in cameras]
        size = len(PARAMETERS)
        rows = np.concatenate([size * k + np.arange(size) for k in at])
        return CameraCovariance(list(cameras), self.covariance[np.ix_(rows, rows)])


def columns(n_cameras):
    """Return where the parameters of cameras stand in the columns of their network, (14 C,) int."""
    places = []
    for at in range(n_cameras):
        places.append(IMAGE * at + np.arange(IMAGE - len(FLEX)))
        places.append(IMAGE * n_cameras + len(LENS) * at + np.arange(len(LENS)))
    return np.concatenate(places) if places else np.zeros(0, dtype=int)


def of_network(cameras, covariance):
    """Build a `CameraCovariance` from that of a network's columns (K, K)."""
    at = columns(len(cameras))
    return CameraCovariance(list(cameras), covariance[np.ix_(at, at)])


def write(path, found):
    """Write a `CameraCovariance`; a camera whose covariance is unknown has NaN."""
    arrays = {
        "camera": np.array(found.cameras, dtype=str),
        "parameter": np.array(PARAMETERS, dtype=str),
        "covariance": np.asarray(found.covariance, dtype=float),
    }
    npz.write(path, FORM, SPEC, arrays)


def read(path):
    """Read a `CameraCovariance`; an `InputError` says what is wrong with a file that is none."""
    found = npz.read(path, FORM, SPEC)
    return CameraCovariance([str(name) for name in found["camera"]], found["covariance"])
