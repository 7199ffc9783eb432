"""The two tables of keypoints that rules exchange: 2D of one camera, 3D of one take."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from courtside.records import npz
from courtside.records.keypoints import missing_reason
from courtside.study.errors import StrPath

FORM_2D = "courtside keypoints2d 2"
FORM_3D = "courtside keypoints3d 3"
# ASSUME: networks that score from 0 to 1 score one joint in twenty no higher than this.
LIMITED = 1.2
BLOCK = 4096  # frames at a time: what is computed of each frame by itself then needs little memory


@dataclass(frozen=True)
class Keypoints2D:
    """What a network saw in one camera during one take."""

    camera: str
    model: str  # the network
    joints: Annotated[NDArray, "str J"]  # in the order of the network's skeleton
    size: Annotated[NDArray, "int 2"]  # width and height of the pictures, px
    time_s: Annotated[NDArray, "float T"]  # of each frame on the camera's own clock
    # Px, first pixel centre at (0, 0), distorted as in the picture; NaN where missing. P counts the
    # tracklets of this camera: they are not yet persons
    xy: Annotated[NDArray, "float P T J 2"]
    score: Annotated[NDArray, "float P T J"]  # confidence, 0 to 1; NaN where missing
    reason: Annotated[NDArray, "int P T J"]  # uint8: codes of `missing_reason`
    # The network's own metric guess relative to the hip centre, metres, axes as in cam (x right, y
    # down, z forward); NaN for networks without one
    xyz_in_body: Annotated[NDArray, "float P T J 3"]
    # Colours of the clothes, CIE L*a*b*, of the upper body and the thighs; NaN where unknown
    clothing: Annotated[NDArray, "float P T 2 3"]


@dataclass(frozen=True)
class Keypoints3D:
    """Metric skeletons of one take, in the world frame."""

    cameras: Annotated[NDArray, "str C"]  # the views, in the order of axis C below
    model: str  # network that saw the keypoints
    joints: Annotated[NDArray, "str J"]
    person_id: Annotated[NDArray, "str P"]  # as the session names them
    time_s: Annotated[NDArray, "float T"]  # uniform, on the reference clock
    xyz: Annotated[NDArray, "float P T J 3"]  # metres; NaN where `reason` says why
    # From the keypoints, square metres; NaN where unknown
    covariance_2d: Annotated[NDArray, "float P T J 3 3"]
    covariance_camera: Annotated[NDArray, "float P T J 3 3"]  # the same from the calibration
    # The same from what the residuals do not show: a wrong part, a hidden limb
    covariance_network: Annotated[NDArray, "float P T J 3 3"]
    # Known systematic error of the network, metres, not taken away; 0 once it is; NaN where unknown
    offset: Annotated[NDArray, "float P T J 3"]
    # Probability that, besides `offset`, the joint is over 100 mm off; NaN where unknown
    outlier: Annotated[NDArray, "float P T J"]
    n_views: Annotated[NDArray, "int P T J"]  # views used for the point; 0 where it is missing
    # Distance of each camera's keypoint to the projected point, accepted or not; NaN without either
    reproj_error_px: Annotated[NDArray, "float P T J C"]
    # Whether that camera's keypoint was used for the point
    accepted: Annotated[NDArray, "bool P T J C"]
    # Whether the fusion took that camera's keypoint of the other side: its network confused them
    swapped: Annotated[NDArray, "bool P T J C"]
    reason: Annotated[NDArray, "int P T J"]  # uint8: codes of `missing_reason`

    @property
    def covariance(self) -> NDArray:
        """The covariance (P, T, J, 3, 3) m2 of all errors: NaN where that of keypoints is unknown.

        Of the keypoints and, where known, of cameras and network; an offset that is not taken away
        counts with its square.
        """
        more = (self.covariance_camera, self.covariance_network)
        offset = np.nan_to_num(self.offset)
        squared = offset[..., :, None] * offset[..., None, :]
        return self.covariance_2d + sum(map(np.nan_to_num, more)) + squared

    @property
    def rate_hz(self) -> float:
        """Frames per second of the uniform times; NaN for a single frame."""
        if len(self.time_s) < 2:
            return float("nan")
        return float((len(self.time_s) - 1) / (self.time_s[-1] - self.time_s[0]))

    def between(self, start_s: float, stop_s: float) -> "Keypoints3D":
        """Return the frames from one time to another, both included."""
        return self.frames((self.time_s >= start_s) & (self.time_s <= stop_s))

    def frames(self, at: NDArray | slice) -> "Keypoints3D":
        """Return some frames, by their indices, a mask (T,) or a slice."""
        spec = npz.spec_of(Keypoints3D)
        per_frame = [key for key, (_, shape) in spec.items() if shape[:2] == ("P", "T")]
        cut = {key: getattr(self, key)[:, at] for key in per_frame}
        return replace(self, time_s=self.time_s[at], **cut)

    def without(self, lost: NDArray) -> "Keypoints3D":
        """Return the record without some points, by a mask (P, T, J): they are too uncertain.

        What was stated of their errors is unknown, too.
        """
        nothing = lost[..., None]
        stated = {key: getattr(self, key) for key in unknown_errors(self.xyz)}
        errors = {key: one.copy() for key, one in stated.items() if not np.isnan(one).all()}
        for one in errors.values():
            one[lost] = np.nan
        return replace(
            self,
            xyz=np.where(nothing, np.nan, self.xyz),
            **errors,
            n_views=np.where(lost, 0, self.n_views),
            reproj_error_px=np.where(nothing, np.nan, self.reproj_error_px),
            accepted=self.accepted & ~nothing,
            reason=np.where(lost, missing_reason.UNCERTAIN, self.reason).astype(np.uint8),
        )

    def some_joints(self, at: Sequence[int]) -> "Keypoints3D":
        """Return some joints, by their indices."""
        spec = npz.spec_of(Keypoints3D)
        per_joint = [key for key, (_, shape) in spec.items() if shape[:3] == ("P", "T", "J")]
        cut = {key: getattr(self, key)[:, :, list(at)] for key in per_joint}
        return replace(self, joints=self.joints[list(at)], **cut)


def while_there(seen: NDArray) -> NDArray:
    """Return whether each person is there, (..., T): from the first to the last frame `seen`.

    `seen` (..., T): whether two cameras see the person. Who is seen at no time is there all the
    time: lost, as far as is known.
    """
    came = np.maximum.accumulate(seen, axis=-1)
    stays = np.maximum.accumulate(seen[..., ::-1], axis=-1)[..., ::-1]
    return (came & stays) | ~seen.any(axis=-1, keepdims=True)


def full_score(score: NDArray) -> float:
    """Return the score that counts as 1: where scores are not limited, what 5 % of them exceed."""
    seen = score[np.isfinite(score)]
    high = float(np.percentile(seen, 95)) if seen.size else 0.0
    return high if high > LIMITED else 1.0


def blocks(n_frames: int) -> Iterator[slice]:
    """Yield the frames of a take in order, at most `BLOCK` of them at a time."""
    return (slice(at, at + BLOCK) for at in range(0, max(n_frames, 1), BLOCK))


def unknown_errors(xyz: NDArray) -> dict[str, NDArray]:
    """Return the fields of a `Keypoints3D` with points `xyz` whose errors nothing is known of.

    Not writable: each is one NaN in memory.
    """
    each = npz.unknown((*xyz.shape, 3))
    return {
        "covariance_2d": each,
        "covariance_camera": each,
        "covariance_network": each,
        "offset": npz.unknown(xyz.shape),
        "outlier": npz.unknown(xyz.shape[:-1]),
    }


def write_2d(path: StrPath, keypoints: Keypoints2D) -> None:
    """Write a `Keypoints2D` to an npz file."""
    npz.write_record(path, FORM_2D, keypoints)


def read_2d(path: StrPath) -> Keypoints2D:
    """Read a `Keypoints2D` from an npz file; raise `InputError` if it is not one."""
    return npz.read_record(path, FORM_2D, Keypoints2D)


def write_3d(path: StrPath, keypoints: Keypoints3D) -> None:
    """Write a `Keypoints3D` to an npz file."""
    npz.write_record(path, FORM_3D, keypoints)


def read_3d(path: StrPath, left_out: Collection[str] = ()) -> Keypoints3D:
    """Read a `Keypoints3D` from an npz file; raise `InputError` if it is not one.

    Errors that are `left_out` are unknown in the result: the three covariances are two thirds of a
    record's memory, and few steps need all.
    """
    return npz.read_record(path, FORM_3D, Keypoints3D, left_out)
