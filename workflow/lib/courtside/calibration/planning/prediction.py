"""What error to expect of a session that is only planned: its cameras' covariance, without any picture."""

from dataclasses import dataclass

import numpy as np

from courtside.calibration import point_covariance
from courtside.calibration.bundle import selection, solver, walk_parts
from courtside.calibration.court import joint_adjustment, quality
from courtside.calibration.planning import cameras, tie_points
from courtside.geometry.camera import project
from courtside.study.errors import InputError

QUANTILES = (0.05, 0.5, 0.95)
N_DRAWS = 2000
CENTRE_HEIGHT_M = 1.0  # angles between neighbouring views are measured there
# ASSUME: in the virtual study every model with neighbours up to 9.5 degrees apart held together.
WIDEST_DEG = 6.0
SPARE = 1.1  # an error this near to the least is as good


@dataclass(frozen=True, eq=False)
class Prediction:
    """What to expect with one number of bridging images.

    Attributes
    ----------
    n_images : int
    neighbour_deg : float
        Widest angle between neighbouring views, seen from the court's centre; NaN without a walk.
    n_ties : int
        Points that tie images.
    least_ties : int
        Points that the fixed camera with the fewest sees.
    error_cm : tuple of float
        5 %, 50 % and 95 % quantile of the root mean square error over the volume; NaN where `fault`.
    solution : courtside.calibration.court.joint_adjustment.Solution or None
        Cameras as planned, with their covariance.
    fault : str
        Why nothing can be predicted, or empty.
    """

    n_images: int
    neighbour_deg: float
    n_ties: int
    least_ties: int
    error_cm: tuple
    solution: object = None
    fault: str = ""


def predict(
    fixed,
    walked,
    court,
    hall_m,
    texture,
    lens_prior,
    *,
    seed,
    images_per_part,
    tie_sigma,
    thinning,
    **clicking,
):
    """Predict the error over the court with planned fixed cameras and bridging images.

    Parameters
    ----------
    fixed, walked : list of Camera
        `walked` may be empty: then the cameras rest on clicked court points alone.
    court : courtside.calibration.court.court.Court
    hall_m : (2, 3) float
        Two opposite corners of the hall, m.
    texture : courtside.calibration.planning.tie_points.Texture
    lens_prior : (mean, sigma)
        As for `tie_points.network`.
    seed : int
    images_per_part : int
        See `walk_parts.split`.
    tie_sigma : float
        Weight of ties, in their noise: as after a session.
    thinning : dict
        Arguments of `selection.thin`.
    **clicking
        `click_sigma_px`, `click_bias_px`, `click_loss` of `joint_adjustment.solve`.

    Returns
    -------
    prediction : Prediction
    """
    rng = np.random.default_rng([seed, len(walked)])
    ties = tie_points.network(fixed, walked, hall_m, texture, lens_prior, rng)
    names, sizes = tuple(c.name for c in fixed), tuple(c.size for c in fixed)
    at, known = range(len(fixed)), []
    for part in walk_parts.split(ties, at, images_per_part):
        tied = selection.thin(part.network, **thinning)
        tied = selection.weigh(tied, sigma_px=tie_sigma * texture.noise_px, loss_scale=np.inf)
        known.append(_what_is_known(tied, part.fixed))
    knowledge, ties = solver.mean(known), selection.thin(ties, **thinning)
    n_seen = [np.count_nonzero(ties.image_idx == k) for k in at]
    found = (len(walked), widest_angle_deg(fixed, walked, court), len(ties.xyz), min(n_seen))
    try:
        solution = joint_adjustment.solve(
            joint_adjustment.Ties(names, sizes, knowledge), clicks(fixed, court), court, **clicking
        )
    except InputError as error:
        return Prediction(*found, (np.nan,) * len(QUANTILES), fault=str(error))
    return Prediction(*found, error_quantiles_cm(solution, court, rng), solution)


def _what_is_known(ties, fixed):
    if len(ties.xy):
        return selection.what_ties_say(ties, fixed)
    # Without ties: of the lenses only.
    alone = selection.alone(ties, fixed)
    information = np.zeros((alone.n_columns, alone.n_columns))
    lens = information.shape[0] - ties.lens_sigma[: len(fixed)].size
    sigma = ties.lens_sigma[ties.lens_of_image[list(fixed)]].ravel()
    information[range(lens, len(information)), range(lens, len(information))] = sigma**-2.0
    return solver.Quadratic(alone, information, np.zeros(len(information)))


def widest_angle_deg(fixed, walked, court):
    """Return the widest angle between neighbouring views, seen 1 m above the court's centre.

    Parameters
    ----------
    fixed, walked : list of Camera
    court : courtside.calibration.court.court.Court

    Returns
    -------
    angle_deg : float
        NaN without a walk.
    """
    if not walked:
        return np.nan
    centres = np.array([c.centre_in_world for c in [*fixed, *walked]])
    point = [*np.asarray(court.size_m) / 2, CENTRE_HEIGHT_M]
    is_fixed = np.arange(len(centres)) < len(fixed)
    return float(cameras.path_angles_deg(is_fixed, centres, point).max())


def clicks(fixed, court):
    """Return where each camera sees the court's points, dict of (P, 2) px; NaN outside its picture."""
    seen = {}
    for each in fixed:
        with np.errstate(invalid="ignore"):
            xy = project(each, court.xyz)
            inside = ((xy >= -0.5) & (xy <= np.array(each.size) - 0.5)).all(axis=1)
        seen[each.name] = np.where(inside[:, None], xy, np.nan)
    return seen


def error_quantiles_cm(solution, court, rng):
    """Return the quantiles `QUANTILES` of the root mean square error over the playing volume, cm.

    Parameters
    ----------
    solution : courtside.calibration.court.joint_adjustment.Solution
    court : courtside.calibration.court.court.Court
    rng : numpy.random.Generator
    """
    grid = quality.volume(court)
    by_column = point_covariance.sensitivity(solution.network, grid).reshape(3 * len(grid), -1)
    extent, axes = np.linalg.eigh(solution.covariance)
    root = axes * np.sqrt(np.maximum(extent, 0))
    error_m = by_column @ root @ rng.standard_normal((root.shape[1], N_DRAWS))
    rms_cm = 100 * np.sqrt((error_m**2).sum(axis=0) / len(grid))
    return tuple(np.quantile(rms_cm, QUANTILES).tolist())


def needed(predictions, *, min_points, target_cm=None):
    """Return the prediction with the fewest bridging images that will do, and why, or None and why not.

    Parameters
    ----------
    predictions : list of Prediction
        With a walk; in any order.
    min_points : int
        Fewest ties that place a fixed camera.
    target_cm : float, optional
        Median error that is wanted; without, the least of all predictions, within 10 %.

    Returns
    -------
    prediction : Prediction or None
    reason : str
    """
    whole = [p for p in predictions if p.n_images and p.neighbour_deg <= WIDEST_DEG]
    if not whole:
        return (
            None,
            f"in none are neighbouring views within {WIDEST_DEG:g} degrees: take more images",
        )
    placed = [p for p in whole if not p.fault and p.least_ties >= min_points]
    if not placed:
        return None, f"some fixed camera has fewer than {min_points} ties: walk closer past it"
    best = min(p.error_cm[1] for p in placed)
    wanted = SPARE * best if target_cm is None else target_cm
    enough = [p for p in placed if p.error_cm[1] <= wanted]
    if not enough:
        return (
            None,
            f"the least is {best:.2f} cm: sharper clicks, more pixels or other camera places help",
        )
    first = min(enough, key=lambda p: p.n_images)
    return first, (
        f"neighbours within {WIDEST_DEG:g} degrees, {min_points} ties or more for each fixed camera, "
        f"median error up to {wanted:.2f} cm"
    )
