"""What is known of cameras before people refine them, as a `Quadratic` about these cameras."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.bundle import conversion, solver
from courtside.calibration.bundle.problem import LENS, POSE
from courtside.calibration.records.covariance import PARAMETERS, CameraCovariance
from courtside.geometry.camera import Camera

ROUNDING = 1e-10  # of the largest variance: a smaller one is 0
KNOWN = 1e-6  # likewise, in place of 0: the adjustment solves stiffer priors less exactly


def stated(
    cameras: Sequence[Camera],
    *,
    rotation_deg: float,
    position_m: float,
    focal_percent: float,
    principal_point_percent: float,
    k1: float,
) -> CameraCovariance:
    """Return the covariance of cameras of a file, from standard deviations per number.

    The principal point's is in percent of the picture's longer side. The other numbers of a lens
    count as known.
    """
    found = np.zeros((len(cameras), len(PARAMETERS)))
    for sigma, camera in zip(found, cameras, strict=True):
        sigma[:3], sigma[3 : len(POSE)] = np.radians(rotation_deg), position_m
        of_lens = {"f_px": focal_percent / 100 * camera.K[1, 1], "k1": k1}
        centre_px = principal_point_percent / 100 * max(camera.size)
        of_lens |= dict.fromkeys(("cx_px", "cy_px"), centre_px)
        for name, value in of_lens.items():
            sigma[len(POSE) + LENS.index(name)] = value
    return CameraCovariance([c.name for c in cameras], np.diag(found.ravel() ** 2))


def knowledge(cameras: Sequence[Camera], known: CameraCovariance) -> solver.Quadratic:
    """Return what a covariance says of cameras, about them; numbers without variance are fixed.

    The covariance of cameras that define the world frame (a wand without clicks and floor) is
    singular. Their common movement, which it excludes, is known as well.
    """
    covariance = known.of([camera.name for camera in cameras]).of_columns()
    free = np.diag(covariance) > 0
    scale = np.sqrt(np.diag(covariance)[free])
    correlation = covariance[np.ix_(free, free)] / np.outer(scale, scale)
    information = np.zeros_like(covariance)
    extent, axes = np.linalg.eigh(correlation)
    varies = extent > ROUNDING * extent[-1]
    inverse = (axes / np.where(varies, extent, KNOWN * extent[-1])) @ axes.T
    information[np.ix_(free, free)] = inverse / np.outer(scale, scale)
    network = conversion.network_of(cameras)
    return solver.Quadratic(network, information, np.zeros(len(covariance)))


def lens_sigma(known: solver.Quadratic) -> NDArray:
    """Return for a network's lenses (L, 8): inf where a number is free, 0 where it is known."""
    n_lens = known.reference.lens.size
    free = np.diag(known.information)[-n_lens:] > 0
    return np.where(free, np.inf, 0.0).reshape(known.reference.lens.shape)
