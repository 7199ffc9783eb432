"""Initial cameras for the adjustment: two first, then one after another.

Of unknown focal lengths, several are tried. For two cameras the best one gives the least variation
of the wand's length (pose by Nistér 2004), for each further camera the most agreeing markers
(Terzakis & Lourakis 2020).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product

import numpy as np
import scipy
from numpy.typing import NDArray

from courtside.calibration import robust_poses
from courtside.calibration.wand.points import Seen, Wand
from courtside.geometry import camera as camera_models
from courtside.geometry import epipolar
from courtside.geometry.camera import Camera, undistort
from courtside.geometry.triangulation import Triangulated, triangulate_robust
from courtside.study.errors import InputError

# ASSUME: focal lengths over the picture's longer side, from action cameras to short telephoto
# lenses. The adjustment finds values between them.
FOCAL_SHARES = (0.5, 0.6, 0.7, 0.84, 1.0, 1.2, 1.45, 1.75, 2.1, 2.5)
COARSE = 2  # of the first two cameras every second focal length is tried, of others all
FEWEST_FRAMES = 20  # ASSUME: frames in which both of two cameras see two markers or more
SAMPLE = 400  # markers from which a pose is estimated
TOLERANCE = 0.004  # ASSUME: residual of a marker with an unknown lens, of the longer side
LEAST_SHARE = 0.5  # ASSUME: of markers that agree with the first two cameras
LEAST_AGREEING = 0.3  # ASSUME: the same of a further camera, whose lens may be unknown
STARTS, ENOUGH = 6, 0.8  # first pairs that are tried; share of markers that ends the search
LEAST_SINE = 0.05  # ASSUME: of the angle between rays (3 degrees), for enough parallax
PAIRS = 3  # pairs of cameras that are tried, those with most common frames
HOW = "move it through the views of all cameras, near and far, high and low, in all directions"
CHECK = "check its clock, that no markers are exchanged, and that its video is not mirrored"
SELDOM = (
    "it sees the wand too seldom together with two of the others: move the wand where three "
    "cameras see it"
)


@dataclass(frozen=True, eq=False)
class _Pair:
    """Two cameras in the frame of the first, in metres."""

    cameras: tuple[Camera, Camera]
    agreeing: int  # markers
    sine: float  # of the angle between rays, median
    spread: float  # median deviation of the wand's length, as a share


@dataclass(frozen=True, eq=False)
class Placed:
    """Cameras by name, and the lowest agreement of a camera with those placed before it."""

    cameras: dict[str, Camera]
    agreeing: float  # share of its markers; negative if a camera could not be placed
    spread: float = np.inf  # of the wand's length by the first two, as a share
    fault: str = ""  # why a camera could not be placed
    accused: str = ""  # its name


class Disagreement(InputError):
    """Cameras do not agree on where the wand is; which of them are wrong is not known."""

    def __init__(self, fault: str, accused: str = "") -> None:
        super().__init__(fault)
        self.accused = accused  # the camera that its fault names, if it names one


def guess(
    wand: Wand, seen: Seen, sizes: Mapping[str, tuple[int, int]], lenses: Mapping[str, Camera]
) -> list[Camera]:
    """Return initial cameras in the frame of one of them, in metres.

    `sizes` are those of the pictures by camera, px; `lenses` are the known ones. Raises
    `InputError` if the wand does not determine the poses.
    """
    _check(seen, _shared(seen))
    best = placed(wand, seen, [candidates(name, sizes[name], lenses) for name in seen.cameras])
    if best.fault:
        raise Disagreement(best.fault, best.accused)
    return [best.cameras[name] for name in seen.cameras]


def placed(
    wand: Wand, seen: Seen, cameras: Sequence[Sequence[Camera]], starts: int = STARTS
) -> Placed:
    """Return the cameras from the best of some `starts`, with the fault if none gives them all.

    `cameras` are the `candidates` for each. Raises `InputError` if all pairs are too close.
    """
    tried = []
    for first in _first(wand, seen, cameras)[:starts]:
        tried.append(_completed(first, seen, cameras))
        if tried[-1].agreeing >= ENOUGH:
            break
    nothing = Placed({}, -1.0, fault=_no_pair("no pair whose markers agree"))
    return max(tried, key=lambda one: one.agreeing, default=nothing)


def _completed(first: _Pair, seen: Seen, cameras: Sequence[Sequence[Camera]]) -> Placed:
    """Add all other cameras to two, each by the markers triangulated with those before it."""
    posed, least = {camera.name: camera for camera in first.cameras}, 1.0
    while len(posed) < len(cameras):
        xyz = positions(list(posed.values()), seen)
        tried = [
            resected(every, seen.xy[c], xyz)
            for c, every in enumerate(cameras)
            if every[0].name not in posed
        ]
        count, shown, camera = max(tried, key=lambda one: one[0])
        share = count / max(shown, 1)
        if count < max(FEWEST_FRAMES, LEAST_AGREEING * shown):
            remedy = mend(count, shown)
            fault = (
                f"camera {camera.name}: expected {FEWEST_FRAMES} markers or more, and "
                f"{100 * LEAST_AGREEING:.0f} %, to agree with the other cameras, found {count} of "
                f"{shown}; {remedy}"
            )
            accused = camera.name if remedy == CHECK else ""
            # Worse than any start with all cameras.
            return Placed(posed, share - 1, first.spread, fault, accused)
        posed[camera.name], least = camera, min(least, share)
    return Placed(posed, least, first.spread)


def mend(agreeing: int, shown: int) -> str:
    """Return what to do about a camera of whose markers `shown` to others too few agree."""
    return SELDOM if LEAST_AGREEING * shown <= agreeing < FEWEST_FRAMES else CHECK


def _shared(seen: Seen) -> NDArray:
    """Return the numbers of frames (C, C) in which both cameras see two markers or more."""
    each = (np.isfinite(seen.xy[..., 0]).sum(axis=2) >= 2).astype(int)
    return each @ each.T


def _check(seen: Seen, shared: NDArray) -> None:
    """Raise an `InputError` if a group of cameras has too few frames in common with the others."""
    names = seen.cameras
    _, group = scipy.sparse.csgraph.connected_components(shared >= FEWEST_FRAMES, directed=False)
    inside, outside = np.flatnonzero(group == group[0]), np.flatnonzero(group != group[0])
    if len(outside):
        most = shared[np.ix_(inside, outside)].max()
        raise InputError(
            f"wand: cameras {', '.join(names[c] for c in inside)} and "
            f"{', '.join(names[c] for c in outside)}: expected {FEWEST_FRAMES} frames or more in "
            f"which a camera of each group sees two markers, found {most}; {HOW}"
        )


def candidates(name: str, size: tuple[int, int], lenses: Mapping[str, Camera]) -> list[Camera]:
    """Return a camera at the origin with its known lens, or one for each focal length to try."""
    if name in lenses:
        return [replace(lenses[name], cam_from_world=np.eye(3, 4))]
    return [camera_models.plain(name, size, share) for share in FOCAL_SHARES]


def _tolerance(camera: Camera) -> float:
    """Return the tolerance of markers on the z = 1 plane."""
    return TOLERANCE * max(camera.size) / float(camera.K[1, 1])


def _first(wand: Wand, seen: Seen, cameras: Sequence[Sequence[Camera]]) -> list[_Pair]:
    """Return pairs of cameras to start from, the one with the most constant length first.

    There are none if the markers of no pair agree. Raises `InputError` if all are too close.
    """
    shared = _shared(seen)
    every = sorted(combinations(range(len(cameras)), 2), key=lambda two: -shared[two])
    found: list[_Pair] = []
    for two in every[:PAIRS]:
        of_pair = [
            one
            for lenses in product(*(cameras[c][::COARSE] for c in two))
            if (one := _related(wand, seen.xy[list(two)], lenses)) is not None
        ]
        most = max((one.agreeing for one in of_pair), default=0)
        found += [one for one in of_pair if one.agreeing >= 0.9 * most]
    wide = [one for one in found if one.sine >= LEAST_SINE]
    if found and not wide:
        widest = np.degrees(np.arcsin(max(one.sine for one in found)))
        raise InputError(_no_pair(f"{widest:.1f} at most"))
    return sorted(wide, key=lambda one: one.spread)[:STARTS]


def _no_pair(found: str) -> str:
    return (
        f"wand: expected two cameras whose rays to a marker meet at "
        f"{np.degrees(np.arcsin(LEAST_SINE)):.0f} degrees or more, found {found}; check that the "
        f"videos are synchronised and none is mirrored, and {HOW}"
    )


def _related(wand: Wand, xy: NDArray, lenses: Sequence[Camera]) -> _Pair | None:
    """Return two cameras from the essential matrix of their markers (2, F, M, 2), or None."""
    rays = np.stack([undistort(camera, one) for camera, one in zip(lenses, xy, strict=True)])
    at = np.argwhere(np.isfinite(rays).all(axis=(0, 3)))
    at = at[np.linspace(0, len(at) - 1, min(len(at), SAMPLE)).astype(int)]
    one, other = (each[tuple(at.T)] for each in rays)
    if len(at) < FEWEST_FRAMES:
        return None
    limit = float(np.mean([_tolerance(camera) for camera in lenses]))
    estimated = robust_poses.essential(one, other, limit)
    if estimated is None or estimated[1].sum() < LEAST_SHARE * len(at):
        return None
    matrix, inside = estimated
    pose, in_front = robust_poses.relative(matrix, one[inside], other[inside])
    if in_front < LEAST_SHARE:
        return None
    pair = lenses[0], replace(lenses[1], cam_from_world=pose)
    lengths = _lengths(triangulated(pair, xy[:, :: max(1, xy.shape[1] // SAMPLE)]))
    if len(lengths) < FEWEST_FRAMES // 2:
        return None
    typical = float(np.median(lengths))
    scale = wand.length_m / typical
    pose[:, 3] *= scale
    return _Pair(
        (lenses[0], replace(lenses[1], cam_from_world=pose)),
        int(inside.sum()),
        float(np.median(epipolar.ray_sines(pose[:, :3], one[inside], other[inside]))),
        float(np.median(np.abs(lengths - typical))) / typical,
    )


def triangulated(cameras: Sequence[Camera], xy: NDArray) -> NDArray:
    """Return markers (F, M, 3) from views (C, F, M, 2) that agree; NaN for others."""
    return robust(cameras, xy)[0].xyz.reshape(*xy.shape[1:3], 3)


def robust(cameras: Sequence[Camera], xy: NDArray) -> tuple[Triangulated, float]:
    """Return F M markers from views (C, F, M, 2) that agree, and the limit of their errors, px."""
    flat = xy.reshape(len(xy), -1, 2)
    limit = TOLERANCE * max(max(camera.size) for camera in cameras)
    score = np.isfinite(flat[..., 0]).astype(float)
    with np.errstate(divide="ignore", invalid="ignore"):  # markers that only one camera sees
        return triangulate_robust(cameras, flat, score, max_error_px=limit), limit


def _lengths(xyz: NDArray) -> NDArray:
    """Return the distances of the first marker from the last, where both are known."""
    apart = np.linalg.norm(xyz[:, -1] - xyz[:, 0], axis=1)
    return apart[np.isfinite(apart)]


def positions(cameras: Sequence[Camera], seen: Seen) -> NDArray:
    """Return the markers (F, M, 3) triangulated with some of the cameras."""
    at = [seen.cameras.index(camera.name) for camera in cameras]
    return triangulated(cameras, seen.xy[at])


def resected(every: Sequence[Camera], xy: NDArray, xyz: NDArray) -> tuple[int, int, Camera]:
    """Return the number of markers (F, M, 3) that agree, the number tried, and the posed camera.

    `every` are its `candidates`, `xy` (F, M, 2) its markers.
    """
    at = np.argwhere(np.isfinite(xyz).all(axis=-1) & np.isfinite(xy[..., 0]))
    at = at[np.linspace(0, len(at) - 1, min(len(at), SAMPLE)).astype(int)]
    best = 0, len(at), every[0]
    if len(at) < 6:
        return best
    place, px = xyz[tuple(at.T)], xy[tuple(at.T)]
    for camera in every:
        rays, limit = undistort(camera, px), _tolerance(camera)
        found = robust_poses.resected(place, rays, limit, LEAST_SHARE)
        if found and found[0] > best[0]:
            best = found[0], len(at), replace(camera, cam_from_world=found[1])
    return best
