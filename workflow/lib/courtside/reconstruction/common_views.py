"""The limb keypoints of all persons in several takes and all cameras, at common times."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.people.views import Seen, joined
from courtside.reconstruction import person_height, resampling
from courtside.records.cameras import footage
from courtside.records.cameras.footage import Footage
from courtside.records.keypoints import skeleton
from courtside.study.errors import StrPath


def of_takes(
    cameras_toml: StrPath, names: Sequence[str], takes: Sequence[Mapping[str, Any]]
) -> Seen | None:
    """Return the keypoints of all persons in takes, by the cameras `names`; None without takes.

    `takes` have the files `pose2d` (a list), `people` and `sync`, as for `footage.read`. A camera
    that does not film a take sees nobody there.
    """
    parts = [of_take(cameras_toml, names, take) for take in takes]
    return joined(parts) if parts else None


def of_take(cameras_toml: StrPath, names: Sequence[str], take: Mapping[str, Any]) -> Seen:
    """Return the keypoints of one take from the files above."""
    return of_footage(
        names, footage.read(cameras_toml, take["pose2d"], take["people"], take["sync"])
    )


def of_footage(names: Sequence[str], seen: Sequence[Footage]) -> Seen:
    """Return the keypoints of one take, whose people are associated."""
    each, clocks = [one.view for one in seen], [one.clock for one in seen]
    time_s = resampling.common_times(each, clocks)
    joints = [list(each[0].joints).index(name) for name in skeleton.JOINTS]
    both = resampling.resample_all(each, clocks, time_s)
    xy, score = (part[:, :, :, joints] for part in both)
    cameras = [one.camera for one in seen]
    height_px = person_height.in_pictures(cameras, xy, score, skeleton.JOINTS)
    n_people, n_times = score.shape[1:3]
    rows = [names.index(camera.name) for camera in cameras]
    track, when = np.repeat(np.arange(n_people), n_times), np.tile(time_s, n_people)
    return Seen(
        xy=_by_camera(xy, rows, len(names), np.nan),
        score=_by_camera(score, rows, len(names), np.nan),
        height_px=_by_camera(height_px, rows, len(names), person_height.LEAST_PX),
        track=track,
        time_s=when,
    )


def _by_camera(values: NDArray, rows: Sequence[int], count: int, fill: float) -> NDArray:
    """Return values (C, P, T, ...) as (count, P T, ...): of cameras `rows`, else `fill`."""
    whole = np.full((count, values.shape[1] * values.shape[2], *values.shape[3:]), fill)
    whole[rows] = values.reshape(len(rows), *whole.shape[1:])
    return whole
