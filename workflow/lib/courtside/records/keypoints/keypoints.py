"""The two tables of keypoints that rules exchange: 2D of one camera, 3D of one take."""

from dataclasses import dataclass, replace
from os import PathLike

from numpy.typing import NDArray

from courtside.records import npz

FORM_2D = "courtside keypoints2d 1"
FORM_3D = "courtside keypoints3d 2"
SPEC_2D = {
    "camera": ("str", ()),
    "model": ("str", ()),
    "joints": ("str", ("J",)),
    "size": ("int", ("2",)),
    "time_s": ("float", ("T",)),
    "xy": ("float", ("P", "T", "J", "2")),
    "score": ("float", ("P", "T", "J")),
    "reason": ("int", ("P", "T", "J")),
    "xyz_in_body": ("float", ("P", "T", "J", "3")),
}
SPEC_3D = {
    "cameras": ("str", ("C",)),
    "model": ("str", ()),
    "joints": ("str", ("J",)),
    "person_id": ("str", ("P",)),
    "time_s": ("float", ("T",)),
    "xyz": ("float", ("P", "T", "J", "3")),
    "covariance_2d": ("float", ("P", "T", "J", "3", "3")),
    "covariance_camera": ("float", ("P", "T", "J", "3", "3")),
    "n_views": ("int", ("P", "T", "J")),
    "reproj_error_px": ("float", ("P", "T", "J", "C")),
    "accepted": ("bool", ("P", "T", "J", "C")),
    "swapped": ("bool", ("P", "T", "J", "C")),
    "reason": ("int", ("P", "T", "J")),
}


@dataclass(frozen=True)
class Keypoints2D:
    """What a network saw in one camera during one take.

    Attributes
    ----------
    camera, model : str
        Names of camera and network.
    joints : (J,) str
        In the order of the network's skeleton.
    size : (2,) int
        Width and height of the pictures, px.
    time_s : (T,) float
        Time of each frame on the camera's own clock.
    xy : (P, T, J, 2) float
        Px, first pixel centre at (0, 0), distorted as in the picture; NaN where missing.
        P counts the tracklets of this camera: they are not yet persons.
    score : (P, T, J) float
        Confidence, 0 to 1; NaN where missing.
    reason : (P, T, J) uint8
        `courtside.records.keypoints.missing_reason`.
    xyz_in_body : (P, T, J, 3) float
        The network's own metric guess relative to the hip centre, metres, axes as in cam (x right,
        y down, z forward); NaN for networks without one.
    """

    camera: str
    model: str
    joints: NDArray
    size: NDArray
    time_s: NDArray
    xy: NDArray
    score: NDArray
    reason: NDArray
    xyz_in_body: NDArray


@dataclass(frozen=True)
class Keypoints3D:
    """Metric skeletons of one take, in the world frame.

    Attributes
    ----------
    cameras : (C,) str
        The views, in the order of the last axis of `reproj_error_px`, `accepted` and `swapped`.
    model : str
        Network that saw the keypoints.
    joints, person_id : (J,) str, (P,) str
        Persons as the session names them.
    time_s : (T,) float
        Uniform times on the reference clock.
    xyz : (P, T, J, 3) float
        Metres; NaN where `reason` says why.
    covariance_2d, covariance_camera : (P, T, J, 3, 3) float
        Covariance from the keypoints and from the calibration, square metres; NaN where unknown.
    n_views : (P, T, J) int
        Views used for the point; 0 where it is missing.
    reproj_error_px : (P, T, J, C) float
        Distance of each camera's keypoint to the projected point, accepted or not; NaN without
        either.
    accepted : (P, T, J, C) bool
        Whether that camera's keypoint was used for the point.
    swapped : (P, T, J, C) bool
        Whether the fusion took that camera's keypoint of the other side, because its network
        confused left and right.
    reason : (P, T, J) uint8
        `courtside.records.keypoints.missing_reason`.
    """

    cameras: NDArray
    model: str
    joints: NDArray
    person_id: NDArray
    time_s: NDArray
    xyz: NDArray
    covariance_2d: NDArray
    covariance_camera: NDArray
    n_views: NDArray
    reproj_error_px: NDArray
    accepted: NDArray
    swapped: NDArray
    reason: NDArray

    @property
    def rate_hz(self) -> float:
        """Frames per second of the uniform times; NaN for a single frame."""
        if len(self.time_s) < 2:
            return float("nan")
        return float((len(self.time_s) - 1) / (self.time_s[-1] - self.time_s[0]))

    def between(self, start_s: float, stop_s: float) -> "Keypoints3D":
        """Return the frames from one time to another, both included."""
        at = (self.time_s >= start_s) & (self.time_s <= stop_s)
        per_frame = [key for key, (_, shape) in SPEC_3D.items() if shape[:2] == ("P", "T")]
        cut = {key: getattr(self, key)[:, at] for key in per_frame}
        return replace(self, time_s=self.time_s[at], **cut)


def write_2d(path: str | PathLike, keypoints: Keypoints2D) -> None:
    """Write a `Keypoints2D` to an npz file."""
    npz.write(path, FORM_2D, SPEC_2D, vars(keypoints))


def read_2d(path: str | PathLike) -> Keypoints2D:
    """Read a `Keypoints2D` from an npz file; raise `InputError` if it is not one."""
    return Keypoints2D(**npz.plain(npz.read(path, FORM_2D, SPEC_2D)))


def write_3d(path: str | PathLike, keypoints: Keypoints3D) -> None:
    """Write a `Keypoints3D` to an npz file."""
    npz.write(path, FORM_3D, SPEC_3D, vars(keypoints))


def read_3d(path: str | PathLike) -> Keypoints3D:
    """Read a `Keypoints3D` from an npz file; raise `InputError` if it is not one."""
    return Keypoints3D(**npz.plain(npz.read(path, FORM_3D, SPEC_3D)))
