"""What the viewer lays over one another: named methods, each with its joints, bones and errors."""

from dataclasses import dataclass, replace

import numpy as np

from courtside.geometry import similarity
from courtside.pages.viewer import packing
from courtside.records.devices import device_motion
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import keypoints, missing_reason
from courtside.study.errors import DAMAGED, InputError

PX = 0.01  # so that the logarithmic scale runs from 0.001 to 1000 px
NEAR = 0.5  # of a frame: frames of two layers that far apart show the same moment
LEAST_JOINTS = 3  # that tell how a body is turned
NOT_FINITE = 255  # reason of a joint that is missing though its method calls it ok


@dataclass(frozen=True, eq=False)
class Layer:
    """The skeletons that one method gives for a take, on the reference clock, in the world.

    Attributes
    ----------
    name : str
        As the switch in the page says it.
    joints : tuple of str, length J
    bones : tuple of (str, str)
    person_id : tuple of str, length P
    time_s : (T,) float
        Strictly increasing.
    xyz : (P, T, J, 3) float
        Metres; NaN where missing.
    covariance : (P, T, J, 3, 3) float or None
        Square metres; NaN where unknown.
    error_px : (P, T, J) float or None
        Reprojection error: root of the mean square over the views that the joint rests on.
    reason : (P, T, J) int or None
        `courtside.records.keypoints.missing_reason`.
    n_views : (P, T, J) int or None
    covers : str
        What the covariance covers, in words, for the legend.
    shown : bool
        Whether it is drawn when the page opens.
    """

    name: str
    joints: tuple
    bones: tuple
    person_id: tuple
    time_s: np.ndarray
    xyz: np.ndarray
    covariance: np.ndarray | None = None
    error_px: np.ndarray | None = None
    reason: np.ndarray | None = None
    n_views: np.ndarray | None = None
    covers: str = ""
    shown: bool = True

    def __post_init__(self):
        shape = (len(self.person_id), len(self.time_s), len(self.joints))
        wanted = {"xyz": (*shape, 3), "covariance": (*shape, 3, 3)}
        for key in ("xyz", "covariance", "error_px", "reason", "n_views"):
            found = getattr(self, key)
            if found is not None and np.shape(found) != wanted.get(key, shape):
                raise ValueError(
                    f"layer {self.name}: expected {key} as {wanted.get(key, shape)}, found {np.shape(found)}"
                )
        if not len(self.time_s) or (np.diff(self.time_s) <= 0).any():
            raise ValueError(f"layer {self.name}: expected times that increase")
        odd = {joint for bone in self.bones for joint in bone}.difference(self.joints)
        if odd:
            raise ValueError(f"layer {self.name}: bones name {sorted(odd)}, which are no joints")


def of_points(name, points, skeleton, *, shown=True):
    """Return the layer of triangulated skeletons.

    Parameters
    ----------
    name : str
    points : Keypoints3D
    skeleton : Skeleton
    shown : bool

    Returns
    -------
    layer : Layer
        Its covariance is that of keypoints and cameras together, or of the keypoints alone where that of the
        cameras is unknown throughout.
    """
    with_cameras = np.isfinite(points.covariance_camera).any()
    covariance = points.covariance_2d + (points.covariance_camera if with_cameras else 0)
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
        covariance,
        np.where(n_used > 0, np.sqrt(mean), np.nan),
        points.reason,
        points.n_views,
        "keypoints and cameras" if with_cameras else "keypoints only, cameras taken as exact",
        shown,
    )


# Upright axes (z up) from a device's own: y up, or as in cam (y down, z forward).
Y_UP, CAM = (
    np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]),
    np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]]),
)
UPRIGHT = {"inertial": Y_UP, "nuitrack": Y_UP, "rgb": CAM, "rgbd": CAM}


def of_device(name, motion, skeleton, person, *, shown=True):
    """Return the layer of a device's skeleton, which must be on the reference clock; turned upright.

    Parameters
    ----------
    name : str
    motion : DeviceMotion
    skeleton : Skeleton
    person : str
        Who wears or faces the device.
    shown : bool

    Returns
    -------
    layer : Layer
        Without the frames that nobody performed.
    """
    kept = np.asarray(motion.performed, dtype=bool)
    return Layer(
        name,
        tuple(np.asarray(motion.joints).tolist()),
        _bones(motion.joints, skeleton),
        (person,),
        motion.time_s[kept],
        motion.xyz[None, kept] @ UPRIGHT.get(motion.kind, np.eye(3)).T,
        reason=motion.reason[None, kept],
        shown=shown,
    )


def read(path, name, skeleton, *, person="", clock=None, shown=True):
    """Read a layer from a file of triangulated points or of a device's motion.

    Parameters
    ----------
    path : str or Path
    name : str
    skeleton : Skeleton
        Whose bones are drawn.
    person : str
        Of a device: who wears or faces it.
    clock : courtside.records.devices.clocks.Clock, optional
        Of a device; it shows the reference time where none is given.
    shown : bool

    Returns
    -------
    layer : Layer
        Of a device in the device's own frame; see `placed`.

    Raises
    ------
    InputError
        If the file is neither.
    """
    if _form(path) != device_motion.FORM:
        return of_points(name, keypoints.read_3d(path), skeleton, shown=shown)
    layer = of_device(name, device_motion.read(path), skeleton, person, shown=shown)
    return replace(layer, time_s=(clock or Clock()).to_reference(layer.time_s))


def _form(path):
    """Return what an npz file says it is; empty where it says nothing, which its reader reports."""
    try:
        with np.load(path, allow_pickle=False) as stored:
            return str(stored["format"])
    except DAMAGED:
        return ""


def placed(layer, onto):
    """Put a device's skeleton where another layer has the same person, by one turn and shift for the take.

    Parameters
    ----------
    layer, onto : Layer

    Returns
    -------
    layer : Layer
        In the frame of `onto`; lengths stay as they are.

    Raises
    ------
    InputError
        If the two have no person, moment or three joints in common.

    Notes
    -----
    Kabsch 1976: the rotation of the least squared distance between joints of one name.
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
            f"{onto.name} has as well, found {len(persons)} persons, {near.sum()} frames, {len(joints)} "
            "joints; check the device's clock and skeleton, or leave the layer out"
        )
    turn = similarity.umeyama(own[known], theirs[known]).rotation
    shift = theirs[known].mean(axis=0) - turn @ own[known].mean(axis=0)
    return replace(layer, xyz=layer.xyz @ turn.T + shift)


def _places(layer, persons, frames, joints):
    """Return the places (n, 3) of chosen joints in chosen frames."""
    chosen = np.ix_(
        [layer.person_id.index(name) for name in persons],
        frames,
        [layer.joints.index(name) for name in joints],
    )
    return layer.xyz[chosen].reshape(-1, 3)


def _bones(joints, skeleton):
    present = set(np.asarray(joints).tolist())
    return tuple(tuple(bone) for bone in skeleton.bones if set(bone) <= present)


def packed(layer, middle, every=1):
    """Return a layer as the page's scripts read it.

    Parameters
    ----------
    layer : Layer
    middle : (3,) float
        Metres; positions are stored about it.
    every : int
        Keep one frame of so many.

    Returns
    -------
    content : dict
        JSON-able; `viewer_data.js` unpacks it.
    """
    text, known = packing.positions(layer.xyz[:, ::every], middle)
    reason = np.zeros(known.shape, int) if layer.reason is None else layer.reason[:, ::every]
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


def _along(values):
    """Pack with time as the last axis: (P, T, J, ...) as (P, J, ..., T)."""
    return packing.integers(np.moveaxis(np.asarray(values).astype(int), 1, -1))
