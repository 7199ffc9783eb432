"""Calibration from people alone: tracks of takes at common times, clocks and cameras in turn."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.calibration.people import from_nothing, metric_scale, relative_poses
from courtside.calibration.people.metric_scale import Heights, KnownLength
from courtside.calibration.people.relative_poses import Take
from courtside.calibration.people.views import Limits, Seen, joined
from courtside.geometry import camera as camera_models
from courtside.geometry.camera import Camera
from courtside.reconstruction import common_views, person_height, resampling
from courtside.reconstruction.association import rows as tracklet_rows
from courtside.records.devices import clocks as camera_clocks
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import skeleton
from courtside.records.keypoints.keypoints import Keypoints2D
from courtside.study.errors import InputError

# A take's name, the keypoints of each camera that films it, and their clocks by camera.
Filmed = tuple[str, Sequence[Keypoints2D], Mapping[str, Clock]]
ROUNDS = 2  # of clocks and cameras: clocks from rough cameras have errors of some milliseconds
SAME_S = 1e-3  # smaller differences of clocks do not matter: a walking person moves 1 mm
MIN_SCORE = 0.5  # ASSUME: of joints for the initial cameras
MOST_TIMES = 3000  # of a take: more of them add little, and take memory


def tracks(
    name: str,
    views: Sequence[Keypoints2D],
    clocks: Mapping[str, Clock],
    cameras: Sequence[str],
    *,
    is_cut: bool,
) -> Take:
    """Return the tracklets of a take at common times; none of a camera that does not film it.

    If `is_cut`, each row is a piece of a tracklet (`rows.separate`).
    """
    time_s = _times(views, clocks)
    xy = {camera: np.zeros((0, len(time_s), len(skeleton.JOINTS), 2)) for camera in cameras}
    for view in views:
        found, score = _resampled(view, time_s, clocks, skeleton.JOINTS, is_cut)
        sure = np.nan_to_num(score) >= MIN_SCORE
        xy[view.camera] = np.where(sure[..., None], found, np.nan)
    return Take(name, list(xy.values()))


def seen(first: from_nothing.Guess, takes: Sequence[Filmed], *, is_cut: bool) -> Seen:
    """Return all keypoints of the persons of the initial tracks, by the initial cameras.

    `is_cut` as for the tracks.
    """
    cameras, joints = first.cameras, _joints(takes)
    limbs = [joints.index(name) for name in skeleton.JOINTS]
    resampled = [_by_camera(cameras, views, clocks, joints, is_cut) for _, views, clocks in takes]
    parts = []
    for take, rows in first.tracks:
        time_s, by_camera = resampled[take]
        xy, score = _of_track(by_camera, rows, len(time_s), len(joints))
        height_px = person_height.in_pictures(
            cameras, xy[:, None][..., limbs, :], score[:, None][..., limbs], skeleton.JOINTS
        )
        track = np.zeros(len(time_s), dtype=int)
        parts.append(Seen(xy, score, height_px[:, 0], track, time_s))
    return joined(parts)


def _joints(takes: Sequence[Filmed]) -> list[str]:
    """Return the joints of the network, which is the same in all takes."""
    return list(takes[0][1][0].joints)


def calibrate(
    names: Sequence[str],
    lenses: Mapping[str, Camera],
    timed: Callable[[Mapping[str, Camera] | None], Sequence[Filmed]],
    heights_m: Heights,
    limits: Limits,
    known: Sequence[KnownLength] = (),
    offsets: pd.DataFrame | None = None,
) -> from_nothing.Found:
    """Return cameras from people alone; arguments are as for `from_nothing.guess` and `adjust`.

    `timed` takes cameras by name, or None, and returns the takes with clocks estimated with them.
    If new cameras change the clocks, the cameras are adjusted again. `offsets` is the table of the
    network's joint offsets (`joint_correction.read`); joints with their offsets bend cameras.
    Raises `InputError` if people do not determine the cameras, or if a clock is uncertain.
    """
    first, is_cut = guess(names, lenses, timed(None), heights_m, known)
    last = list[Filmed]()
    # Keypoints whose offset is not known keep it: rare, where shoulders or hips are not seen.
    share = metric_scale.SEEN if offsets is None else metric_scale.CORRECTED
    for _ in range(ROUNDS):
        takes = timed({camera.name: camera for camera in first.cameras})
        for name, _, clocks in takes:
            if fault := camera_clocks.fault_line(f"take {name}", clocks):
                raise InputError(fault)
        if last and _apart_s(last, takes) < SAME_S:
            break
        limbs = partial(common_views.of_limbs, joints=_joints(takes), offsets=offsets)
        people = seen(first, takes, is_cut=is_cut), limbs, first.tracks, heights_m
        found = from_nothing.adjust(first.cameras, lenses, *people, limits, known, share)
        first, last = replace(first, cameras=found.cameras), list(takes)
    return found


def _of_track(
    by_camera: Sequence[tuple[NDArray, NDArray] | None],
    rows: Sequence[Sequence[int]],
    n_times: int,
    n_joints: int,
) -> tuple[NDArray, NDArray]:
    """Return a track's xy (C, T, J, 2) px and score (C, T, J), NaN where no camera films it."""
    shape = (len(by_camera), n_times, n_joints)
    xy, score = np.full((*shape, 2), np.nan), np.full(shape, np.nan)
    for at, (own, view) in enumerate(zip(rows, by_camera, strict=True)):
        if view is not None:
            xy[at], score[at] = (relative_poses.of_rows(values, own) for values in view)
    return xy, score


def _apart_s(before: Sequence[Filmed], after: Sequence[Filmed]) -> float:
    """Return the largest difference of the clocks of takes, s."""
    return max(
        float(np.abs(old[name].from_reference(ends) - new[name].from_reference(ends)).max())
        for (_, views, old), (_, _, new) in zip(before, after, strict=True)
        for name, ends in ((view.camera, view.time_s[[0, -1]]) for view in views)
    )


def guess(
    names: Sequence[str],
    lenses: Mapping[str, Camera],
    takes: Sequence[Filmed],
    heights_m: Heights,
    known: Sequence[KnownLength] = (),
) -> tuple[from_nothing.Guess, bool]:
    """Return initial cameras, and whether tracklets were cut for them.

    The other arguments are as for `from_nothing.guess`. Trackers exchange people who cross, so
    tracklets are cut there; people who are close most of the time leave too little then. Of
    tracklets cut and whole, those are used by which more of what the cameras see agrees.
    """
    sizes = _sizes(takes)
    if blind := [name for name in names if name not in sizes]:
        raise InputError(
            f"camera {blind[0]}: expected a take with its video, found none; the calibration "
            "`people` needs videos of all cameras: add such takes"
        )
    for name, lens in lenses.items():
        camera_models.check_size(lens, sizes[name], f"keypoints of camera {name}")
    found: list[tuple[from_nothing.Guess, bool]] = []
    fault: InputError | None = None
    for is_cut in (False, True) if _any_cut(takes) else (False,):
        filmed = [
            tracks(name, views, clocks, names, is_cut=is_cut) for name, views, clocks in takes
        ]
        try:
            one = from_nothing.guess(names, sizes, lenses, filmed, heights_m, known)
        except InputError as error:
            fault = fault or error
            continue
        found.append((one, is_cut))
    if fault and not found:
        raise fault
    return max(found, key=lambda one: one[0].explained)


def _any_cut(takes: Sequence[Filmed]) -> bool:
    """Return whether a tracklet of the takes has several pieces."""
    each = (tracklet_rows.separate(view).max(axis=1) for _, views, _ in takes for view in views)
    return any(len(np.unique(rows)) < len(rows) for rows in each)


def _sizes(takes: Sequence[Filmed]) -> dict[str, tuple[int, int]]:
    """Return the size of each camera's pictures, px; an `InputError` if takes have several."""
    found: dict[str, tuple[int, int]] = {}
    for name, views, _ in takes:
        for view in views:
            size = int(view.size[0]), int(view.size[1])
            known = found.setdefault(view.camera, size)
            if size != known:
                raise InputError(
                    f"take {name}: camera {view.camera}: expected pictures of {known[0]} x "
                    f"{known[1]} px, as in the takes before it, found {size[0]} x {size[1]} px; "
                    "name takes filmed in one size in `refine_cameras: takes`"
                )
    return found


def _times(views: Sequence[Keypoints2D], clocks: Mapping[str, Clock]) -> NDArray:
    """Return common times of a take; of a long one, some at which two cameras see somebody."""
    time_s = resampling.common_times(views, [clocks[view.camera] for view in views])
    if len(time_s) <= MOST_TIMES:
        return time_s
    seeing = [
        np.isfinite(view.xy[..., 0]).any(axis=(0, 2))[
            resampling.nearest(view, time_s, clocks[view.camera])
        ]
        for view in views
    ]
    time_s = time_s[np.sum(seeing, axis=0) >= 2]
    return time_s[:: max(1, -(-len(time_s) // MOST_TIMES))]


def _resampled(
    view: Keypoints2D,
    time_s: NDArray,
    clocks: Mapping[str, Clock],
    joints: Sequence[str],
    is_cut: bool,
) -> tuple[NDArray, NDArray]:
    """Return a view's named joints: xy (R, T, J, 2) and score (R, T, J).

    If `is_cut`, each of the R rows is a piece of a tracklet that shows one body.
    """
    clock, at = clocks[view.camera], [list(view.joints).index(name) for name in joints]
    xy, score = (part[:, :, at] for part in resampling.resample(view, time_s, clock))
    if not is_cut:
        return xy, score
    row = tracklet_rows.separate(view)[:, resampling.nearest(view, time_s, clock)]
    missing, times = row < 0, np.arange(len(time_s))
    xy, score = (part[np.maximum(row, 0), times] for part in (xy, score))
    xy[missing], score[missing] = np.nan, np.nan
    return xy, score


def _by_camera(
    cameras: Sequence[Camera], views, clocks, joints: Sequence[str], is_cut: bool
) -> tuple[NDArray, list[tuple[NDArray, NDArray] | None]]:
    time_s, found = _times(views, clocks), {view.camera: view for view in views}
    return time_s, [
        _resampled(found[camera.name], time_s, clocks, joints, is_cut)
        if camera.name in found
        else None
        for camera in cameras
    ]
