"""Clicks of court points, with a person's errors."""

import zlib
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.geometry import camera as camera_models
from courtside.geometry.camera import Camera
from virtualgym import presets
from virtualgym.session import click_model


def click_points(
    cameras: Iterable[Camera],
    points_xyz: NDArray,
    *,
    sigma_px_at_3840: float,
    bias_px_at_3840: float,
    rng: np.random.Generator,
) -> dict[str, NDArray]:
    """Click points as one person would.

    Parameters
    ----------
    cameras : iterable of Camera
    points_xyz : (P, 3) float
        True places of the points, metres.
    sigma_px_at_3840 : float
        Standard deviation per axis of one click, px, in a picture of 3840 px; it scales with the
        longer side, as a person zooms in on the same content.
    bias_px_at_3840 : float
        Standard deviation per axis of the person's bias: one vector, the same for every click.
    rng : numpy.random.Generator
        It draws the same numbers whatever the cameras see, so that an error depends only on the
        click's place in the order.

    Returns
    -------
    clicks : dict of str to (P, 2) float
        For each camera px; NaN where the point or its click is outside the picture.
    """
    bias = rng.standard_normal(2) * bias_px_at_3840
    clicks = {}
    for camera in cameras:
        error = bias + rng.standard_normal((len(points_xyz), 2)) * sigma_px_at_3840
        error_px = error * max(camera.size) / click_model.FULL_WIDTH_PX
        clicks[camera.name] = _clicked(camera, points_xyz, error_px)
    return clicks


def _clicked(camera: Camera, points_xyz: NDArray, error_px: NDArray) -> NDArray:
    """Return clicks (P, 2) px; NaN where the point or its click is outside the picture."""
    xy = camera_models.project(camera, points_xyz) + error_px
    seen = camera_models.in_picture(camera, xy)
    return np.where(seen[:, np.newaxis], xy, np.nan)


def click_court(
    cameras: Iterable[Camera],
    court: Court,
    court_xyz: NDArray,
    *,
    preset: presets.Preset,
    rng: np.random.Generator,
    strength: float = 1.0,
) -> dict[str, NDArray]:
    """Click the points of a court as one person would, by `click_model`.

    Parameters
    ----------
    cameras : iterable of Camera
    court : Court
    court_xyz : (P, 3) float
        True places of its points, m.
    preset : Preset
    rng : numpy.random.Generator
        It draws the same numbers whatever the cameras see, and whatever the strength.
    strength : float
        Factor on every error: 1 is an average person.

    Returns
    -------
    clicks : dict of str to (P, 2) float
        For each camera px; NaN where the point or its click is outside the picture.
    """
    factor, bias = click_model.person(rng)
    clicks = {}
    for camera in cameras:
        covariance = click_model.covariance(camera, court_xyz, court, preset)
        drawn = rng.standard_normal((len(court_xyz), 2, 1))
        scatter = (np.linalg.cholesky(covariance) @ drawn)[..., 0]
        error = strength * (factor * scatter + bias * click_model.bias_px(camera))
        clicks[camera.name] = _clicked(camera, court_xyz, error)
    return clicks


def clicks_of_persons(
    cameras: Iterable[Camera],
    court: Court,
    court_xyz: NDArray,
    *,
    n_draws: int,
    seed: int,
    preset: str,
    session: str,
    strength: float = 1.0,
) -> Iterator[dict[str, NDArray]]:
    """Yield the clicks of `n_draws` persons, the same for all methods and numbers of images.

    Parameters
    ----------
    cameras : iterable of Camera
    court : Court
    court_xyz : (P, 3) float
        True places of its points, m.
    n_draws, seed : int
    preset : str
        A key of `presets.PRESETS`, which gives the noise of the pictures.
    session : str
        Name; other sessions get other random numbers.
    strength : float
        Factor on every error.
    """
    made = presets.PRESETS[preset]
    for draw in range(n_draws):
        rng = np.random.default_rng([seed, zlib.crc32(session.encode()), draw])
        yield click_court(cameras, court, court_xyz, preset=made, rng=rng, strength=strength)


def clicks_of_strengths(
    strengths: Iterable[float],
    cameras: Sequence[Camera],
    court: Court,
    court_xyz: NDArray,
    *,
    n_draws: int,
    **drawn: Any,
) -> Iterator[tuple[dict[str, float], dict[str, NDArray]]]:
    """Yield labels `click_strength` and `draw`, and `clicks_of_persons` of each strength.

    At other strengths than 1 click a third of the persons: they only show how errors grow.
    """
    for strength in strengths:
        n_persons = n_draws if strength == 1 else max(1, n_draws // 3)
        made = clicks_of_persons(
            cameras, court, court_xyz, n_draws=n_persons, strength=strength, **drawn
        )
        for draw, marked in enumerate(made):
            yield {"click_strength": strength, "draw": draw}, marked
