"""Layers of the viewer: the joints, bones and errors of one method, under a name."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import similarity
from courtside.pages.viewer import packing
from courtside.records.devices import device_motion
from courtside.records.devices.clocks import Clock
from courtside.records.devices.device_motion import DeviceMotion
from courtside.records.keypoints import keypoints, missing_reason
from courtside.records.keypoints.keypoints import Keypoints3D
from courtside.records.keypoints.skeleton import Skeleton
from courtside.study.errors import InputError, StrPath

PX = 0.01  # unit of stored errors: the logarithmic scale then runs from 0.001 to 1000 px
NEAR = 0.5  # of the frame interval: frames of two layers this close show the same moment
LEAST_JOINTS = 3  # the fewest points that determine a rotation
NOT_FINITE = 255  # reason of a joint that is missing although its method calls it ok


@dataclass(frozen=True, eq=False)
class Layer:
    """The skeletons of one method for a take, on the reference clock, in the world."""

    name: str  # of its switch in the page
    joints: tuple[str, ...]  # length J
    bones: tuple[tuple[str, str], ...]
    person_id: tuple[str, ...]  # length P
    time_s: NDArray  # (T,): strictly increasing
    xyz: NDArray  # (P, T, J, 3): metres; NaN where missing
    covariance: NDArray | None = None  # (P, T, J, 3, 3): square metres; NaN where unknown
    error_px: NDArray | None = None  # (P, T, J): root mean square over the views that were used
    reason: NDArray | None = None  # (P, T, J) int: `missing_reason`
    n_views: NDArray | None = None  # (P, T, J) int
    covers: str = ""  # what the covariance includes, in words, for the legend
    shown: bool = True  # when the page opens

    def __post_init__(self) -> None:
        shape = (len(self.person_id), len(self.time_s), len(self.joints))
        wanted = {"xyz": (*shape, 3), "covariance": (*shape, 3, 3)}
        for key in ("xyz", "covariance", "error_px", "reason", "n_views"):
            found = getattr(self, key)
            if found is not None and np.shape(found) != wanted.get(key, shape):
                where = f"layer {self.name}: expected {key} as {wanted.get(key, shape)}"
                raise ValueError(f"{where}, found {np.shape(found)}")
        if not len(self.time_s) or (np.diff(self.time_s) <= 0).any():
            raise ValueError(f"layer {self.name}: expected times that increase")
        odd = {joint for bone in self.bones for joint in bone}.difference(self.joints)
        if odd:
            raise ValueError(f"layer {self.name}: bones name {sorted(odd)}, which are no joints")


def of_points(name: str, points: Keypoints3D, skeleton: Skeleton, *, shown: bool = True) -> Layer:
    """Return the layer of triangulated skeletons.

    Its covariance is that of all errors, as files state it (`Keypoints3D.covariance`).
    """
    used = points.accepted & np.isfinite(points.reproj_error_px)
    squares = np.where(used, points.reproj_error_px, 0) ** 2
    n_used = used.sum(axis=-1)
    mean = squares.sum(axis=-1) / np.maximum(n_used, 1)
    return Layer(
        name,
        tuple(points.joints.tolist()),
        _bones(points.joints, skeleton),
        tuple(points.person_id.tolist()),
        points.time_s,
        points.xyz,
        points.covariance,
        np.where(n_used > 0, np.sqrt(mean), np.nan),
        points.reason,
        points.n_views,
        _covers(points),
        shown,
    )


def _covers(points: Keypoints3D) -> str:
    """Return in words what a record's covariance includes, and what is assumed to be exact."""
    known = {
        "keypoints": True,
        "network": np.isfinite(points.covariance_network).any(),
        "offset": np.nan_to_num(points.offset).any(),
        "cameras": np.isfinite(points.covariance_camera).any(),
    }
    *others, last = (name for name, there in known.items() if there)
    words = f"{', '.join(others)} and {last}" if others else f"{last} only"
    return words if known["cameras"] else f"{words}, cameras taken as exact"


def of_device(
    name: str, motion: DeviceMotion, skeleton: Skeleton, person: str, *, shown: bool = True
) -> Layer:
    """Return the layer of a device's skeleton, turned upright, in the frames that were performed.

    The motion must be on the reference clock; `person` wears or faces the device. `InputError` if
    nothing was performed.
    """
    kept = np.asarray(motion.performed, dtype=bool)
    if not kept.any():
        raise InputError(
            f"layer {name}: expected frames of the device that were performed, found none; "
            "record it again, or leave the device out"
        )
    return Layer(
        name,
        tuple(np.asarray(motion.joints).tolist()),
        _bones(motion.joints, skeleton),
        (person,),
        motion.time_s[kept],
        device_motion.upright(motion)[None, kept],
        reason=motion.reason[None, kept],
        shown=shown,
    )


def read(
    path: StrPath,
    name: str,
    skeleton: Skeleton,
    *,
    person: str = "",
    clock: Clock | None = None,
    shown: bool = True,
) -> Layer:
    """Read a layer from a file of triangulated points or of a device's motion, else `InputError`.

    `person` is given for a device, which they wear or face; its layer is in the device's own frame,
    see `placed`. Its `clock` is None if its times are on the reference clock.
    """
    if not person:
        return of_points(name, keypoints.read_3d(path), skeleton, shown=shown)
    layer = of_device(name, device_motion.read(path), skeleton, person, shown=shown)
    return replace(layer, time_s=(clock or Clock()).to_reference(layer.time_s))


def placed(layer: Layer, onto: Layer) -> Layer:
    """Move a device's skeleton onto the same person in another layer, rotated and translated once.

    The lengths of the skeleton stay the same. The rotation is the least-squares one (Kabsch 1976)
    between joints of the same name over the whole take. `InputError` if the two have no person,
    time or three joints in common.
    """
    persons = [name for name in layer.person_id if name in onto.person_id]
    joints = [name for name in layer.joints if name in onto.joints]
    step_s = np.median(np.diff(onto.time_s)) if len(onto.time_s) > 1 else np.inf
    at = np.interp(layer.time_s, onto.time_s, np.arange(len(onto.time_s))).round().astype(int)
    near = np.abs(layer.time_s - onto.time_s[at]) <= NEAR * step_s
    own = _places(layer, persons, np.flatnonzero(near), joints)
    theirs = _places(onto, persons, at[near], joints)
    known = np.isfinite(own).all(axis=1) & np.isfinite(theirs).all(axis=1)
    if len(joints) < LEAST_JOINTS or known.sum() < LEAST_JOINTS:
        raise InputError(
            f"layer {layer.name}: expected a person, times and {LEAST_JOINTS} joints or more that "
            f"{onto.name} has as well, found {len(persons)} persons, {near.sum()} frames, "
            f"{len(joints)} joints; check the device's clock and skeleton, or leave the layer out"
        )
    return replace(layer, xyz=similarity.rigid(own[known], theirs[known]).points(layer.xyz))


def _places(layer: Layer, persons: list[str], frames: NDArray, joints: list[str]) -> NDArray:
    """Return the places (n, 3) of chosen joints in chosen frames."""
    chosen = np.ix_(
        np.array([layer.person_id.index(name) for name in persons], dtype=int),
        frames,
        np.array([layer.joints.index(name) for name in joints], dtype=int),
    )
    return layer.xyz[chosen].reshape(-1, 3)


def _bones(joints: NDArray, skeleton: Skeleton) -> tuple[tuple[str, str], ...]:
    present = set(np.asarray(joints).tolist())
    return tuple((start, end) for start, end in skeleton.bones if {start, end} <= present)


def packed(layer: Layer, middle: NDArray, every: int = 1) -> dict:
    """Return a layer as JSON-able content that `viewer_data.js` unpacks, every n-th frame.

    Positions are stored relative to `middle` (3,) m.
    """
    text, known = packing.positions(layer.xyz[:, ::every], middle)
    shape = layer.xyz.shape[:-1]
    reason = (np.zeros(shape, int) if layer.reason is None else layer.reason)[:, ::every]
    absent = np.where(reason == missing_reason.OK, NOT_FINITE, reason)
    content = {
        "name": layer.name,
        "joints": list(layer.joints),
        "bones": [[layer.joints.index(joint) for joint in bone] for bone in layer.bones],
        "persons": list(layer.person_id),
        "time_s": [round(float(time), 5) for time in layer.time_s[::every]],
        "shown": layer.shown,
        "covers": layer.covers,
        "xyz": text,
        "known": _along(known),
        "reason": _along(np.where(known, reason, absent)),
    }
    if layer.covariance is not None:
        content["ellipsoid"] = _along(packing.ellipsoids(layer.covariance[:, ::every]))
    if layer.error_px is not None:
        content["error_px"] = _along(packing.sizes(layer.error_px[:, ::every] * PX))
    if layer.n_views is not None:
        content["n_views"] = _along(layer.n_views[:, ::every])
    return content


def _along(values: NDArray) -> str:
    """Pack with time as the last axis: (P, T, J, ...) as (P, J, ..., T)."""
    return packing.integers(np.moveaxis(np.asarray(values).astype(int), 1, -1))
