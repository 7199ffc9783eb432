"""Predict the error of a planned session from its cameras' covariance, without any picture."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.calibration import point_covariance
from courtside.calibration.bundle import selection, solver, walk_parts
from courtside.calibration.bundle.problem import IMAGE, Network
from courtside.calibration.court import joint_adjustment, quality
from courtside.calibration.court.court import Court
from courtside.calibration.planning import cameras, tie_points
from courtside.geometry.camera import Camera, in_picture, project
from courtside.study.errors import InputError

QUANTILES = (0.05, 0.5, 0.95)
N_DRAWS = 2000  # 100 of them lie beyond the outer quantiles
CENTRE_HEIGHT_M = 1.0  # ASSUME: above the court's centre, where angles between views are measured
# ASSUME: in the virtual study every model with neighbours up to 9.5 degrees apart held together.
WIDEST_DEG = 6.0
LOOSE_RAD = 0.1  # ASSUME: a camera whose rotation is less certain is not placed
NEARLY_LEAST = 1.1  # ASSUME: an error within 10 % of the least is as good


@dataclass(frozen=True, eq=False)
class Prediction:
    """What to expect with one number of bridging images."""

    n_images: int
    neighbour_deg: float  # widest angle of neighbours from the court's centre; NaN without a walk
    n_ties: int  # points that tie images
    least_ties: int  # points that the fixed camera with the fewest sees
    error_cm: tuple[float, ...]  # `QUANTILES` of the rms error over the volume; NaN where `fault`
    solution: joint_adjustment.Solution | None = None  # cameras as planned, with their covariance
    fault: str = ""  # why nothing can be predicted, or empty


def predict(
    fixed: Sequence[Camera],
    walked: Sequence[Camera],
    court: Court,
    hall_m: ArrayLike,
    texture: tie_points.Texture,
    lens_prior: tuple[NDArray, NDArray],
    *,
    seed: int,
    images_per_part: int,
    tie_sigma: float,
    thinning: Mapping[str, Any],
    **clicking: Any,
) -> Prediction:
    """Predict the error over the court with planned fixed cameras and bridging images.

    Without any image of a walk the cameras rest on clicked court points, and on what fixed cameras
    that stand near one another see alike. The hall and lenses are as for `tie_points.network`,
    `images_per_part` as for `walk_parts.split`; `tie_sigma` is the weight of ties in units of their
    noise, as after a session; `thinning` are arguments of `selection.thin`, `**clicking` sigma,
    bias and loss of clicks in `joint_adjustment.solve`.
    """
    rng = np.random.default_rng([seed, len(walked)])
    ties = tie_points.network(fixed, walked, hall_m, texture, lens_prior, rng)
    names, sizes = tuple(c.name for c in fixed), tuple(c.size for c in fixed)
    at, known = range(len(fixed)), []
    for part in walk_parts.split(ties, at, images_per_part):
        tied = selection.thin(part.network, **thinning)
        tied = selection.weigh(tied, sigma_px=tie_sigma * texture.noise_px, loss_scale=np.inf)
        known.append(_constraints(tied, part.fixed))
    knowledge, ties = solver.mean(known), selection.thin(ties, **thinning)
    n_seen = [np.count_nonzero(ties.image_idx == k) for k in at]
    angle_deg = widest_angle_deg(fixed, walked, court)
    found = (len(walked), angle_deg, len(ties.xyz), int(min(n_seen)))
    try:
        solution = joint_adjustment.solve_by_edges(
            joint_adjustment.Ties(names, sizes, knowledge), clicks(fixed, court), court, **clicking
        )
    except InputError as error:
        return Prediction(*found, (np.nan,) * len(QUANTILES), fault=str(error))
    if loose := _loose(solution, fixed, court):
        return Prediction(*found, (np.nan,) * len(QUANTILES), fault=loose)
    return Prediction(*found, error_quantiles_cm(solution, fixed, court, rng), solution)


def _loose(solution: joint_adjustment.Solution, fixed: Sequence[Camera], court: Court) -> str:
    """Return one line on a camera that neither its ties nor its court points place, or nothing."""
    variance = np.diag(solution.covariance)
    for at, (name, xy) in enumerate(clicks(fixed, court).items()):
        of_turn = variance[IMAGE * at : IMAGE * at + 3]
        if of_turn.min() < 0 or of_turn.max() > LOOSE_RAD**2:
            return (
                f"camera {name}: expected it to be placed by ties or court points, found "
                f"{np.isfinite(xy[:, 0]).sum()} court points in its picture; turn it towards the "
                "court, or walk closer past it"
            )
    return ""


def _constraints(ties: Network, fixed: NDArray) -> solver.Quadratic:
    if len(ties.xy):
        return selection.marginalise(ties, fixed)
    # Without ties: of the lenses only.
    alone = selection.images_only(ties, fixed)
    of_lenses = ties.lens_sigma[ties.lens_of_image[fixed]].ravel() ** -2.0
    information = np.append(np.zeros(alone.n_columns - len(of_lenses)), of_lenses)
    return solver.Quadratic(alone, np.diag(information), np.zeros(alone.n_columns))


def widest_angle_deg(fixed: Sequence[Camera], walked: Sequence[Camera], court: Court) -> float:
    """Return the widest angle of neighbours 1 m above the court's centre; NaN without a walk."""
    if not walked:
        return np.nan
    centres = np.array([c.centre_in_world for c in [*fixed, *walked]])
    point = [*np.asarray(court.size_m) / 2, CENTRE_HEIGHT_M]
    is_fixed = np.arange(len(centres)) < len(fixed)
    return float(cameras.path_angles_deg(is_fixed, centres, point).max())


def clicks(fixed: Sequence[Camera], court: Court) -> dict[str, NDArray]:
    """Return where each camera sees the court's points, (P, 2) px; NaN outside its picture."""
    seen = {}
    for each in fixed:
        xy = project(each, court.xyz)
        seen[each.name] = np.where(in_picture(each, xy)[:, None], xy, np.nan)
    return seen


def error_quantiles_cm(
    solution: joint_adjustment.Solution,
    fixed: Sequence[Camera],
    court: Court,
    rng: np.random.Generator,
) -> tuple[float, ...]:
    """Return the `QUANTILES` of the root mean square error over the playing volume, cm.

    Each place is seen by the planned cameras that have it in their pictures; places that fewer than
    two have are left out.
    """
    grid = quality.volume(court)
    seen = point_covariance.shown(fixed, grid)
    by_column = point_covariance.sensitivity(solution.network, grid, seen)
    by_column = by_column[np.isfinite(by_column).all(axis=(1, 2))]
    n_places, by_column = len(by_column), by_column.reshape(-1, by_column.shape[2])
    extent, axes = np.linalg.eigh(solution.covariance)
    root = axes * np.sqrt(np.maximum(extent, 0))
    error_m = by_column @ root @ rng.standard_normal((root.shape[1], N_DRAWS))
    rms_cm = 100 * np.sqrt((error_m**2).sum(axis=0) / n_places)
    return tuple(np.quantile(rms_cm, QUANTILES).tolist())


def alone(prediction: Prediction) -> str:
    """Return one line on the error to expect without a walk."""
    low, middle, high = prediction.error_cm
    return (
        f"court points alone: median error {middle:.2f} cm, in 90 % of sessions {low:.2f} to "
        f"{high:.2f} cm"
    )


def needed(
    predictions: Sequence[Prediction], *, min_points: int, target_cm: float | None = None
) -> tuple[Prediction | None, str]:
    """Return the prediction with the fewest images that are enough, and why; or None and why not.

    A fixed camera needs `min_points` ties. `target_cm` is the median error that is wanted, by
    default the least of all predictions, within 10 %.
    """
    whole = [p for p in predictions if p.n_images and p.neighbour_deg <= WIDEST_DEG]
    if not whole:
        reason = f"in none are neighbouring views within {WIDEST_DEG:g} degrees: take more images"
        return None, reason
    placed = [p for p in whole if not p.fault and p.least_ties >= min_points]
    if not placed:
        return None, f"some fixed camera has fewer than {min_points} ties: walk closer past it"
    best = min(p.error_cm[1] for p in placed)
    wanted = NEARLY_LEAST * best if target_cm is None else target_cm
    enough = [p for p in placed if p.error_cm[1] <= wanted]
    if not enough:
        help_ = "sharper clicks, more pixels or other camera places help"
        return None, f"the least is {best:.2f} cm: {help_}"
    first = min(enough, key=lambda p: p.n_images)
    return first, (
        f"neighbours within {WIDEST_DEG:g} degrees, {min_points} ties or more for each fixed "
        f"camera, median error up to {wanted:.2f} cm"
    )
