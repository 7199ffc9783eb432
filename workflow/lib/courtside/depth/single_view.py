"""The main person of a single camera, and the network's own estimate of the metric body."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.records.devices.device_motion import DeviceMotion
from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.keypoints import Keypoints2D

# ASSUME: median score of the joints of a person who is there. Followed persons of the virtual
# sessions have 0.85 and more, things that are taken for persons 0.5 and less.
LEAST_SCORE = 0.5
# ASSUME: share of the frames, that show the usual person too, in which another one is taken. With a
# bystander 0.5 m behind a player who squats it was 0.38; where nobody else is there it is 0.
MOST_OTHERS = 0.02
# ASSUME: nobody becomes so many times as large or small within so many frames and seconds.
SUDDEN, SUDDEN_FRAMES, SUDDEN_S = 1.5, 5, 1.0
FIELDS = ("xy", "score", "reason", "xyz_in_body", "clothing")  # of each tracklet


def main_person(view: Keypoints2D) -> Keypoints2D:
    """Return the person nearest to the camera in each frame, as one tracklet (P = 1).

    The nearest is the one whose joints span most of the picture: single-view sessions have one
    subject. The tracklet is unseen where there is nobody.
    """
    n_people, n_frames = view.score.shape[:2]
    if n_people == 0:
        empty: dict[str, Any] = {
            key: np.full((1, *getattr(view, key).shape[1:]), np.nan) for key in FIELDS
        }
        empty["reason"] = np.full_like(empty["score"], missing_reason.UNSEEN, view.reason.dtype)
        return replace(view, **empty)
    who = _spans(view).argmax(axis=0)
    at = np.arange(n_frames)
    return replace(view, **{key: getattr(view, key)[who, at][np.newaxis] for key in FIELDS})


def _spans(view: Keypoints2D) -> NDArray:
    """Return the longer side (P, T) of what each tracklet spans in the picture; -1 if unseen."""
    known = np.isfinite(view.xy)
    low = np.where(known, view.xy, np.inf).min(axis=2)
    high = np.where(known, view.xy, -np.inf).max(axis=2)
    return np.where(high >= low, high - low, -1.0).max(axis=-1)


def doubt_of_one(source: str, view: Keypoints2D) -> str | None:
    """Return a line if the main person is now one, now another one.

    Another one is taken while the usual one is seen, too, or is of clearly another size than who is
    followed just before.
    """
    spans = _spans(view)
    if len(spans) < 2:
        whole = (view.reason != missing_reason.OUT_OF_IMAGE).all(axis=2)
        spans = np.where(whole, spans, -1.0).max(axis=0, initial=-1.0)
        return _doubt_of_size(source, view.time_s, spans)
    seen = spans > 0
    who = np.where(seen.any(axis=0), spans.argmax(axis=0), -1)
    usual = np.bincount(who[who >= 0], minlength=1).argmax()
    other = seen[usual] & (who != usual)
    if other.sum() <= MOST_OTHERS * seen[usual].sum():
        return None
    return (
        f"{source}: expected one person nearest to the camera throughout, found another one larger "
        f"in {other.sum()} of {seen[usual].sum()} frames, the first at "
        f"{view.time_s[other.argmax()]:.1f} s: keep others out of the picture, or well behind"
    )


def _doubt_of_size(source: str, time_s: NDArray, spans: NDArray) -> str | None:
    """Return a line if who is followed is suddenly of another size; `spans` (T,) px, -1 unseen."""
    at = np.flatnonzero(spans > 0)
    if len(at) < 2 * SUDDEN_FRAMES:
        return None
    means = np.median(np.lib.stride_tricks.sliding_window_view(spans[at], SUDDEN_FRAMES), axis=-1)
    before, after = means[:-SUDDEN_FRAMES], means[SUDDEN_FRAMES:]
    lasted_s = time_s[at[2 * SUDDEN_FRAMES - 1 :]] - time_s[at[: -2 * SUDDEN_FRAMES + 1]]
    ratio = np.maximum(before, after) / np.minimum(before, after)
    sudden = (ratio > SUDDEN) & (lasted_s <= SUDDEN_S)
    if not sudden.any():
        return None
    first = sudden.argmax()  # where the larger part of `after` is of another size
    at_s = time_s[at[first + SUDDEN_FRAMES + SUDDEN_FRAMES // 2]]
    return (
        f"{source}: expected one person throughout, found one of {before[first]:.0f} px and within "
        f"{lasted_s[first]:.1f} s one of {after[first]:.0f} px, at {at_s:.1f} s: keep others out "
        "of the picture"
    )


def doubt(source: str, person: Keypoints2D) -> str | None:
    """Return a line if the main person of a source is perhaps a thing; None if there is nobody."""
    scores = person.score[np.isfinite(person.xy).all(axis=-1)]
    if not len(scores) or np.median(scores) >= LEAST_SCORE:
        return None
    return (
        f"{source}: expected joints with a median score of {LEAST_SCORE:g} or more, found "
        f"{np.median(scores):.2f}: look whether there is a person in its picture"
    )


def landmarks(source: str, person: Keypoints2D) -> DeviceMotion:
    """Return the network's own metric body of the main person, as a motion named `source`.

    It is relative to the centre of the hips, axes as in cam (x right, y down, z forward), metres.
    `person` has one tracklet, of `main_person`, and `xyz_in_body`.
    """
    xyz, reason = person.xyz_in_body[0], person.reason[0]
    seen = np.isfinite(xyz).all(axis=-1)
    return DeviceMotion(
        source=source,
        kind="rgb",
        joints=np.asarray(person.joints),
        time_s=np.asarray(person.time_s, dtype=float),
        xyz=np.where(seen[..., np.newaxis], xyz, np.nan),
        reason=np.where(
            seen, missing_reason.OK, np.where(reason == 0, missing_reason.UNSEEN, reason)
        ).astype(np.uint8),
        performed=np.ones(len(xyz), dtype=bool),
    )
