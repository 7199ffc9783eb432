"""Relative poses of cameras from the tracks of people alone, without scale.

The correspondence of tracks in different cameras is not known either. Pairs of tracks are tried,
and the essential matrix with most agreeing joints of all tracks is kept (Nistér 2004). The joints
of the best two cameras are triangulated, and the other cameras are resected from them.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.calibration import robust_poses
from courtside.geometry import boxes, epipolar, triangulation
from courtside.geometry.camera import Camera, undistort
from courtside.study.errors import InputError

MOST_ROWS = 4  # tracks of one camera in one take that are paired, the longest
LEAST_OVERLAP = 200  # common joints of two tracks that are paired
SAMPLE = 1500  # joints of an estimate; errors of neighbouring frames are correlated
AGREE = 0.02  # ASSUME: distance of a joint from its epipolar line over the person's extent
LEAST_SHARE = 0.5  # ASSUME: share of agreeing joints of two tracks of one person
RIVAL = 0.9  # ASSUME: share of the best pairing's joints with which another is as good
LEAST_SINE = 0.05  # ASSUME: of the angle between rays (3 degrees), for enough parallax
SWEEPS = 2  # over all cameras: new tracks of one camera add joints for the tracks of others
IN_FRONT = 0.75  # ASSUME: least share of joints in front of a camera

Track = tuple[int, tuple[tuple[int, ...], ...]]  # of one person: take, and the rows of each camera
_Person = tuple[int, set[tuple[int, int]]]  # take, and pairs of a camera and a row of this person
Rays = list[list[NDArray]]  # by take and camera: tracks (R, T, J, 2) on the z = 1 plane


@dataclass(frozen=True, eq=False)
class Take:
    """The tracklets of one take, or their pieces, at common times: R rows, T times, J joints."""

    name: str
    xy: list[NDArray]  # by camera (R, T, J, 2): distorted px, NaN if missing or of low confidence

    def times(self, camera: int, row: int) -> NDArray:
        """Return the times (T,) bool at which a row has a joint."""
        return np.isfinite(self.xy[camera][row, ..., 0]).any(axis=1)

    def longest(self, camera: int, most: int | None = None) -> list[int]:
        """Return the rows of a camera with enough joints, the one with most joints first."""
        seen = np.isfinite(self.xy[camera][..., 0]).sum(axis=(1, 2))
        order = np.argsort(-seen, kind="stable")[:most]
        return [int(row) for row in order if seen[row] >= LEAST_OVERLAP]


@dataclass(frozen=True, eq=False)
class Paired:
    """Two cameras, and pairs of tracks that show the same person."""

    cameras: tuple[int, int]
    rows: list[tuple[int, int, int]]  # take, row of the first camera, row of the second
    agreeing: int  # number of joints
    rival: float  # joints that agree with another pairing of the same tracks, as a share


def pair(cameras: Sequence[Camera], takes: Sequence[Take]) -> list[Paired]:
    """Return the pairs of tracks of each two cameras; lenses may be rough.

    Raises `InputError` if no two cameras share enough joints, or if another pairing of tracks is
    as good.
    """
    rays = _rays(cameras, takes)
    every = combinations(range(len(cameras)), 2)
    found = [one for two in every if (one := _paired(takes, rays, two)) is not None]
    if not found:
        raise InputError(
            f"people: expected {LEAST_OVERLAP} joints or more of one person that two cameras see "
            "at the same time, found fewer that agree for every two cameras; add longer takes, and "
            "check the clocks"
        )
    found.sort(key=lambda one: -one.agreeing)
    if (best := found[0]).rival > RIVAL:
        names = " and ".join(cameras[camera].name for camera in best.cameras)
        raise InputError(
            f"take {takes[best.rows[0][0]].name}: expected one way to pair the tracks of cameras "
            f"{names}, found another with {100 * best.rival:.0f} % as many agreeing joints; add a "
            "take with only one person"
        )
    return found


def pose(
    cameras: Sequence[Camera], takes: Sequence[Take], pairs: Iterable[Paired]
) -> list[tuple[list[Camera], list[Track]]]:
    """Return the poses of all cameras and the tracks of persons by each pair, the best first.

    The lenses of `cameras` are used, not their poses. The world frame is that of one camera, and
    the unit of length is the distance of two. Raises `InputError` if people do not determine the
    poses.
    """
    rays = _rays(cameras, takes)
    related = [one for two in pairs if (one := _related(rays, two)) is not None]
    related.sort(key=lambda one: -one.pair.agreeing * one.sine)
    _check(cameras, related)
    found: list[tuple[list[Camera], list[Track]]] = []
    blind: list[int] = []
    for one in related:
        poses, tracks, lost = _resected(takes, rays, one)
        blind += lost
        if not lost:
            each = zip(cameras, poses, strict=True)
            posed = [replace(camera, cam_from_world=pose) for camera, pose in each]
            found.append((posed, tracks))
    if not found:
        name = cameras[max(blind, key=blind.count)].name
        raise InputError(
            f"camera {name}: expected {LEAST_OVERLAP // 2} joints or more that two other cameras "
            "also see, found fewer that agree; add a take in which somebody walks through the "
            "views of all cameras, and check its clock and that its video is not mirrored"
        )
    return found


def _rays(cameras: Sequence[Camera], takes: Sequence[Take]) -> Rays:
    """Return the tracks of all takes on the z = 1 planes of the cameras."""
    return [
        [undistort(camera, xy) for camera, xy in zip(cameras, take.xy, strict=True)]
        for take in takes
    ]


def _reach(rays: NDArray) -> NDArray:
    """Return the tolerance (R,) of joints of tracks (R, T, J, 2), a share of their extents."""
    return AGREE * boxes.usual_side(rays)


def _thinned(at: NDArray) -> tuple[NDArray, ...]:
    """Return evenly spaced rows of indices (N, 2), as a tuple that indexes arrays."""
    chosen = np.linspace(0, len(at) - 1, min(len(at), SAMPLE)).astype(int)
    return tuple(at[chosen].T)


def _shared(a: NDArray, b: NDArray) -> tuple[NDArray, NDArray]:
    """Return the common joints (N, 2) of two tracks (T, J, 2)."""
    at = _thinned(np.argwhere(np.isfinite(a[..., 0]) & np.isfinite(b[..., 0])))
    return a[at], b[at]


def _agreeing(
    matrix: NDArray, takes: Sequence[Take], rays: Rays, two: tuple[int, int]
) -> tuple[list[tuple[int, int, int]], int]:
    """Return the pairs of tracks that agree with an essential matrix, and the number of joints.

    A track is paired with only one other track at a time.
    """
    tried = []
    for t, take in enumerate(takes):
        a, b = (rays[t][camera] for camera in two)
        limit = _reach(a)[:, None] / 2 + _reach(b) / 2
        for i, j in product(*(take.longest(camera) for camera in two)):
            off = np.abs(epipolar.distance_px(matrix, a[i], b[j]))
            known, near = np.isfinite(off), np.nan_to_num(off, nan=np.inf) <= limit[i, j]
            if known.any() and near.sum() >= LEAST_SHARE * known.sum():
                tried.append((int(near.sum()), (t, i, j), known.any(axis=1)))
    rows: list[tuple[int, int, int]] = []
    total = 0
    used: dict[tuple[int, int, int], Any] = {}
    for count, key, times in sorted(tried, key=lambda one: -one[0]):
        ends = [(key[0], side, row) for side, row in enumerate(key[1:])]
        if not any((used.get(end, False) & times).any() for end in ends):
            rows.append(key)
            total += count
            used |= {end: used.get(end, False) | times for end in ends}
    return rows, total


def _paired(takes: Sequence[Take], rays: Rays, two: tuple[int, int]) -> Paired | None:
    """Return the pairing of the tracks of two cameras with most agreeing joints, or None."""
    found = []
    for t, take in enumerate(takes):
        a, b = (rays[t][camera] for camera in two)
        limit = _reach(a)[:, None] / 2 + _reach(b) / 2
        for i, j in product(*(take.longest(camera, MOST_ROWS) for camera in two)):
            one, other = _shared(a[i], b[j])
            if len(one) < LEAST_OVERLAP:
                continue
            if estimated := robust_poses.essential(one, other, float(limit[i, j])):
                found.append(_agreeing(estimated[0], takes, rays, two))
    found.sort(key=lambda one: -one[1])
    if not found or not found[0][0]:
        return None
    rows, count = found[0]
    rivals = [n for others, n in found if _contradict(takes, two, rows, others)]
    return Paired(two, rows, count, max(rivals, default=0) / count)


def _contradict(takes: Sequence[Take], two: tuple[int, int], rows, others) -> bool:
    """Return whether two pairings give one track different partners at the same time."""
    for (t, *one), (u, *other), side in product(rows, others, (0, 1)):
        if t == u and one[side] == other[side] and one[1 - side] != other[1 - side]:
            partners = takes[t].xy[two[1 - side]][[one[1 - side], other[1 - side]]]
            if np.isfinite(partners[..., 0]).any(axis=2).all(axis=0).any():
                return True
    return False


@dataclass(frozen=True, eq=False)
class _Related:
    """Two cameras with their relative pose."""

    pair: Paired
    pose: NDArray  # (3, 4): from the first camera's axes to the second's; its shift has length 1
    sine: float  # of the angle between rays, median


def _related(rays: Rays, pair: Paired) -> _Related | None:
    """Return the relative pose of two cameras from all their pairs of tracks, or None."""
    a, b = pair.cameras
    both = [_shared(rays[t][a][i], rays[t][b][j]) for t, i, j in pair.rows]
    one, other = (np.concatenate(part) for part in zip(*both, strict=True))
    reach = float(np.median([_reach(rays[t][a])[i] / 2 + _reach(rays[t][b])[j] / 2
                             for t, i, j in pair.rows]))  # fmt: skip
    every = np.linspace(0, len(one) - 1, min(len(one), 2 * SAMPLE)).astype(int)
    estimated = robust_poses.essential(one[every], other[every], reach)
    if estimated is None:
        return None
    matrix, _ = estimated
    near = np.abs(epipolar.distance_px(matrix, one, other)) <= reach
    if not near.any():
        return None
    pose, _ = robust_poses.relative(matrix, one[near], other[near])
    sine = np.median(epipolar.ray_sines(pose[:, :3], one[near], other[near]))
    return _Related(pair, pose, float(sine))


def _check(cameras: Sequence[Camera], posed: list[_Related]) -> None:
    """Raise an `InputError` if no two cameras have enough parallax."""
    widest = max(posed, key=lambda one: one.sine, default=None)
    if widest is None or widest.sine < LEAST_SINE:
        found = np.degrees(np.arcsin(widest.sine)) if widest else 0.0
        raise InputError(
            f"cameras {', '.join(camera.name for camera in cameras)}: expected two whose rays to a "
            f"joint meet at {np.degrees(np.arcsin(LEAST_SINE)):.0f} degrees or more, found "
            f"{found:.1f} at most; place the cameras farther apart"
        )


def of_rows(values: NDArray, rows: Iterable[int]) -> NDArray:
    """Return the values (T, ...) of one person from several rows of `values` (R, T, ...).

    At each time the first row with a value is used; NaN where no row has one.
    """
    found = np.full(values.shape[1:], np.nan)
    for row in rows:
        free = np.isnan(found).reshape(len(found), -1).all(axis=1)
        found[free] = values[row][free]
    return found


def _resected(
    takes: Sequence[Take], rays: Rays, best: _Related
) -> tuple[list[NDArray], list[Track], list[int]]:
    """Return poses (3, 4) in the frame of the first camera of a pair, tracks, and lost cameras."""
    (a, b), n_cameras = best.pair.cameras, len(rays[0])
    poses, lost = {a: np.eye(3, 4), b: best.pose}, list[int]()
    persons = _joined(takes, [(t, {(a, i), (b, j)}) for t, i, j in best.pair.rows])
    points = [_points(rays, poses, person) for person in persons]
    for camera in sorted(set(range(n_cameras)) - {a, b}):
        tried = [
            _posed(xyz, rays[t][camera][row], _reach(rays[t][camera])[row])
            for (t, _), xyz in zip(persons, points, strict=True)
            for row in takes[t].longest(camera, MOST_ROWS)
        ]
        count, pose = max(tried, key=lambda one: one[0], default=(0, None))
        if pose is not None and count >= LEAST_OVERLAP // 2:
            poses[camera] = pose
    for _ in range(SWEEPS):
        for camera in poses:
            persons = _grown(takes, rays, poses, persons, camera)
        persons = _joined(takes, persons)
    for camera in range(n_cameras):
        if not any(camera == own for _, rows in persons for own, _ in rows):
            lost.append(camera)
    tracks = [(t, _by_camera(takes[t], rows, n_cameras)) for t, rows in persons]
    return [poses.get(camera, np.eye(3, 4)) for camera in range(n_cameras)], tracks, lost


def _by_camera(take: Take, rows: set[tuple[int, int]], n_cameras: int):
    """Return the rows of each camera, the one with most joints first."""
    return tuple(
        tuple(row for row in take.longest(camera) if (camera, row) in rows)
        for camera in range(n_cameras)
    )


def _joined(takes: Sequence[Take], persons: Iterable[_Person]) -> list[_Person]:
    """Join persons with a common track, unless a camera would show one of them twice at a time."""
    found: list[_Person] = []
    for take, rows in persons:
        for other in [one for one in found if one[0] == take and one[1] & rows]:
            if not _twice(takes[take], rows | other[1]):
                found.remove(other)
                rows = rows | other[1]
        found.append((take, rows))
    return found


def _twice(take: Take, rows: set[tuple[int, int]]) -> bool:
    """Return whether a camera has joints in two of the rows at the same time."""
    shown: dict[int, Any] = {}
    for camera, row in rows:
        shown[camera] = shown.get(camera, 0) + take.times(camera, row).astype(int)
    return any(count.max() > 1 for count in shown.values())


def _points(rays: Rays, poses: Mapping[int, NDArray], person: _Person) -> NDArray:
    """Return the joints (T, J, 3) of a person, triangulated with the posed cameras."""
    take, rows = person
    each = [of_rows(rays[take][c], sorted(r for own, r in rows if own == c)) for c in poses]
    flat = np.stack(each).reshape(len(poses), -1, 2)
    weight = np.isfinite(flat).all(axis=-1).astype(float)
    xyz = triangulation.triangulate(np.nan_to_num(flat), weight, np.stack(list(poses.values())))
    return xyz.reshape(*each[0].shape[:2], 3)


def _posed(xyz: NDArray, rays: NDArray, reach: float) -> tuple[int, NDArray | None]:
    """Return the number of joints (T, J, 3) that agree with a track (T, J, 2), and the pose."""
    at = np.argwhere(np.isfinite(xyz).all(axis=-1) & np.isfinite(rays[..., 0]))
    if len(at) < LEAST_OVERLAP // 2:
        return 0, None
    reached = robust_poses.resected(
        xyz[_thinned(at)], rays[_thinned(at)], 2 * float(reach), IN_FRONT
    )
    return reached or (0, None)


def _grown(
    takes: Sequence[Take],
    rays: Rays,
    poses: Mapping[int, NDArray],
    persons: Sequence[_Person],
    camera: int,
) -> list[_Person]:
    """Add the tracks of one camera to the persons whose joints by the other cameras they match.

    At any time, a track belongs to one person, and a person has one track of the camera.
    """
    others = {other: pose for other, pose in poses.items() if other != camera}
    tried, taken = list[tuple[int, int, int, Any]](), dict[tuple[int, int], Any]()
    shown = [np.zeros(takes[t].xy[camera].shape[1], dtype=bool) for t, _ in persons]
    for number, (t, rows) in enumerate(persons):
        for _, row in (one for one in rows if one[0] == camera):
            times = takes[t].times(camera, row)
            taken[t, row] = taken.get((t, row), False) | times
            shown[number] |= times
        in_cam = _points(rays, others, (t, rows)) @ poses[camera][:, :3].T + poses[camera][:, 3]
        limit = 3 * _reach(rays[t][camera])
        for row in takes[t].longest(camera):
            off = in_cam[..., :2] / in_cam[..., 2:] - rays[t][camera][row]
            off = np.where(shown[number][:, None], np.nan, np.linalg.norm(off, axis=-1))
            known = np.isfinite(off)
            near = int((known & (np.nan_to_num(off, nan=np.inf) <= limit[row])).sum())
            if known.any() and near >= LEAST_SHARE * known.sum():
                tried.append((near, number, row, known.any(axis=1)))
    found = [(t, set(rows)) for t, rows in persons]
    for _, number, row, times in sorted(tried, key=lambda one: -one[0]):
        key = found[number][0], row
        if not ((taken.get(key, False) | shown[number]) & times).any():
            found[number][1].add((camera, row))
            taken[key], shown[number] = taken.get(key, False) | times, shown[number] | times
    return found
