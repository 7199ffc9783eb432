"""The motion of a skeletal model: rigid segments with constant offsets, rotations, joint angles."""

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from courtside.records import npz
from courtside.records.devices.hierarchy import NO_PARENT, Hierarchy, PosedHierarchy
from courtside.study.errors import StrPath

FORM = "courtside skeletal motion 1"
SAME_M = 1e-6  # points that are so much nearer to a segment's origin are as far as the farthest


@dataclass(frozen=True)
class SkeletalMotion:
    """Persons of one take, each with segments of constant shape, in the world frame.

    A segment's axes are X forwards, Y up and Z to the right in the standing body (Wu et al. 2002,
    2005); its origin is its proximal joint. The world's z is up.
    """

    model: str  # network whose joints were fitted
    person_id: Annotated[NDArray, "str P"]
    time_s: Annotated[NDArray, "float T"]  # uniform, on the reference clock
    segments: Annotated[NDArray, "str S"]  # parents before their children, the root first
    parents: Annotated[NDArray, "int S"]  # index of each segment's parent, -1 for the root
    # Each segment's origin in its parent's axes, metres; constant. Zero for the root
    offsets: Annotated[NDArray, "float P S 3"]
    offset_sigma_m: Annotated[NDArray, "float P S"]  # of its length
    joints: Annotated[NDArray, "str J"]  # points of the segments: joints of the network
    segment_of: Annotated[NDArray, "int J"]  # the segment that each is fixed to
    places: Annotated[NDArray, "float P J 3"]  # of these points in the segment's axes, metres
    root: Annotated[NDArray, "float P T 3"]  # the root's origin, metres; NaN where not fitted
    # Rotation of each segment's axes in its parent's, of the root in the world; NaN where not
    # fitted
    parent_from_segment: Annotated[NDArray, "float P T S 3 3"]
    angles: Annotated[NDArray, "str A"]  # names of joint angles (docs/results.md)
    angle_deg: Annotated[NDArray, "float P T A"]  # NaN where not fitted
    angle_sigma_deg: Annotated[NDArray, "float P T A"]

    def posed(self, person: int) -> tuple[PosedHierarchy, NDArray]:
        """Return one person's motion over the fitted frames, and which of (T,) these are.

        Points of the segments that nothing hangs on become tips (`Hierarchy.ends`): the farthest of
        each segment, or the middle of points equally far (on the head those of both sides).
        """
        fitted = np.isfinite(self.root[person]).all(axis=1)
        inner = set(self.parents.tolist())
        names = self.segments.tolist()
        ends = {}
        for at in sorted(set(self.segment_of.tolist()) - inner):
            own = self.places[person, self.segment_of == at]
            away = np.linalg.norm(own, axis=1)
            if away.any():
                ends[names[at]] = own[away > away.max() - SAME_M].mean(axis=0)
        shape = Hierarchy(tuple(names), self.parents, self.offsets[person], ends)
        translation = np.repeat(self.offsets[person][None], int(fitted.sum()), axis=0)
        translation[:, self.parents == NO_PARENT] = self.root[person, fitted][:, None]
        rotation = self.parent_from_segment[person, fitted]
        return PosedHierarchy(shape, self.time_s[fitted], translation, rotation), fitted


def write(path: StrPath, motion: SkeletalMotion) -> None:
    """Write a `SkeletalMotion` to an npz file."""
    npz.write_record(path, FORM, motion)


def read(path: StrPath) -> SkeletalMotion:
    """Read a `SkeletalMotion` from an npz file; raise `InputError` if it is not one."""
    return npz.read_record(path, FORM, SkeletalMotion)
