"""Two-view geometries of a database: how many matches a map explains, and known lenses."""

import contextlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pycolmap
import scipy
from numpy.typing import NDArray

from courtside.calibration.records.support import Support
from courtside.geometry import epipolar
from courtside.geometry.camera import Camera, undistort
from courtside.sfm import database
from courtside.sfm.model import HALF_PIXEL
from courtside.study.errors import StrPath

NEAR_PX = 4.0  # from an epipolar line, as COLMAP verifies matches
PAIR_MATCHES = 50  # ASSUME: fewer verified matches may all be false


@dataclass(frozen=True, eq=False)
class Verified:
    """Verified matches of some images."""

    images: tuple[str, ...]  # their names
    places: Mapping[str, NDArray]  # (N, 2) px of an image's features, by name
    matches: Mapping[tuple[str, str], NDArray]  # (M, 2) indices of features, of pairs with any


def read(matches_db: StrPath, images: Sequence[str]) -> Verified:
    """Read the verified matches of some images of a finished database."""
    with (
        database.working_copy(matches_db) as copy,  # opening one for reading writes to it
        contextlib.closing(pycolmap.Database.open(copy)) as opened,
    ):
        chosen = {i.name: i for i in opened.read_all_images() if i.name in set(images)}
        places = {
            name: opened.read_keypoints(image.image_id)[:, :2] - HALF_PIXEL
            for name, image in chosen.items()
        }
        return Verified(tuple(images), places, dict(_verified(opened, chosen)))


def joined(verified: Verified) -> tuple[str, ...]:
    """Return the images of the largest group that verified matches join, all where none are.

    The others, such as a picture of another place, can be in no map with these.
    """
    number = {name: at for at, name in enumerate(verified.images)}
    pairs = [(number[one], number[other]) for one, other in verified.matches]
    if not pairs:
        return verified.images
    ones, others = np.transpose(pairs)
    links = scipy.sparse.coo_array((np.ones(len(pairs)), (ones, others)), (len(number),) * 2)
    group = scipy.sparse.csgraph.connected_components(links, directed=False)[1]
    largest = np.bincount(group).argmax()
    return tuple(name for name, at in number.items() if group[at] == largest)


def explained(verified: Verified, views: Sequence[Camera]) -> Support:
    """Return how much of the verified matches of some images a map of them explains.

    A match counts if its Sampson distance is below `NEAR_PX` and its point lies before both images
    (Hartley & Zisserman 2004, section 11.4.3). An image that is not in the map explains nothing.

    Parameters
    ----------
    verified : of all images that were to be mapped
    views : the mapped ones, with their names
    """
    counts, rays = {}, {}
    placed = {view.name: view for view in views}
    for name in placed.keys() & verified.places.keys():
        xy = verified.places[name]
        rays[name] = np.column_stack([undistort(placed[name], xy), np.ones(len(xy))])
    for (one, other), matches in verified.matches.items():
        good = 0
        if one in rays and other in rays:
            seen = rays[one][matches[:, 0]], rays[other][matches[:, 1]]
            good = int(np.count_nonzero(_meet(placed[one], placed[other], *seen)))
        counts[one, other] = good, len(matches)
    return _support(counts, verified.images)


def _support(counts: Mapping[tuple[str, str], tuple[int, int]], images: Sequence[str]) -> Support:
    sums = {name: _share([n for pair, n in counts.items() if name in pair]) for name in images}
    large = {pair: _share([n]) for pair, n in counts.items() if n[1] >= PAIR_MATCHES}
    image = min(images, key=lambda name: sums[name], default="")
    pair = min(large, key=lambda pair: large[pair], default=("", ""))
    share = _share(list(counts.values()))
    return Support(share, image, sums.get(image, 1.0), pair, large.get(pair, 1.0))


def _share(counts: Sequence[tuple[int, int]]) -> float:
    good, total = (sum(column) for column in zip(*counts, strict=True)) if counts else (1, 1)
    return good / total


@contextlib.contextmanager
def with_known_lenses(matches_db: StrPath, images: Sequence[str], *, seed: int) -> Iterator[Path]:
    """Yield a copy of a database whose two-view geometries take the first guess of lenses as known.

    A plane does not determine a fundamental matrix, and many pictures of a walk show mostly floor.
    An essential matrix gives a relative pose to start from, if the guess is not far off.
    """
    options = pycolmap.TwoViewGeometryOptions(compute_relative_pose=True)
    options.ransac.random_seed = seed
    with database.working_copy(matches_db) as path:
        with contextlib.closing(pycolmap.Database.open(path)) as opened:
            lenses = {lens.camera_id: lens for lens in opened.read_all_cameras()}
            for lens in lenses.values():
                lens.has_prior_focal_length = True
                opened.update_camera(lens)
            chosen = {i.name: i for i in opened.read_all_images() if i.name in set(images)}
            places = {
                name: opened.read_keypoints(image.image_id)[:, :2].astype(float)
                for name, image in chosen.items()
            }
            for pair, matches in list(_verified(opened, chosen)):
                both = [chosen[name] for name in pair]
                seen = [(lenses[image.camera_id], places[image.name]) for image in both]
                found = pycolmap.estimate_calibrated_two_view_geometry(
                    *seen[0], *seen[1], matches, options
                )
                _replace_geometry(opened, [image.image_id for image in both], found, options)
        database.fold(path)
        yield path


def _replace_geometry(opened, ids, found, options) -> None:
    opened.delete_two_view_geometry(*ids)
    if len(found.inlier_matches) >= options.min_num_inliers:
        opened.write_two_view_geometry(*ids, found)


def _verified(opened: Any, chosen: Mapping[str, Any]) -> Iterator[tuple[tuple[str, str], NDArray]]:
    """Yield the names of each pair of images, the lower id first, and its verified matches."""
    ids = {name: image.image_id for name, image in chosen.items()}
    for one, other in combinations(sorted(ids, key=lambda name: ids[name]), 2):
        if opened.exists_two_view_geometry(ids[one], ids[other]):
            found = opened.read_two_view_geometry(ids[one], ids[other]).inlier_matches
            if len(found):
                yield (one, other), np.array(found)


def _meet(one: Camera, other: Camera, rays: NDArray, others: NDArray) -> NDArray:
    """Return which pairs of rays (N, 3), on the planes z = 1, meet before both cameras, (N,)."""
    turn, shift = epipolar.relative_pose(one, other)
    turned = rays @ turn.T
    lines, back = np.cross(shift, turned), np.cross(others, shift) @ turn
    slope = np.hypot(np.hypot(*lines[:, :2].T), np.hypot(*back[:, :2].T))
    focal_px = (one.K[1, 1] + other.K[1, 1]) / 2
    near = np.abs((others * lines).sum(axis=1)) * focal_px < NEAR_PX * slope
    across = np.cross(turned, others)  # depth * turned + shift = depth_in_other * others
    depth = (np.cross(others, shift) * across).sum(axis=1)
    depth_in_other = (np.cross(turned, shift) * across).sum(axis=1)
    return near & (depth > 0) & (depth_in_other > 0)
