"""Which tracklet of which camera is which person: the file between detection and triangulation."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.records import npz
from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.keypoints import Keypoints2D
from courtside.study.errors import InputError, StrPath

FORM = "courtside people 2"
# Cameras differ in their numbers of frames: the tables are concatenated along the frames.
SPEC = {
    "model": ("str", ()),
    "person_id": ("str", ("P",)),
    "placed": ("float", ("P",)),
    "confidence": ("float", ("P",)),
    "doubts": ("float", ("D", "5")),
    "time_s": ("float", ("T",)),
    "path": ("float", ("P", "T", "3")),
    "cameras": ("str", ("C",)),
    "n_frames": ("int", ("C",)),
    "index": ("int", ("P", "N")),
}

# ASSUME: that a person is still the same one: below, a user looks at a doubt. Many doubts may be
# surer each, but not together: with the three least certain, 13 of 22 exchanges in made teams of
# four and five are shown, without them 3.
SURE, LOOKS = 0.9, 3

PLAIN = ("placed", "time_s", "path", "confidence", "doubts")  # fields stored as they are


@dataclass(frozen=True)
class People:
    """The persons of one take in the tracklets of its cameras.

    Those found are called person-1, person-2, ..., the most often seen first; those named have the
    session's names.
    """

    model: str  # network that saw the tracklets
    person_id: NDArray  # (P,) str
    # (P,) float: share of the take in which two or more views agreed on the person's position
    placed: NDArray
    # (P, F) int: by camera: which tracklet row shows the person in each of its F frames, -1 for
    # none
    index: dict[str, NDArray]
    time_s: NDArray  # (T,) float: instants of the reference clock
    path: NDArray  # (P, T, 3) float: centre of the body, metres; NaN where not placed
    # (P,) float: probability that the person is one person throughout
    confidence: NDArray
    # (D, 5) float: where a person could have become another one: row of the person; start and stop,
    # s of the reference clock; row of the other person, -1 for nobody known; probability that it is
    # still the same person. Where sightings say that people were exchanged, but not at which of
    # several times: start and stop of what may be the other person
    doubts: NDArray

    def shares(self) -> dict[str, NDArray]:
        """Return by camera the share of its frames that show each person, (P,)."""
        return {name: (rows >= 0).mean(axis=1) for name, rows in self.index.items()}

    def to_check(self, person: int) -> NDArray:
        """Return the doubts (D, 5) about a person that are worth a look, in order of time.

        They are those below `SURE`, and up to `LOOKS` until all others together are above it.
        """
        own = self.doubts[self.doubts[:, 0] == person]
        own = own[np.argsort(own[:, 4], kind="stable")]
        together = np.cumprod(own[::-1, 4])[::-1]  # each with all that are surer
        n = max((own[:, 4] < SURE).sum(), min((together < SURE).sum(), LOOKS))
        return own[:n][np.argsort(own[:n, 1], kind="stable")]

    def assigned(self, view: Keypoints2D) -> Keypoints2D:
        """Return the keypoints of one camera by person instead of by tracklet.

        Where no tracklet shows a person all is NaN, with the reason UNSEEN. An `InputError` if
        people were found in other cameras, frames or tracklets.
        """
        if view.camera not in self.index:
            raise InputError(
                f"{view.camera}: expected people of the cameras {', '.join(self.index)}, found "
                "none of this camera; associate them again"
            )
        index, frames = self.index[view.camera], len(view.time_s)
        if index.shape[1:] != (frames,) or index.max(initial=-1) >= len(view.xy):
            raise InputError(
                f"{view.camera}: expected people in {frames} frames of {len(view.xy)} tracklets, "
                f"found {index.shape[1]} frames and tracklet {index.max(initial=-1)}; associate "
                "them again"
            )
        known, row, at = index >= 0, np.maximum(index, 0), np.arange(frames)

        def pick(values: NDArray, missing: float | np.uint8) -> NDArray:
            empty = ~known.reshape(*known.shape, *(1,) * (values.ndim - 2))
            return np.where(empty, missing, values[row, at]).astype(values.dtype)

        return replace(
            view,
            xy=pick(view.xy, np.nan),
            score=pick(view.score, np.nan),
            reason=pick(view.reason, np.uint8(missing_reason.UNSEEN)),
            xyz_in_body=pick(view.xyz_in_body, np.nan),
            clothing=pick(view.clothing, np.nan),
        )


def write(path: StrPath, people: People) -> None:
    """Write a `People` to an npz file."""
    arrays: dict[str, ArrayLike] = {
        "model": people.model,
        "person_id": people.person_id,
        **{key: getattr(people, key) for key in PLAIN},
        "cameras": np.array(list(people.index), dtype=str),
        "n_frames": np.array([table.shape[1] for table in people.index.values()], dtype=int),
        "index": np.concatenate(list(people.index.values()), axis=1),
    }
    npz.write(path, FORM, SPEC, arrays)


def read(path: StrPath) -> People:
    """Read a `People` from an npz file; raise `InputError` if it is not one."""
    found = npz.read(path, FORM, SPEC)
    if found["n_frames"].sum() != found["index"].shape[1] or (found["n_frames"] < 0).any():
        raise InputError(
            f"{path}: index: expected {found['n_frames'].sum()} frames of all cameras together, "
            f"found {found['index'].shape[1]}; make it again"
        )
    tables = np.split(found["index"], np.cumsum(found["n_frames"])[:-1], axis=1)
    index = dict(zip(map(str, found["cameras"]), tables, strict=True))
    plain = {key: found[key] for key in PLAIN}
    return People(str(found["model"]), found["person_id"], index=index, **plain)
