"""Simulated clicks: what a person marks in the pictures of the fixed cameras."""

import zlib

import numpy as np

from courtside.geometry import camera as projection
from courtside.virtual import presets

FULL_WIDTH_PX = 3840  # clicking errors are stated for pictures of this width


def simulate(cameras, points_xyz, *, sigma_px_at_3840, bias_px_at_3840, rng):
    """Click points as one person would.

    Parameters
    ----------
    cameras : list of Camera
    points_xyz : (P, 3) float
        Where the points really are, metres.
    sigma_px_at_3840 : float
        Standard deviation per axis of one click, px, in a picture 3840 px wide; it scales with the
        width, as a person zooms in on the same content.
    bias_px_at_3840 : float
        Standard deviation per axis of the person's own habit: one vector, the same for every click.
    rng : numpy.random.Generator
        Draws the same numbers whatever the cameras see, so that a click depends on nothing but its
        place in the order.

    Returns
    -------
    clicks : dict of str to (P, 2) float
        For each camera px; NaN where the point or its click is outside the picture.
    """
    bias = rng.standard_normal(2) * bias_px_at_3840
    clicks = {}
    for camera in cameras:
        error = bias + rng.standard_normal((len(points_xyz), 2)) * sigma_px_at_3840
        xy = projection.project(camera, points_xyz) + error * camera.size[0] / FULL_WIDTH_PX
        seen = ((xy >= -0.5) & (xy <= np.array(camera.size) - 0.5)).all(axis=1)
        clicks[camera.name] = np.where(seen[:, np.newaxis], xy, np.nan)
    return clicks


def draws(cameras, points_xyz, *, n_draws, seed, preset, session):
    """Yield the clicks of several persons, the same for every method and every number of images of a session.

    Parameters
    ----------
    cameras : list of Camera
    points_xyz : (P, 3) float
        Where the points really are, metres.
    n_draws, seed : int
    preset : str
        A key of `presets.PRESETS`, which says how well people click.
    session : str
        Other sessions get other numbers.
    """
    made = presets.PRESETS[preset]
    for draw in range(n_draws):
        rng = np.random.default_rng([seed, zlib.crc32(session.encode()), draw])
        yield simulate(
            cameras,
            points_xyz,
            sigma_px_at_3840=made.click_sigma_px_at_3840,
            bias_px_at_3840=made.click_bias_px_at_3840,
            rng=rng,
        )
