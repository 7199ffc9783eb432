"""Calibration of cameras with a wand: initial cameras, adjustment, world frame, checks."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.calibration import vertical
from courtside.calibration.bundle import conversion, problem, selection
from courtside.calibration.bundle.problem import FLEX, IMAGE, LENS
from courtside.calibration.court import points_alone
from courtside.calibration.people import world_frame
from courtside.calibration.people.adjustment import Clicks
from courtside.calibration.records import covariance as camera_covariance
from courtside.calibration.records.covariance import CameraCovariance
from courtside.calibration.wand import adjustment, culprit, floor_errors, start, timing, world
from courtside.calibration.wand.adjustment import Adjusted, Bodies, State
from courtside.calibration.wand.points import Seen, Wand
from courtside.geometry import rotations, similarity
from courtside.geometry.camera import Camera, project, undistort
from courtside.study.errors import InputError

MOST_FRAMES = 1000  # in the adjustment; neighbouring frames add little
MOST_PLACES = 200  # markers that define the world frame of the covariance
FAR_SHARE = 0.0025  # ASSUME: of a picture's longer side: markers with larger residuals are wrong
LEAST_NEAR = 0.7  # ASSUME: share of markers with smaller residuals
LEAST_PATH = 0.5  # ASSUME: path of a wand over its length, both in a picture
# ASSUME: least extents of the path along its second and third axes, relative to the first.
LEAST_EXTENTS = {"on a line": 0.1, "in a plane": 0.03}
# ASSUME: of a lens from ten good chessboards, standard deviations: share of the focal length and
# of the longer side, k1. In simulation (0.15 px) focal lengths are 0.21 % wrong, and with these
# numbers errors of joints and cameras are as large as stated (1.50 and 11.5 mm; 1.47 and 12.8 mm).
BOARD_SIGMA = {"f_px": 0.002, "cx_px": 0.001, "cy_px": 0.001, "k1": 0.01}
MIDDLE_SHARE, MIDDLE_SIGMAS = 0.01, 5.0  # ASSUME: error of the middle marker, over the length


@dataclass(frozen=True, eq=False)
class Found:
    """The result of a calibration with a wand."""

    cameras: list[Camera]
    covariance: CameraCovariance
    world: str  # description of the world frame
    stated: bool  # whether floor or points define it
    vertical_deg: float | None  # standard deviation of its z; None with clicked points
    xyz: NDArray  # (F, M, 3) m: markers whose views agree, others NaN
    error_px: NDArray  # (C, F, M, 2): projected minus measured; NaN where either is missing
    adjusted: Adjusted


# In a world frame: cameras, markers (F, M, 3) m, the covariance of the cameras, and the standard
# deviation of the vertical, degrees.
Placed = tuple[list[Camera], NDArray, CameraCovariance, float]


@dataclass(frozen=True, eq=False)
class Floor:
    """Frames or times at which the wand lies on the floor, and the height of the markers then."""

    frames: tuple[float, ...]
    above_m: float = 0.0

    @classmethod
    def of(cls, given: Mapping[str, Any]) -> "Floor | None":
        """Build it from `wand` of a session; None without the key `floor`."""
        if "floor" not in given:
            return None
        frames = tuple(float(frame) for frame in given["floor"])
        return cls(frames, float(given.get("above_floor_m", 0.0)))


def calibrate(
    wand: Wand,
    seen: Seen,
    sizes: Mapping[str, tuple[int, int]],
    *,
    lenses: Mapping[str, Camera],
    floor: Floor | None = None,
    clicks: Callable[[Sequence[Camera]], Clicks] | None = None,
    of_boards: Collection[str] = (),
) -> Found:
    """Calibrate cameras with a wand.

    `sizes` are those of the pictures by camera, px. Known `lenses` are kept, others are estimated.
    Those of the cameras `of_boards` have the errors of chessboards, other known ones are exact.
    `clicks` takes cameras and returns clicked points at known positions; they are adjusted together
    with the wand and define the world frame. Without clicks, the frames of `floor` define it.
    Raises `InputError` if the wand does not determine the cameras.
    """
    _check_path(seen)
    try:
        cameras, found = _agreeing(wand, seen, sizes, lenses)
    except start.Disagreement as fault:
        raise culprit.named(fault, wand, seen, sizes, lenses) from None
    if clicks is not None:
        cameras, found = _clicked(wand, seen, cameras, lenses, clicks)
    xyz = start.triangulated(cameras, seen.xy)
    covariance = _with_boards(found, cameras, lenses, of_boards)
    if clicks is not None:
        text, vertical_deg = "clicked points", None
        named = camera_covariance.of_network(seen.cameras, covariance)
    elif floor is None:
        text = "the cameras' own"
        cameras, xyz, named, vertical_deg = _of_cameras(xyz, cameras, covariance)
    else:
        text, placed = world.FLOOR, _of_floor(seen, xyz, cameras, covariance, floor, found.sigma_px)
        cameras, xyz, named, vertical_deg = placed
    error_px = np.stack([project(camera, xyz) for camera in cameras]) - seen.xy
    stated = clicks is not None or floor is not None
    return Found(cameras, named, text, stated, vertical_deg, xyz, error_px, found)


def _agreeing(
    wand: Wand, seen: Seen, sizes: Mapping[str, tuple[int, int]], lenses: Mapping[str, Camera]
) -> tuple[list[Camera], Adjusted]:
    """Return cameras from the wand alone; raise `start.Disagreement` where they do not agree."""
    cameras = start.guess(wand, seen, sizes, lenses)
    _check_middle(wand, start.triangulated(cameras, seen.xy))
    for _ in range(2):  # the second time with all frames that the first cameras agree on
        state = _state(wand, seen, cameras, lenses)
        found = _adjust(state, cameras, lenses)
        cameras = _cameras(found, cameras, lenses)
    xyz = start.triangulated(cameras, seen.xy)
    _check_extent(xyz)
    _check_sync(seen, cameras, xyz)
    return cameras, found


def _clicked(
    wand: Wand,
    seen: Seen,
    cameras: Sequence[Camera],
    lenses: Mapping[str, Camera],
    clicks: Callable[[Sequence[Camera]], Clicks],
) -> tuple[list[Camera], Adjusted]:
    """Return cameras from the wand and clicked points together, in the frame of these."""
    marked = clicks(cameras)
    moved = world.of_clicks(cameras, marked.xyz, marked.xy)
    cameras = [moved.camera(camera) for camera in cameras]
    marked = clicks(cameras)  # their variances depend on where the cameras are
    state = _with_clicks(_state(wand, seen, cameras, lenses), cameras, lenses, marked)
    found = _adjust(state, cameras, lenses)
    return _cameras(found, cameras, lenses), found


def _of_cameras(xyz: NDArray, cameras: Sequence[Camera], covariance: NDArray) -> Placed:
    """Return what is `Placed` in the cameras' own world frame."""
    moved = world.of_cameras(xyz, cameras)
    places = xyz.reshape(-1, 3)
    places = places[np.isfinite(places).all(axis=1)]
    at = np.linspace(0, len(places) - 1, min(len(places), MOST_PLACES)).astype(int)
    cameras = [moved.camera(camera) for camera in cameras]
    covariance = world_frame.of_shape(cameras, covariance, moved.points(places[at]), None)
    frame = vertical.error_of_pictures(cameras)
    named = camera_covariance.of_network([one.name for one in cameras], covariance, frame)
    return cameras, moved.points(xyz), named, vertical.sigma_deg(frame)


def _of_floor(
    seen: Seen,
    xyz: NDArray,
    cameras: Sequence[Camera],
    covariance: NDArray,
    floor: Floor,
    sigma_px: float,
) -> Placed:
    """Return what is `Placed` in the world frame of a floor."""
    filled = seen.frames[np.isfinite(seen.xy[..., 0]).any(axis=(0, 2))]
    missing = [frame for frame in floor.frames if frame not in filled]
    if missing:
        raise InputError(
            f"wand.floor: expected frames of the wand's file, or times at which a camera sees it, "
            f"found {missing[0]:g}; list frames in which the wand lies on the floor"
        )
    lying = [int(np.flatnonzero(seen.frames == frame)[0]) for frame in floor.frames]
    moved = world.of_floor(xyz[lying], floor.above_m, cameras)
    cameras, xy = [moved.camera(camera) for camera in cameras], seen.xy[:, lying]
    covariance, frame = floor_errors.covariances(cameras, covariance, xy, floor.above_m, sigma_px)
    named = camera_covariance.of_network(seen.cameras, covariance)
    return cameras, moved.points(xyz), named, vertical.sigma_deg(frame)


def _check_path(seen: Seen) -> None:
    """Raise an `InputError` if the wand hardly moves in every picture."""
    longest = 0.0
    for xy in seen.xy:
        both = xy[np.isfinite(xy[..., 0]).all(axis=1)]
        if len(both) < 2:
            continue
        own = np.median(np.linalg.norm(both[:, -1] - both[:, 0], axis=1))
        low, high = np.quantile(both.mean(axis=1), [0.05, 0.95], axis=0)
        longest = max(longest, float(np.linalg.norm(high - low) / max(float(own), 1.0)))
    if longest < LEAST_PATH:
        raise InputError(
            f"wand: expected a path of {LEAST_PATH:g} times its length or more in a picture, found "
            f"{longest:.2f} times; {start.HOW}"
        )


def _check_extent(xyz: NDArray) -> None:
    """Raise an `InputError` if all positions of markers (F, M, 3) are on a line or in a plane."""
    places = xyz.reshape(-1, 3)
    extents = similarity.flatness(places[np.isfinite(places).all(axis=1)])[1:]
    for extent, (what, least) in zip(extents, LEAST_EXTENTS.items(), strict=True):
        if extent < least:
            raise InputError(
                f"wand: expected movement in all directions, found positions {what}: their extent "
                f"across it is {100 * extent:.1f} % of their length; {start.HOW}"
            )


def _check_middle(wand: Wand, xyz: NDArray) -> None:
    """Raise an `InputError` if the middle one of three markers (F, 3, 3) is not where stated."""
    stated, found, sigma = middle_share(wand, xyz)
    if abs(found - stated) > max(MIDDLE_SHARE, MIDDLE_SIGMAS * sigma):
        raise InputError(
            f"wand: expected the middle marker at {100 * stated:.1f} % of the length from the "
            f"first, found it at {100 * found:.1f} %; correct the order of `markers`, or `middle_m`"
        )


def middle_share(wand: Wand, xyz: NDArray) -> tuple[float, float, float]:
    """Return the middle marker's share of the length as stated and as found, and its sigma.

    It does not depend on the scale of the cameras. NaN of two markers, and where (F, 3, 3) lack it.
    """
    if len(wand.along_m) < 3:
        return np.nan, np.nan, np.nan
    to_middle, whole = (xyz[:, k] - xyz[:, 0] for k in (1, 2))
    share = (to_middle * whole).sum(axis=1) / (whole**2).sum(axis=1)
    share = share[np.isfinite(share)]
    if not len(share):
        return np.nan, np.nan, np.nan
    found = float(np.median(share))
    spread = float(np.median(np.abs(share - found)))
    sigma = timing.MEDIAN_SIGMA * spread / np.sqrt(len(share))
    return float(wand.along_m[1]) / wand.length_m, found, sigma


def _check_sync(seen: Seen, cameras: Sequence[Camera], xyz: NDArray) -> None:
    """Raise `start.Disagreement` if the views of a frame do not show one position of the wand."""
    near = []
    for camera, xy in zip(cameras, seen.xy, strict=True):
        off = np.linalg.norm(project(camera, xyz) - xy, axis=-1)
        shown = np.isfinite(xy[..., 0]) & (np.isfinite(seen.xy[..., 0]).sum(axis=0) > 1)
        near.append(float((off[shown] < FAR_SHARE * max(camera.size)).mean()))
    worst = int(np.argmin(near))
    if near[worst] < LEAST_NEAR:
        frames = timing.delays(cameras, seen, xyz)[0][worst]
        raise start.Disagreement(
            f"camera {cameras[worst].name}: expected most markers within "
            f"{FAR_SHARE * max(cameras[worst].size):.1f} px of their positions by all cameras, "
            f"found {100 * near[worst]:.0f} % of them (apparent delay {frames:+.1f} frames); check "
            "that the videos are synchronised, and that no markers are exchanged",
            cameras[worst].name,
        )


def _straight(cameras, lenses: Mapping[str, Camera], xy: NDArray) -> NDArray:
    """Return px (C, ...), without distortion for cameras with known lenses."""
    straight = []
    for camera, px in zip(cameras, xy, strict=True):
        if lens := lenses.get(camera.name):
            px = undistort(lens, px) * np.diag(lens.K)[:2] + lens.K[:2, 2]
        straight.append(px)
    return np.stack(straight)


def _state(
    wand: Wand, seen: Seen, cameras: Sequence[Camera], lenses: Mapping[str, Camera]
) -> State:
    """Return cameras, and a body for each frame with a marker on which views agree."""
    xyz = start.triangulated(cameras, seen.xy)
    frames = np.flatnonzero(np.isfinite(xyz[..., 0]).any(axis=1))
    if len(frames) < start.FEWEST_FRAMES:
        raise start.Disagreement(
            f"wand: expected {start.FEWEST_FRAMES} frames or more in which cameras agree on the "
            f"position of a marker, found {len(frames)}; check that the videos are synchronised, "
            f"and {start.HOW}"
        )
    frames = frames[np.linspace(0, len(frames) - 1, min(len(frames), MOST_FRAMES)).astype(int)]
    xyz = xyz[frames]
    known = np.isfinite(xyz[..., 0])
    xy = _straight(cameras, lenses, seen.xy[:, frames][:, known])
    image, point = np.nonzero(np.isfinite(xy[..., 0]))
    network = conversion.network_of(_without(cameras, lenses))
    network = problem.with_points(network, xyz[known], image, point, xy[image, point])
    sizes, spread = [camera.size for camera in cameras], points_alone.SPREAD
    network = selection.with_lens_priors(network, sizes, spread, points_alone.CENTRE_SHARE)
    sigma = wand.sigma_m / wand.length_m
    state = State(network, _bodies(wand, xyz), 0.0, sigma).placed()
    return _in_front(state)


def _bodies(wand: Wand, xyz: NDArray) -> Bodies:
    """Return a body for each frame of markers (F, M, 3), NaN where unknown; one or more is known.

    The origin is the mean of the known markers.
    """
    known = np.isfinite(xyz[..., 0])
    each, count = np.arange(len(xyz)), known.sum(axis=1)
    first, last = known.argmax(axis=1), known.shape[1] - 1 - known[:, ::-1].argmax(axis=1)
    along = xyz[each, last] - xyz[each, first]
    along[count == 1] = [1.0, 0.0, 0.0]
    origin_m = known @ wand.along_m / count
    frame, marker = np.nonzero(known)
    return Bodies(
        origin=np.nansum(xyz, axis=1) / count[:, None],
        direction=rotations.unit(along),
        known=np.zeros((len(xyz), 3)),
        sigma_m=np.full(len(xyz), np.inf),
        body=frame,
        along_m=wand.along_m[marker] - origin_m[frame],
        block=(adjustment.BLOCKS * each) // len(xyz),
    )


def _without(cameras, lenses) -> list[Camera]:
    """Return the cameras; those with known lenses without distortion."""
    return [
        replace(camera, dist=np.zeros(5)) if camera.name in lenses else camera for camera in cameras
    ]


def _in_front(state: State) -> State:
    """Return a state without views whose point is behind the camera."""
    keep = np.isfinite(problem.residuals(state.network)).all(axis=1)
    part = {name: getattr(state.network, name)[keep] for name in problem.PER_VIEW}
    return replace(state, network=replace(state.network, **part))


def _with_clicks(state: State, cameras, lenses, clicks: Clicks) -> State:
    """Return a state with clicked points as additional bodies, with their own sigma and loss."""
    bodies, network = state.bodies, state.network
    xy, alone_px = _straight(cameras, lenses, clicks.xy), clicks.alone_px()
    both = selection.add_control_points(
        network,
        clicks.xyz,
        clicks.sigma_m,
        dict(enumerate(xy)),
        sigma_px=dict.fromkeys(range(len(cameras)), 1.0),
        loss_scale=clicks.loss_scale * float((clicks.sigma_px / alone_px).mean()),
    )
    sigma_px = np.sqrt((alone_px**2).mean(axis=2))[np.isfinite(xy).all(axis=2)]  # of both axes
    both = replace(both, sigma_px=np.append(network.sigma_px[:, 0], sigma_px))
    xyz, sigma_m = both.xyz[len(network.xyz) :], both.xyz_sigma[len(network.xyz) :]
    first, blocks, number = len(bodies.origin), bodies.block.max() + 1, np.arange(len(xyz))
    bodies = Bodies(
        np.concatenate([bodies.origin, xyz]),
        np.concatenate([bodies.direction, np.tile([1.0, 0.0, 0.0], (len(xyz), 1))]),
        np.concatenate([bodies.known, xyz]),
        np.concatenate([bodies.sigma_m, sigma_m]),
        np.concatenate([bodies.body, first + number]),
        np.concatenate([bodies.along_m, np.zeros(len(xyz))]),
        np.concatenate([bodies.block, blocks + number]),
    )
    return _in_front(replace(state, bodies=bodies, network=both))


def _adjust(state: State, cameras: Sequence[Camera], lenses: Mapping[str, Camera]) -> Adjusted:
    """Adjust poses, lenses that are not known, and bodies."""
    of_point = np.isinf(state.bodies.sigma_m)[state.bodies.body]
    active = _active(state, cameras, lenses)
    return adjustment.adjust(state, active, of_point[state.network.point_idx])


def _active(state: State, cameras: Sequence[Camera], lenses: Mapping[str, Camera]) -> NDArray:
    """Return the columns (K,) of the network that are adjusted, bool."""
    active = np.zeros(state.network.n_columns, dtype=bool)
    first = IMAGE * len(cameras)
    for c, camera in enumerate(cameras):
        active[IMAGE * c : IMAGE * (c + 1) - len(FLEX)] = True
        active[first + len(LENS) * c + np.arange(len(LENS))] = camera.name not in lenses
    return active


def _with_boards(
    found: Adjusted,
    cameras: Sequence[Camera],
    lenses: Mapping[str, Camera],
    of_boards: Collection[str],
) -> NDArray:
    """Return the covariance of all columns with the errors of lenses from chessboards."""
    own = [c for c, camera in enumerate(cameras) if camera.name in of_boards]
    if not own:
        return found.covariance
    sigma = np.zeros(found.state.network.n_columns)
    for c in own:
        unit = {"f_px": cameras[c].K[1, 1], "k1": 1.0}
        for key, share in BOARD_SIGMA.items():
            at = IMAGE * len(cameras) + len(LENS) * c + LENS.index(key)
            sigma[at] = share * unit.get(key, max(cameras[c].size))
    return adjustment.with_lens_errors(found, _active(found.state, cameras, lenses), sigma)


def _cameras(found: Adjusted, cameras, lenses) -> list[Camera]:
    """Return the adjusted cameras, with their known lenses."""
    names, sizes = [c.name for c in cameras], [c.size for c in cameras]
    solved = conversion.cameras_of(found.state.network, names, sizes)
    return [
        replace(lenses[one.name], cam_from_world=one.cam_from_world) if one.name in lenses else one
        for one in solved
    ]
