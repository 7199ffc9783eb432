"""Recovery of lost cameras: their poses are computed from people, who are then associated again."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.calibration.people import resection
from courtside.calibration.people.views import Limits, Seen, placed
from courtside.geometry.camera import Camera
from courtside.reconstruction import common_views, resampling
from courtside.reconstruction.association import everybody
from courtside.records.cameras.footage import Footage
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.skeleton import Skeleton
from courtside.study.errors import InputError


@dataclass(frozen=True, eq=False)
class Recovered:
    """Keypoints of people in each take, with recovered cameras."""

    parts: dict[str, Seen]
    cameras: list[Camera] | None  # None where none was lost, or found again
    which: list[int]
    lines: list[str]  # of cameras that are lost in some takes: these are not found again


def recover(
    cameras: Sequence[Camera],
    takes: Mapping[str, Sequence[Footage]],
    limits: Limits,
    joints: Skeleton,
    court: Court | None,
    offsets: pd.DataFrame | None = None,
) -> Recovered:
    """Recover cameras that agree with nobody in any take, and associate people with them.

    The keypoints returned are without the network's `offsets`, where it has some.
    """
    names = [camera.name for camera in cameras]
    parts = {take: common_views.of_footage(names, seen, offsets) for take, seen in takes.items()}
    which, lines = _lost(cameras, takes, parts, limits)
    found = found_again(cameras, which, takes, parts, limits)
    lines = [] if which else lines  # a wrong camera disturbs the others, too
    lines += [
        f"camera {names[at]}: expected people in its pictures where the others see them, found "
        "almost none, and people do not determine its pose: check its calibration"
        for at in which
        if found[at] is cameras[at]
        and any(_expected(cameras, at, part, limits) for part in parts.values())
    ]
    which = [at for at in which if found[at] is not cameras[at]]
    if not which:
        return Recovered(parts, None, [], lines)
    for take, seen in takes.items():
        try:
            again = associated(found, seen, joints, court)
        except InputError:  # nobody is placed: told where all takes are checked together
            continue
        parts[take] = common_views.of_footage(names, again, offsets)
    return Recovered(parts, found, which, lines)


def _lost(
    cameras: Sequence[Camera],
    takes: Mapping[str, Sequence[Footage]],
    parts: Mapping[str, Seen],
    limits: Limits,
) -> tuple[list[int], list[str]]:
    """Return the cameras lost in all takes, and log lines on those lost in some takes."""
    filming = {take: {one.camera.name for one in seen} for take, seen in takes.items()}
    lost = {take: resection.lost(cameras, part, limits) for take, part in parts.items()}
    which, lines = [], []
    for at, camera in enumerate(cameras):
        of = [take for take in takes if camera.name in filming[take]]
        gone = [take for take in of if at in lost[take]]
        if gone and len(gone) == len(of):
            which.append(at)
        elif gone := [
            take for take in gone if _moved(cameras, at, takes[take], parts[take], limits)
        ]:
            others = ", ".join(take for take in of if at not in lost[take])
            lines.append(
                f"camera {camera.name}: expected people where the other cameras see them, found "
                f"next to none in {', '.join(gone)}, others in {others}: was it moved? Put those "
                "takes in a session with a calibration of its own"
            )
    return which, lines


def _moved(
    cameras: Sequence[Camera], at: int, seen: Sequence[Footage], part: Seen, limits: Limits
) -> bool:
    """Say whether a camera may have moved before a take in which it agrees with no other.

    It sees joints, and the other cameras' people are expected in its picture, or are there with
    another pose. Otherwise people may stay out of its picture, and its joints are of spectators.
    """
    views = [one.tracklets.score for one in seen if one.camera.name == cameras[at].name]
    sure = sum(int((np.nan_to_num(score) >= limits.score).sum()) for score in views)
    if sure < resection.FEWEST:
        return False
    return _expected(cameras, at, part, limits) or bool(_of_take(cameras, at, seen, part, limits))


def _expected(cameras: Sequence[Camera], at: int, part: Seen, limits: Limits) -> bool:
    """Say whether a camera should see the people whom the others place."""
    return resection.expected(cameras[at], _by_others(cameras, at, part, limits))


def found_again(
    cameras: Sequence[Camera],
    which: Sequence[int],
    takes: Mapping[str, Sequence[Footage]],
    parts: Mapping[str, Seen],
    limits: Limits,
) -> list[Camera]:
    """Return the cameras, lost ones with poses computed from people, the others unchanged.

    `parts` are the keypoints of the people in each take, associated by the other cameras.
    """
    found = list(cameras)
    for at in which:
        tried = [_of_take(cameras, at, seen, parts[take], limits) for take, seen in takes.items()]
        known = [one for one in tried if one]
        if known:
            found[at] = max(known, key=lambda one: one[1])[0]
    return found


def _of_take(cameras, at: int, seen: Sequence[Footage], part: Seen, limits: Limits):
    """Return the camera from one take's people and the number of agreeing joints, or None."""
    views = [one for one in seen if one.camera.name == cameras[at].name]
    if not views:
        return None
    xyz = _by_others(cameras, at, part, limits)
    people, time_s = np.unique(part.track), np.unique(part.time_s)
    tracklets = views[0].tracklets
    joints = [list(tracklets.joints).index(name) for name in skeleton.JOINTS]
    xy, score = resampling.resample(tracklets, time_s, views[0].clock)
    xy = np.where((np.nan_to_num(score) >= limits.score)[..., None], xy, np.nan)[:, :, joints]
    persons = xyz.reshape(len(people), len(time_s), len(joints), 3)
    return resection.find(cameras[at], persons, xy, limits)


def _by_others(cameras: Sequence[Camera], at: int, part: Seen, limits: Limits) -> NDArray:
    """Return the joints (N, 3) m that the other cameras place."""
    without = part.xy.copy()
    without[at] = np.nan
    return placed(cameras, replace(part, xy=without), limits.times(resection.WIDENED)).xyz


def associated(
    cameras: Sequence[Camera], seen: Sequence[Footage], joints: Skeleton, court: Court | None
) -> list[Footage]:
    """Return the footage of a take by these cameras, people associated again."""
    known = {camera.name: camera for camera in cameras}
    other = [replace(one, camera=known[one.camera.name], people=None) for one in seen]
    people, _ = everybody.find(other, joints, court)
    return [replace(one, people=people) for one in other]
