"""The limb keypoints of all persons in several takes and all cameras, at common times."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.calibration.people.views import Limits, Seen, joined, placed
from courtside.geometry.camera import Camera
from courtside.reconstruction import joint_correction, person_height, resampling
from courtside.records.cameras import footage
from courtside.records.cameras.footage import Footage
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.errors import StrPath

WIDE = Limits.wide(0.05)  # of views that tell how a body stands


def of_takes(
    cameras_toml: StrPath,
    names: Sequence[str],
    takes: Sequence[Mapping[str, Any]],
    offsets: pd.DataFrame | None = None,
) -> Seen | None:
    """Return the keypoints of all persons in takes, by the cameras `names`; None without takes.

    `takes` have the files `pose2d` (a list), `people` and `sync`, as for `footage.read`. A camera
    that does not film a take sees nobody there.
    """
    parts = [of_take(cameras_toml, names, take, offsets) for take in takes]
    return joined(parts) if parts else None


def of_take(
    cameras_toml: StrPath,
    names: Sequence[str],
    take: Mapping[str, Any],
    offsets: pd.DataFrame | None = None,
) -> Seen:
    """Return the keypoints of one take from the files above, as `of_footage`."""
    filmed = footage.read(cameras_toml, take["pose2d"], take["people"], take["sync"])
    return of_footage(names, filmed, offsets)


def of_footage(
    names: Sequence[str], seen: Sequence[Footage], offsets: pd.DataFrame | None = None
) -> Seen:
    """Return the keypoints of one take, whose people are associated; without a network's offsets.

    `offsets` is the network's table (`joint_correction.read`), where it has one.
    """
    each, clocks = [one.view for one in seen], [one.clock for one in seen]
    time_s, joints = resampling.common_times(each, clocks), list(each[0].joints)
    xy, score = resampling.resample_all(each, clocks, time_s)
    cameras = [one.camera for one in seen]
    limbs = [joints.index(name) for name in skeleton.JOINTS]
    height_px = person_height.in_pictures(
        cameras, xy[..., limbs, :], score[..., limbs], skeleton.JOINTS
    )
    n_people = score.shape[1]
    track, when = np.repeat(np.arange(n_people), len(time_s)), np.tile(time_s, n_people)
    xy, score, height_px = (
        part.reshape(len(seen), len(track), *part.shape[3:]) for part in (xy, score, height_px)
    )
    found = of_limbs(cameras, Seen(xy, score, height_px, track, when), joints, offsets)
    at, offset_px = [names.index(camera.name) for camera in cameras], found.offset_px
    return replace(
        found,
        xy=_by_camera(found.xy, at, len(names), np.nan),
        score=_by_camera(found.score, at, len(names), np.nan),
        height_px=_by_camera(found.height_px, at, len(names), person_height.LEAST_PX),
        offset_px=None if offset_px is None else _by_camera(offset_px, at, len(names), 0.0),
    )


def of_limbs(
    cameras: Sequence[Camera],
    seen: Seen,
    joints: Sequence[str],
    offsets: pd.DataFrame | None = None,
) -> Seen:
    """Return the joints of limbs, of all `joints` that a network sees, without its offsets.

    A network places joints wrongly, by amounts that depend on the body and on the direction of view
    (`joint_correction`); they would bend cameras. Views that contradict the others keep theirs: in
    px of a camera that is far off, an offset means nothing.
    """
    limbs = [list(joints).index(name) for name in skeleton.JOINTS]
    xy = seen.xy[:, :, limbs]
    if offsets is not None:
        for at in _of_each(seen.track):
            some = seen.of(at)
            found = placed(cameras, some, WIDE)
            xyz = found.xyz.reshape(*some.score.shape[1:], 3)
            without = joint_correction.in_pictures(cameras, some.xy, xyz, joints, offsets)
            agrees = found.accepted.reshape(some.score.shape)[..., None]
            xy[:, at] = np.where(agrees, without, some.xy)[:, :, limbs]
    offset_px = None if offsets is None else seen.xy[:, :, limbs] - xy
    return replace(seen, xy=xy, score=seen.score[:, :, limbs], offset_px=offset_px)


def _of_each(track: NDArray) -> Iterator[NDArray]:
    """Yield rows by number, a block of one track's at a time, for the memory."""
    for one in np.unique(track):
        rows = np.flatnonzero(track == one)
        yield from (rows[at] for at in keypoints.blocks(len(rows)))


def _by_camera(values: NDArray, rows: Sequence[int], count: int, fill: float) -> NDArray:
    """Return values (C, N, ...) as (count, N, ...): of cameras `rows`, else `fill`."""
    whole = np.full((count, *values.shape[1:]), fill)
    whole[rows] = values
    return whole
