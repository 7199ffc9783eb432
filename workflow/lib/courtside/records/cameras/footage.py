"""A take by its cameras: their calibration, keypoints by person, clocks and videos."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import repeat

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import camera as camera_models
from courtside.geometry import interpolation
from courtside.records.devices import clocks
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import keypoints, people
from courtside.records.keypoints.keypoints import Keypoints2D, Keypoints3D
from courtside.records.keypoints.people import People
from courtside.study.errors import InputError, StrPath


@dataclass(frozen=True, eq=False)
class Footage:
    """One camera of a take; `tracklets` are its keypoints as detected, `people` who is who.

    `turns` (T, 3) are rotation vectors, radians, from the camera as calibrated to the camera in
    each frame; None if it stood still.
    """

    camera: camera_models.Camera
    tracklets: Keypoints2D
    clock: Clock
    video: StrPath | None = None
    people: People | None = None
    turns: NDArray | None = None

    @cached_property
    def view(self) -> Keypoints2D:
        """Its keypoints by person; by tracklet where nobody is associated."""
        return self.people.assigned(self.tracklets) if self.people else self.tracklets

    def frames_at(self, time_s: NDArray) -> NDArray:
        """Return the frames (T,) nearest to times (T,) of the reference clock.

        -1 where the camera does not film: no frame lies within a frame interval of the time.
        """
        known, own_s = self.view.time_s, self.clock.from_reference(time_s)
        at = interpolation.nearest(known, own_s, "left")
        near = np.abs(known[at] - own_s) <= interpolation.frame_step_s(known)
        return np.where(near, at, -1)

    def frame_at(self, time_s: float) -> int | None:
        """Return the frame nearest to a time; None where the camera does not film (`frames_at`)."""
        at = int(self.frames_at(np.array([time_s]))[0])
        return at if at >= 0 else None

    def reference_s(self, frame: int) -> float:
        """Return the time of a frame on the reference clock."""
        return float(self.clock.to_reference(self.view.time_s[frame]))

    def standing(self, frame: int) -> camera_models.Camera:
        """Return the camera, turned as it was in a frame."""
        if self.turns is None:
            return self.camera
        return camera_models.turned(self.camera, self.turns[frame])

    def reprojected(self, points: Keypoints3D, frame: int) -> NDArray:
        """Project the skeletons into one frame of this camera, turned as it was then: (P, J, 2) px.

        Linearly between the two neighbouring times of `points`; NaN beyond its ends.
        """
        xyz = between(points, self.reference_s(frame))
        return camera_models.project(self.standing(frame), xyz)


def between(points: Keypoints3D, time_s: float) -> NDArray:
    """Return the skeletons (P, J, 3) at a time, linearly between frames; NaN beyond the ends."""
    # Within a thousandth of a frame a time counts as on that frame: times are rounded in files.
    known, tick = points.time_s, 1e-3 / max(points.rate_hz, 1) if len(points.time_s) > 1 else 1e-6
    if not known[0] - tick <= time_s <= known[-1] + tick:
        return np.full(points.xyz[:, 0].shape, np.nan)
    wanted_s = np.array([time_s])
    (left,), (share,) = interpolation.shares(known, wanted_s) if len(known) > 1 else ([0], [0.0])
    if share < 1e-3 or share > 1 - 1e-3:  # on a frame: its neighbour may be missing
        return points.xyz[:, left + round(share)]
    return interpolation.linear(known, points.xyz.swapaxes(0, 1), wanted_s)[0]


def read(
    cameras_toml: StrPath,
    pose2d_npz: Sequence[StrPath],
    people_npz: StrPath | None,
    sync_json: StrPath,
    videos: Sequence[StrPath] = (),
    wanted: Sequence[str] | None = None,
    *,
    sure_clocks: bool = False,
) -> list[Footage]:
    """Read what the cameras of a take gave: `wanted` ones in this order, all by default.

    `pose2d_npz` and `videos`, where these are needed, have one file for each camera, in one order;
    there are no people before persons are associated. An `InputError` if a camera is not calibrated
    for the size of its pictures, has no clock (with `sure_clocks`: or a doubtful one), or none of
    the files is of a wanted one.
    """
    known = {camera.name: camera for camera in camera_models.read_toml(cameras_toml)}
    who, (_, by_camera) = people.read(people_npz) if people_npz else None, clocks.read(sync_json)
    if sure_clocks and (fault := clocks.fault_line(sync_json, by_camera)):
        raise InputError(fault)
    found: dict[str, Footage] = {}
    films = videos or repeat(None, len(pose2d_npz))
    for path, video in zip(pose2d_npz, films, strict=True):
        view = keypoints.read_2d(path)
        if wanted is not None and view.camera not in wanted:
            continue
        for what, there in ((cameras_toml, known), (sync_json, by_camera)):
            if view.camera not in there:
                raise InputError(
                    f"{what}: expected camera {view.camera}, found {sorted(there)}; make it again"
                )
        camera, clock = known[view.camera], by_camera[view.camera]
        camera_models.check_size(camera, (int(view.size[0]), int(view.size[1])), path)
        found[view.camera] = Footage(camera, view, clock, video, who)
    names = list(map(str, found if wanted is None else wanted))
    missing = [name for name in names if name not in found]
    if missing:
        raise InputError(
            f"keypoints: expected the cameras {names}, missing {missing}; detect poses in them"
        )
    return [found[name] for name in names]
