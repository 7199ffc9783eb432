"""Everybody whom the cameras of a take see: its footage -> people."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.geometry import interpolation
from courtside.reconstruction import resampling
from courtside.reconstruction.association import associate, identity, lengths, scale
from courtside.records.cameras.footage import Footage
from courtside.records.keypoints.keypoints import Keypoints2D
from courtside.records.keypoints.people import People
from courtside.records.keypoints.skeleton import Skeleton
from courtside.study.errors import InputError

SURE = 0.5  # ASSUME: score of a joint that a network sees, not guesses


def find(
    seen: Sequence[Footage],
    joints: Skeleton,
    court: Court | None,
    calibration: str | None = None,
    unit: str | None = None,
) -> tuple[People, str]:
    """Associate the tracklets of all cameras of a take; also return what the log says.

    For messages, `calibration` is the name of that by which the cameras were found, and `unit` what
    the session states of its file. Raises `InputError` where cameras share no time, people have not
    the size of people, or nobody can be placed.
    """
    views, clocks = [one.tracklets for one in seen], [one.clock for one in seen]
    names = joints.groups["limbs"]
    chosen = [joints.index(name) for name in names]
    limbs = [replace(v, xy=v.xy[:, :, chosen], score=v.score[:, :, chosen]) for v in views]
    time_s = resampling.common_times(views, clocks)
    _check_common(views, time_s)
    xy = [resampling.resample(v, time_s, c)[0] for v, c in zip(limbs, clocks, strict=True)]
    trunk = [at for at, name in enumerate(names) if name.endswith(("hip", "shoulder"))]
    cameras = [one.camera for one in seen]
    scale.check(cameras, xy, names, calibration, unit)
    try:
        found = associate.associate(
            cameras,
            xy,
            time_s,
            trunk=trunk,
            mirror=[chosen.index(joints.mirror()[joint]) for joint in chosen],
            court=court,
            bones=lengths.bones(names),
            clothing=[_worn(one, time_s) for one in seen],
            strides=_strides(views, time_s),
        )
    except InputError as error:
        apart = scale.apart(cameras, calibration, unit)
        raise InputError(f"{error}{_hidden(limbs)}; {apart}") from None
    index = {
        view.camera: associate.on_frames(rows, time_s, clock.to_reference(view.time_s))
        for view, rows, clock in zip(views, found.index, clocks, strict=True)
    }
    ids = np.array([f"person-{at + 1}" for at in range(len(found.placed))])
    confidence = identity.confidence(found.doubts, len(ids))
    kept = {key: getattr(found, key) for key in ("placed", "time_s", "path", "doubts")}
    return People(views[0].model, ids, index=index, confidence=confidence, **kept), found.line()


def _check_common(views: Sequence[Keypoints2D], time_s: NDArray) -> None:
    """Raise `InputError` if cameras have no common times (T,)."""
    if not len(time_s):
        raise InputError(
            f"{', '.join(view.camera for view in views)}: expected cameras that film at one time, "
            "found none by their clocks; correct `clocks` (t_ref = t_own - offset_s) or `trim_s` "
            "of the take"
        )


def _strides(views: Sequence[Keypoints2D], time_s: NDArray) -> list[int]:
    """Return the common times (T,) per own frame of each camera, 1 at least."""
    step_s = interpolation.frame_step_s(time_s)
    return [max(1, round(interpolation.frame_step_s(view.time_s) / step_s)) for view in views]


def _worn(one: Footage, time_s: NDArray) -> NDArray:
    """Return the colours of clothes in one camera at common times."""
    return one.tracklets.clothing[:, resampling.nearest(one.tracklets, time_s, one.clock)]


def _hidden(limbs: Sequence[Keypoints2D]) -> str:
    """Return what bodies lack where most cameras hardly see their limbs; empty where they do."""
    sure = {}
    for view in limbs:
        shown = np.isfinite(view.xy[..., 0])
        sure[view.camera] = float((view.score[shown] > SURE).mean()) if shown.any() else 0.0
    if np.median(list(sure.values())) >= 0.5:
        return ""
    shares = ", ".join(f"{share:.0%} in {name}" for name, share in sure.items())
    return (
        f"; of the limb joints of the people found, few are seen with certainty ({shares}): they "
        "are hidden, or cut off by the picture's border; film whole bodies"
    )
