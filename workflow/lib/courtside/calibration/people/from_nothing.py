"""Cameras from the people that they film and nothing else: no board, no clicks, no walk.

Focal lengths that are not known are tried, people's joints and all cameras are adjusted together
(`adjustment`), and people's height and feet give the unit and the floor (`world_frame`).
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.calibration import vertical
from courtside.calibration.file_check import residuals
from courtside.calibration.people import (
    adjustment,
    held_out,
    metric_scale,
    prior,
    relative_poses,
    views,
    warnings,
    world_frame,
)
from courtside.calibration.people.held_out import Points, Score
from courtside.calibration.people.relative_poses import Take, Track
from courtside.calibration.people.views import Limits, Seen
from courtside.calibration.records import covariance as camera_covariance
from courtside.calibration.records.covariance import PARAMETERS, CameraCovariance
from courtside.geometry import boxes
from courtside.geometry import camera as camera_models
from courtside.geometry.camera import Camera
from courtside.geometry.triangulation import triangulate_all
from courtside.study.errors import InputError

# ASSUME: focal lengths over the picture's longer side, from wide lenses of phones to short
# telephoto lenses, in steps of a fifth. The adjustment finds values between them.
FOCAL_SHARES = (0.7, 0.84, 1.0, 1.2, 1.45, 1.75)
ANY_FOCAL = 1.2  # for the pairing of tracks, which hardly depends on it
# Standard deviations of the initial cameras, so large that they hardly constrain the shape.
LOOSE = {"rotation_deg": 5.0, "position_m": 1.0}
GUESSED = {"focal_percent": 20.0, "principal_point_percent": 1.0, "k1": 0.05}  # ASSUME
KNOWN = {"focal_percent": 0.5, "principal_point_percent": 0.3, "k1": 0.01}  # of a board's lens
PASSES = 2  # ASSUME: number of adjustments; a third one hardly moves a joint
MOST_ROWS = 480  # frames of all persons together; more frames add little
# To measure a body: its legs and trunk are not seen in every frame.
ROWS_OF_TRACK = 2 * metric_scale.LEAST_FRAMES
MOST_FRAMES = 200  # of one take in the comparison of initial cameras
MOST_PLACES = 200  # joints that define the world frame of the covariance
STILL = 0.15  # ASSUME: a person with a shorter path over the own extent does not move
LEAST_ACCEPTED = 50.0  # ASSUME: percent of a camera's views, for a usable camera


# Takes cameras in metres and all joints that a network sees of people; returns those of limbs,
# without the network's joint offsets where these are known.
Limbs = Callable[[Sequence[Camera], Seen], Seen]


@dataclass(frozen=True, eq=False)
class Guess:
    """Initial cameras, in metres, and the tracks of persons."""

    cameras: list[Camera]
    tracks: list[Track]
    explained: float = 0.0  # how much of what the cameras see agrees: `_explained`


@dataclass(frozen=True, eq=False)
class Found:
    """The result of a calibration from people alone."""

    cameras: list[Camera]
    covariance: CameraCovariance
    score: Score  # on held-out blocks of time
    scale: metric_scale.Scale
    warnings: list[str]  # one line each
    remarks: list[str]  # on the scale, and on lenses that are not known
    places: NDArray  # (N, 3) m: joints that define the world frame of the covariance


def guess(
    names: Sequence[str],
    sizes: Mapping[str, tuple[int, int]],
    lenses: Mapping[str, Camera],
    takes: Sequence[Take],
    heights_m: metric_scale.Heights,
    known: Sequence[metric_scale.KnownLength] = (),
) -> Guess:
    """Return initial cameras from the tracks of people.

    `sizes` are those of the pictures by camera, px; `lenses` are the known ones. `heights_m` are
    those of the persons in each take. Raises `InputError` if people do not determine the cameras.
    """
    _check_ways(takes)
    pairs = relative_poses.pair(_with_lenses(names, sizes, lenses, ANY_FOCAL), takes)
    tried: list[tuple[float, list[Camera], list[Track]]] = []
    fault: InputError | None = None
    for share in FOCAL_SHARES if set(names) - set(lenses) else (ANY_FOCAL,):
        try:
            ways = relative_poses.pose(_with_lenses(names, sizes, lenses, share), takes, pairs)
        except InputError as error:
            fault = error
            continue
        tried += [(_explained(posed, takes, tracks), posed, tracks) for posed, tracks in ways]
    if fault and not tried:
        raise fault
    explained, cameras, tracks = max(tried, key=lambda one: one[0])
    joints = [_placed(cameras, takes, track) for track in tracks]
    bodies = [_body(track, xyz) for track, xyz in zip(tracks, joints, strict=True)]
    scale = metric_scale.find(cameras, bodies, heights_m, known).metres
    cameras = [_scaled(camera, scale) for camera in cameras]
    world = world_frame.floor(scale * np.concatenate(joints), cameras)
    return Guess([world.camera(camera) for camera in cameras], tracks, explained)


def _check_ways(takes: Sequence[Take]) -> None:
    """Raise an `InputError` if nobody moves in the picture of any camera."""
    longest = 0.0
    for xy in (xy for take in takes for xy in take.xy):
        middle = np.ma.median(np.ma.masked_invalid(xy), axis=2).filled(np.nan)
        for track, place in zip(xy, middle, strict=True):
            seen = np.isfinite(place).all(axis=1)
            if not seen.any():
                continue
            box = np.ma.masked_invalid(track[seen])
            extent = np.ma.median((box.max(axis=1) - box.min(axis=1)).max(axis=1))
            low, high = np.quantile(place[seen], [0.05, 0.95], axis=0)
            longest = max(longest, float(np.linalg.norm(high - low) / max(float(extent), 1.0)))
    if longest < STILL:
        raise InputError(
            f"people: expected a person who moves by {STILL} of their own height or more in a "
            f"picture, found {longest:.2f} at most; add takes in which people walk about"
        )


def _with_lenses(names, sizes, lenses: Mapping[str, Camera], share: float) -> list[Camera]:
    """Return cameras at the origin with their known lenses, the others with one focal length."""
    return [lenses.get(name) or camera_models.plain(name, sizes[name], share) for name in names]


def _scaled(camera: Camera, factor: float) -> Camera:
    """Return the camera in a world that is larger by a factor."""
    return replace(camera, cam_from_world=camera.cam_from_world * [1, 1, 1, factor])


def track_xy(takes: Sequence[Take], track: Track) -> NDArray:
    """Return the joints (C, T, J, 2) px of a track, NaN where a camera does not see them."""
    each = zip(takes[track[0]].xy, track[1], strict=True)
    return np.stack([relative_poses.of_rows(xy, rows) for xy, rows in each])


def _some(takes: Sequence[Take], track: Track) -> NDArray:
    """Return the joints (C, T, J, 2) px of a track in some of its take's frames."""
    xy = track_xy(takes, track)
    return xy[:, :: max(1, xy.shape[1] // MOST_FRAMES)]


def _placed(cameras: Sequence[Camera], takes: Sequence[Take], track: Track) -> NDArray:
    """Return the joints (T, J, 3) of a track in some of its take's frames."""
    return triangulate_all(cameras, _some(takes, track))


def _explained(cameras, takes: Sequence[Take], tracks: Sequence[Track]) -> float:
    """Return the redundancy of the tracks' views, weighted by how well they agree.

    A joint in n views has a redundancy of 2 n - 3, with less weight if its views disagree (the
    loss of Geman and McClure). More persons, more views and smaller errors increase the sum.
    """
    total = 0.0
    for track in tracks:
        xy = _some(takes, track)
        flat = xy.reshape(len(cameras), -1, 2)
        off = np.linalg.norm(residuals.Rays(flat).residuals(cameras), axis=2)
        off /= relative_poses.AGREE * np.maximum(boxes.usual_side(xy), 1.0)[:, None]
        views = np.isfinite(off).sum(axis=0)
        square = np.nansum(off**2, axis=0)[views >= 2] / views[views >= 2]
        per_frame = takes[track[0]].xy[0].shape[1] / xy.shape[1]
        total += per_frame * float(((2 * views[views >= 2] - 3) / (1 + square)).sum())
    return total


def _body(track: Track, xyz: NDArray, time_s: NDArray | None = None) -> metric_scale.Body:
    """Return the body of a track's joints (T, J, 3) at times (T,); without times, of frames."""
    seen = np.flatnonzero(np.isfinite(xyz).all(axis=-1).any(axis=-1))
    times = np.arange(len(xyz)) if time_s is None else time_s
    first, last = (float(times[at]) for at in seen[[0, -1]]) if len(seen) else (0.0, 0.0)
    take, rows = track
    tracklets = frozenset((camera, row) for camera, own in enumerate(rows) for row in own)
    return metric_scale.Body(take, metric_scale.length(xyz), len(seen), first, last, tracklets)


def adjust(
    start: Sequence[Camera],
    lenses: Mapping[str, Camera],
    everything: Seen,
    limbs: Limbs,
    tracks: Sequence[Track],
    heights_m: metric_scale.Heights,
    limits: Limits,
    known: Sequence[metric_scale.KnownLength] = (),
    share: metric_scale.Share = metric_scale.SEEN,
) -> Found:
    """Adjust cameras, initially in metres, with the people that they see.

    `everything` are all joints that the network sees, of the `tracks`; `limbs` returns those that
    are used; `share` is the length of leg and trunk by them over the height. Raises `InputError` if
    there are too few people, if they stay in one place, or if a camera disagrees with the others on
    held-out joints.
    """
    cameras = list(start)
    for number in range(PASSES):
        seen = limbs(cameras, everything.thinned(MOST_ROWS))
        if not number:
            views.check(start, seen, limits.score)
        fitted = _refined(cameras, lenses, seen, limits)
        joints = _joints(fitted.cameras, seen, limits)
        shape = world_frame.of_shape(fitted.cameras, fitted.covariance, _places(joints), 0.0)
        bodies = _bodies(fitted.cameras, everything, partial(limbs, cameras), tracks, limits)
        scale = metric_scale.find(fitted.cameras, bodies, heights_m, known, shape, share)
        cameras = [_scaled(camera, scale.metres) for camera in fitted.cameras]
    joints = _joints(cameras, seen, limits)
    clicked = [triangulate_all(cameras, one.xy) for one in known if one.on_floor]
    on_floor = np.array(clicked).reshape(-1, 3)
    world = world_frame.floor(joints, cameras, on_floor)
    score = held_out.score(
        lambda part, _: _refined(cameras, lenses, part, limits).cameras, seen, Points(), limits
    )
    check(cameras, score)
    cameras = [world.camera(camera) for camera in cameras]
    joints, on_floor = world.points(joints), world.points(on_floor)
    apart = world_frame.halves_apart(joints, cameras, seen.blocks(2) % 2 == 1, on_floor)
    found = [*scale.warnings, *warnings.find(cameras, seen, joints, score, limits, apart)]
    places = _places(joints)
    covariance = world_frame.of_shape(cameras, fitted.covariance, places, scale.sigma)
    frame, names = world_frame.frame_error(joints, apart, on_floor), [c.name for c in cameras]
    named = camera_covariance.of_network(names, covariance, frame)
    remarks = [*scale.remarks, *_of_lenses(names, lenses)]
    return Found(cameras, named, score, scale, found, remarks, places)


def _of_lenses(names: Sequence[str], lenses: Mapping[str, Camera]) -> Iterator[str]:
    """Yield what to know where lenses are not known.

    In `hall-markers` (4 s, focal lengths of 0.5 to 1.45 picture widths, k1 of -0.3 to -0.4) joints
    were 21 cm off at a stated 4 cm, and views of held-out joints agreed as well as by right lenses.
    """
    if unknown := [name for name in names if name not in lenses]:
        yield (
            f"lenses of {', '.join(unknown)} are estimated from people; this works for lenses with "
            "little distortion and similar focal lengths; for others errors are larger than "
            "stated: film a chessboard with each camera (`chessboard` in the session's file)"
        )


def summary(found: Found, takes: Sequence[str]) -> dict[str, Any]:
    """Return the quality of cameras as numbers and one `line`."""
    share = 1000 * found.score.typical()
    accepted = dict(
        zip((c.name for c in found.cameras), found.score.accepted_percent(), strict=True)
    )
    lowest = min(accepted, key=accepted.__getitem__)
    return {
        "takes": list(takes),
        "held_out_joints_permille": round(share, 3),
        "accepted_percent": {name: round(float(value), 1) for name, value in accepted.items()},
        "scale_sigma_percent": round(100 * found.scale.sigma, 2),
        "vertical_sigma_deg": vertical.sigma_deg(found.covariance.frame),
        "warnings": list(found.warnings),
        "remarks": list(found.remarks),
        "line": f"people alone: views of held-out joints disagree by {share:.1f} thousandths of "
        f"the height; {accepted[lowest]:.0f} % of the views or more are accepted ({lowest}); the "
        f"standard deviation of all lengths is {100 * found.scale.sigma:.1f} % ({found.scale.by})",
    }


def _refined(cameras, lenses, seen: Seen, limits: Limits) -> adjustment.Refined:
    """Adjust cameras with wide priors, and narrow ones for the lenses of boards."""
    guessed, known = (
        prior.stated(cameras, **LOOSE, **lens).covariance for lens in (GUESSED, KNOWN)
    )
    of_board = np.repeat([camera.name in lenses for camera in cameras], len(PARAMETERS))
    names = [camera.name for camera in cameras]
    about = CameraCovariance(names, np.where(of_board[:, None], known, guessed))
    return adjustment.refine(cameras, seen, prior.knowledge(cameras, about), limits)


def _joints(cameras, seen: Seen, limits: Limits) -> NDArray:
    """Return the joints (T, J, 3) m whose views agree."""
    found = views.placed(cameras, seen, limits)
    return found.xyz.reshape(len(seen.track), -1, 3)


def _places(joints: NDArray) -> NDArray:
    """Return some of the known joints (T, J, 3) as points (N, 3)."""
    places = joints.reshape(-1, 3)
    places = places[np.isfinite(places).all(axis=1)]
    if not len(places):
        raise InputError(
            "people: expected joints on whose places two cameras agree, found none; check that the "
            "videos are of the same take, and the clocks of the cameras"
        )
    return places[np.linspace(0, len(places) - 1, MOST_PLACES).astype(int)]


def _bodies(
    cameras, everything: Seen, limbs: Callable[[Seen], Seen], tracks: Sequence[Track], limits
) -> list[metric_scale.Body]:
    """Return the bodies of tracks, measured in enough frames of each take."""
    take_of = np.array([take for take, _ in tracks])[everything.track]
    found = []
    for take in np.unique(take_of):
        own = everything.of(take_of == take)
        share = MOST_ROWS * len(own.track) // len(everything.track)
        seen = limbs(own.thinned(max(share, ROWS_OF_TRACK * len(np.unique(own.track)))))
        joints = _joints(cameras, seen, limits)
        each = [(track, seen.track == track) for track in np.unique(seen.track)]
        found += [_body(tracks[track], joints[at], seen.time_s[at]) for track, at in each]
    return found


def check(cameras: Sequence[Camera], score: Score) -> None:
    """Raise an `InputError` if a camera disagrees with the others on held-out joints."""
    for camera, share in zip(cameras, score.accepted_percent(), strict=True):
        if not share >= LEAST_ACCEPTED:
            raise InputError(
                f"camera {camera.name}: expected {LEAST_ACCEPTED:.0f} % or more of its views of "
                f"joints to agree with those of the others, found {share:.0f} %; check its clock "
                "and video, or add takes in which it sees more of the people"
            )
