"""Fixed cameras in the court's frame: bundle adjustment of ties between images and clicked court points.

The ties of one structure from motion are condensed once, into what they say of the fixed cameras; then
any set
of clicks costs milliseconds.
"""

from dataclasses import dataclass, replace

import numpy as np

from courtside.calibration import point_covariance as uncertainty
from courtside.calibration.bundle import selection, solver, walk_parts
from courtside.calibration.bundle.problem import FLEX, IMAGE, POSE
from courtside.calibration.court import sfm_alignment
from courtside.study.errors import InputError

UHD = 3840  # picture width at which click sigmas are stated
# Focal lengths are tied to the bend of the whole, and the cost falls slowly along a curved valley. Most
# sessions need 20 steps. With no more than these, one small one in thirty was 2.5 cm off instead of 0.9, and
# without a court the fixed cameras of one in five 4 to 7 degrees instead of 1.2 to 1.7.
ENOUGH = {"max_iterations": 200, "tolerance": 1e-6}


@dataclass(frozen=True, eq=False)
class Ties:
    """What structure from motion says of the fixed cameras.

    Attributes
    ----------
    cameras : tuple of str
        Names, in the order of the images of `knowledge.reference`.
    sizes : tuple of (int, int)
        Of their pictures, px.
    knowledge : courtside.calibration.bundle.solver.Quadratic
        In the court's frame, which the ties themselves leave open.
    """

    cameras: tuple
    sizes: tuple
    knowledge: solver.Quadratic


@dataclass(frozen=True, eq=False)
class Solution:
    """Fixed cameras in the court's frame with their joint covariance.

    Attributes
    ----------
    cameras : list of Camera
    network : courtside.calibration.bundle.problem.Network
        Of the fixed cameras and the court points used.
    covariance : (K, K) float
        Of the network's columns: for each camera rotation (3, rad, in its own frame) and translation of
        cam_from_world (3, m) and its flex (5, always 0), then for each camera its lens (`problem.LENS`).
    """

    cameras: list
    network: object
    covariance: np.ndarray

    def point_covariance(self, xyz):
        """Return the covariance (N, 3, 3) m2 of points (N, 3) triangulated from exact pixels."""
        return uncertainty.point_covariance(self.network, self.covariance, xyz)


def condense(
    network,
    fixed,
    sizes,
    clicks,
    court,
    *,
    images_per_part,
    tie_sigma_px,
    tie_loss,
    click_sigma_px,
    click_loss,
    **thinning,
):
    """Adjust a network with its clicks, part by part, and keep what its ties say of the fixed cameras.

    Parameters
    ----------
    network : courtside.calibration.bundle.problem.Network
        As `sfm.model.read` gives it.
    fixed : dict of str to int
        Index of each fixed camera's image; each has a lens of its own.
    sizes : dict of str to (int, int)
        Of their pictures, px.
    clicks : dict of str to (P, 2) float
        By camera; NaN where not clicked.
    court : courtside.calibration.court.court.Court
    images_per_part : int
        See `walk_parts.split`.
    tie_sigma_px : float
        Weight of the ties. Their errors are not independent: it is larger than a feature's own noise.
    tie_loss, click_loss : float
        Where Cauchy's loss sets in, in sigmas.
    click_sigma_px : float
        Of a click per axis, at a picture width of 3840 px; in proportion at others.
    **thinning
        Arguments of `selection.thin`.

    Returns
    -------
    ties : Ties
        The mean over the parts.
    parts : list of courtside.calibration.bundle.walk_parts.Part
        With their chosen points after adjustment, in the court's frame.

    Raises
    ------
    InputError
        If the clicks cannot give a frame.
    """
    cameras = selection.fixed_cameras(network, fixed, sizes)
    sigma_px = [click_sigma(click_sigma_px, sizes[name]) for name in fixed]

    def adjusted(clicks, straightened):
        in_world = selection.transform(network, _alignment(court, cameras, clicks))
        for part in walk_parts.split(in_world, list(fixed.values()), images_per_part):
            tied = _ties_of(part.network, tie_sigma_px, tie_loss, thinning)
            at = part.fixed.tolist()
            if straightened:  # from a bent start the clicks may pull it into another minimum
                tied = _adjusted_freely(tied, at)
                straight = _fixed_cameras(tied, fixed, at, sizes)
                tied = selection.transform(tied, _alignment(court, straight, clicks))
            marked = {
                "clicks": dict(zip(at, [clicks[name] for name in fixed], strict=True)),
                "sigma_px": dict(zip(at, sigma_px, strict=True)),
                "loss_scale": click_loss,
            }
            yield replace(part, network=_adjusted(tied, court, **marked))

    def adjusted_cameras(clicks):
        part = next(adjusted(clicks, straightened=True))
        return _fixed_cameras(part.network, fixed, part.fixed, sizes)

    sfm_alignment.refuse_exchanged_cameras(court, cameras, clicks, adjusted_cameras)
    parts = list(adjusted(clicks, sfm_alignment.is_bent(court, cameras, clicks)))
    return _condensed(parts, tuple(fixed), sizes), parts


def _fixed_cameras(network, names, at, sizes):
    return selection.fixed_cameras(network, dict(zip(names, map(int, at), strict=True)), sizes)


def _alignment(court, cameras, clicks):
    return sfm_alignment.align(court, sfm_alignment.reconstruct(cameras, clicks))[0]


def _adjusted_freely(network, fixed):
    """Return a network adjusted without clicks, in its free frame."""
    network, _ = solver.adjust(_in_free_frame(network, fixed), **ENOUGH)
    return _in_free_frame(network, fixed)  # which nothing held in place


def _adjusted(network, court, **marked):
    """Return a network adjusted with clicked court points, without these."""
    n_ties, n_seen = len(network.xyz), len(network.xy)
    both = selection.add(network, court.xyz, court.sigma_m, **marked)
    if not np.isfinite(solver.cost(both)):
        raise InputError(
            "court points: expected all before the cameras that saw them, found some behind after alignment; "
            "structure from motion went wrong: take more bridging images"
        )
    both, _ = solver.adjust(both, **ENOUGH)
    return selection.select(
        both, np.arange(len(both.xyz)) < n_ties, np.arange(len(both.xy)) < n_seen
    )


def condense_free(network, fixed, sizes, *, images_per_part, tie_sigma_px, tie_loss, **thinning):
    """Adjust a network that no court scales, in a frame of its own.

    Parameters
    ----------
    network, fixed, sizes, images_per_part, tie_sigma_px, tie_loss, **thinning
        As for `condense`.

    Returns
    -------
    ties : Ties
        In the frame of `selection.free_frame`: the unit is the distance between the first two fixed
        cameras.
    parts : list of courtside.calibration.bundle.walk_parts.Part
    """
    names, parts = tuple(fixed), []
    network = _in_free_frame(network, list(fixed.values()))
    for part in walk_parts.split(network, list(fixed.values()), images_per_part):
        tied = _ties_of(part.network, tie_sigma_px, tie_loss, thinning)
        parts.append(replace(part, network=_adjusted_freely(tied, part.fixed)))
    return _condensed(parts, names, sizes), parts


def _ties_of(network, sigma_px, loss_scale, thinning):
    network = selection.thin(network, **thinning)
    return selection.weigh(network, sigma_px=sigma_px, loss_scale=loss_scale)


def _condensed(parts, names, sizes):
    said = [selection.what_ties_say(part.network, part.fixed) for part in parts]
    return Ties(names, tuple(sizes[name] for name in names), solver.mean(said))


def _in_free_frame(network, fixed):
    return selection.transform(network, selection.free_frame(network, fixed))


def free(ties):
    """Return the `Solution` of ties that no court scales; the covariance leaves out frame and scale.

    Parameters
    ----------
    ties : Ties
        Of `condense_free`.
    """
    network = ties.knowledge.reference
    cameras = selection.cameras(network, ties.cameras, ties.sizes)
    return Solution(cameras, network, uncertainty.pseudo_inverse(ties.knowledge.information))


def click_sigma(sigma_px_at_3840, size):
    """Return the sigma of a click in a picture of this size, px."""
    return sigma_px_at_3840 * size[0] / UHD


def largest_click_sigma(sigma_px_at_3840, cameras):
    """Return the sigma of a click in the largest of the cameras' pictures, px."""
    return max(click_sigma(sigma_px_at_3840, camera.size) for camera in cameras)


def solve(
    ties, clicks, court, *, click_sigma_px, click_bias_px, click_loss, points=None, max_iterations=8
):
    """Find the fixed cameras from the condensed ties and any clicks.

    Parameters
    ----------
    ties : Ties
    clicks : dict of str to (P, 2) float
        By camera; NaN where not clicked.
    court : courtside.calibration.court.court.Court
    click_sigma_px, click_loss : float
        As for `condense`.
    click_bias_px : float
        What all clicks in one picture have in common, standard deviation per axis, at a width of 3840 px.
    points : (P,) bool, optional
        Court points to use; all without.
    max_iterations : int

    Returns
    -------
    solution : Solution

    Raises
    ------
    InputError
        If neither ties nor clicks place a camera.
    """
    network = _with_bias(ties, click_bias_px)
    use = np.ones(len(court.points), dtype=bool) if points is None else np.asarray(points)
    images = {
        at: np.where(use[:, None], clicks[name], np.nan) for at, name in enumerate(ties.cameras)
    }
    sigmas = {at: click_sigma(click_sigma_px, size) for at, size in enumerate(ties.sizes)}
    network = selection.add(
        network, court.xyz, court.sigma_m, images, sigma_px=sigmas, loss_scale=click_loss
    )
    network, normal = solver.adjust(
        network, quadratic=ties.knowledge, max_iterations=max_iterations, tolerance=1e-7
    )
    _check_placed(ties, normal)
    cameras = selection.cameras(network, ties.cameras, ties.sizes)
    covariance = uncertainty.of_columns(normal)
    shifts = _shift_columns(network)
    covariance[shifts], covariance[:, shifts] = 0.0, 0.0  # of the clicks, not of the cameras
    return Solution(cameras, network, covariance)


def _with_bias(ties, click_bias_px):
    """Return the fixed cameras free to shift their clicks: the ties are condensed, so nothing else shifts."""
    network = ties.knowledge.reference
    flex_sigma = np.zeros((len(ties.cameras), len(FLEX)))
    flex_sigma[:, 3:] = [[click_sigma(click_bias_px, size)] for size in ties.sizes]
    return replace(network, flex_sigma=flex_sigma)


def _shift_columns(network):
    first = IMAGE * np.arange(len(network.cam_from_world))
    return np.concatenate([first + IMAGE - 2, first + IMAGE - 1])


def _check_placed(ties, normal):
    of_images = normal.active[: IMAGE * len(ties.cameras)].reshape(-1, IMAGE)
    lost = [
        name
        for name, known in zip(ties.cameras, of_images, strict=True)
        if not known[: len(POSE)].all()
    ]
    if lost:
        raise InputError(
            f"camera {lost[0]}: expected matches with other images or clicked court points, found neither; "
            "click points in it, or film the walk closer to it"
        )
