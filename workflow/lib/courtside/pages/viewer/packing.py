"""Arrays as short text for a page: integers as differences over time, deflated, in base64."""

import base64
import zlib

import numpy as np
from numpy.typing import NDArray

STEP_M = 0.001  # of a stored position, which errs by at most half of it
REACH_M = 32.0  # from the middle: within int16 in steps of 1 mm; joints beyond are not drawn
LEAST, MOST = 1e-5, 10.0  # of a size on the logarithmic scale, in its own unit
LEVELS = 254  # of that scale, so that neighbours differ by 5.6 %; 0 is unknown
ANGLES = 255  # steps of a half turn


def integers(values: NDArray) -> str:
    """Pack integers that change little along the last axis.

    Base64 of a zlib stream of the differences along the last axis, modulo 2^16, as two planes: all
    low bytes, then all high ones. The first value of each row is a difference from 0. `values` are
    (..., T); `ValueError` if one is beyond int16.
    """
    values = np.asarray(values)
    if values.size and (values.min() < -(1 << 15) or values.max() >= 1 << 15):
        raise ValueError(f"expected int16, found {values.min()} to {values.max()}")
    steps: NDArray = np.diff(values.astype(np.int32), axis=-1, prepend=0)
    changes = steps & 0xFFFF
    planes = np.concatenate([(changes & 0xFF).ravel(), (changes >> 8).ravel()]).astype(np.uint8)
    return base64.b64encode(zlib.compress(planes.tobytes(), 6)).decode("ascii")


def positions(xyz: NDArray, middle: NDArray) -> tuple[str, NDArray]:
    """Pack positions (P, T, J, 3) m, NaN where missing, in whole millimetres from `middle` (3,) m.

    Return `integers` of (P, J, 3, T), in which a missing value repeats the one before it; and which
    joints (P, T, J) have three coordinates, none further than 32 m from the middle.
    """
    offset_m = np.asarray(xyz, dtype=float) - middle
    near = np.abs(np.where(np.isfinite(offset_m), offset_m, np.inf)) <= REACH_M
    known = np.asarray(near.all(axis=-1))
    steps = np.round(np.where(known[..., None], offset_m, 0) / STEP_M).astype(np.int32)
    return integers(_held(np.moveaxis(steps, 1, -1), np.moveaxis(known, 1, -1)[:, :, None])), known


def _held(values: NDArray, known: NDArray) -> NDArray:
    """Repeat the last known value along the last axis where one is missing; 0 before the first."""
    at = np.where(known, np.arange(values.shape[-1]), 0)
    at = np.broadcast_to(np.maximum.accumulate(at, axis=-1), values.shape)
    return np.take_along_axis(values, at, axis=-1)


def sizes(values: NDArray) -> NDArray:
    """Quantise positive numbers, clipped to 1e-5 ... 10, on a logarithmic scale.

    Levels 1 to 255 are `LEAST * (MOST / LEAST) ** ((level - 1) / 254)`, within 2.8 % of the value;
    0 is NaN.
    """
    values = np.asarray(values, dtype=float)
    known = np.isfinite(values)
    share = np.log(np.clip(np.where(known, values, 1), LEAST, MOST) / LEAST) / np.log(MOST / LEAST)
    return np.where(known, 1 + np.round(LEVELS * share), 0).astype(int)


def ellipsoids(covariance: NDArray) -> NDArray:
    """Quantise covariances into six small integers that always give a valid covariance back.

    From (..., 3, 3) m2, NaN where unknown, to (..., 6): `sizes` of the standard deviations along x,
    y, z (metres), then three angles in steps of pi / 255. With a, b, c these angles, the rows
    (1, 0, 0), (cos a, sin a, 0) and (cos b, sin b cos c, sin b sin c) are the Cholesky factor of
    the correlations. All 0 where unknown.

    The angles of Rapisarda, Brigo & Mercurio 2007, Parameterizing correlations: the result is
    positive semidefinite whatever the rounding.
    """
    covariance = np.asarray(covariance, dtype=float)
    known = np.isfinite(covariance).all(axis=(-2, -1))
    covariance = np.where(known[..., None, None], covariance, np.eye(3))
    sigma = np.sqrt(np.maximum(np.diagonal(covariance, axis1=-2, axis2=-1), LEAST**2))
    related = np.clip(covariance / (sigma[..., :, None] * sigma[..., None, :]), -1, 1)
    a, b = np.arccos(related[..., 0, 1]), np.arccos(related[..., 0, 2])
    beside = np.maximum(np.sin(a) * np.sin(b), 1e-9)
    rest = np.clip((related[..., 1, 2] - np.cos(a) * np.cos(b)) / beside, -1, 1)
    angles = np.round(np.stack([a, b, np.arccos(rest)], axis=-1) / np.pi * ANGLES)
    levels = np.concatenate([sizes(sigma), angles.astype(int)], axis=-1)
    return np.where(known[..., None], levels, 0)
