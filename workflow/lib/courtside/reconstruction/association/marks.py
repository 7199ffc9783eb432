"""Match the user's sightings of subjects with the persons found, and assign subjects over time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np
from numpy.typing import NDArray

from courtside.reconstruction.association.identity import GAP_S, MEET_M
from courtside.records.cameras.footage import Footage
from courtside.records.keypoints.keypoints import Keypoints2D
from courtside.records.keypoints.people import People
from courtside.records.keypoints.sightings import Sighting
from courtside.study.errors import InputError

Value = Callable[["Mark"], int]  # the subject or the person of a mark
Change = Callable[["Mark", "Mark"], float]  # when what one mark says gives way to the next

# ASSUME: how exactly somebody points at a person in a paused video.
AROUND = 0.15  # of the person's height in the picture: a pixel this far outside the body is on it
CLOSE = 0.05  # of it: two bodies are not told apart if one is nearer by less
EXACT = 0.01  # of it: pixels from the page are the middle of a body
AROUND_S = 0.3  # frames this near count, where the person was not detected in the frame itself
AWAY_S = 2.0  # ASSUME: two who are out of sight for so long may come back in each other's place
ONE_MOMENT_S = 0.2  # marks of two subjects closer in time than this are a contradiction


@dataclass(frozen=True)
class Mark:
    """A sighting, with the person found there."""

    subject: int
    person: int
    time_s: float  # of the reference clock, as the next two
    from_s: float | None
    to_s: float | None
    where: str

    @property
    def bounded(self) -> bool:
        """Whether the mark states from when or until when it is valid."""
        return self.from_s is not None or self.to_s is not None


def locate(
    sighting: Sighting, found: People, seen: Sequence[Footage], subjects: Sequence[str]
) -> Mark:
    """Return the person at a sighting; raise a one-line `InputError` if nobody is there."""
    by_name = {one.camera.name: one for one in seen}
    if sighting.camera not in by_name:
        raise InputError(
            f"{sighting.where}: expected a camera of {', '.join(by_name)}, found "
            f"{sighting.camera!r}; correct it"
        )
    one = by_name[sighting.camera]
    _inside(sighting, one.tracklets)
    person = _person(sighting, found.index[sighting.camera], one.tracklets)
    time_s = float(one.clock.to_reference(sighting.time_s))
    start_s, stop_s = (
        None if t is None else float(one.clock.to_reference(t))
        for t in (sighting.from_s, sighting.to_s)
    )
    at = subjects.index(sighting.subject)
    return Mark(at, person, time_s, start_s, stop_s, sighting.where)


def _inside(sighting: Sighting, view: Keypoints2D) -> None:
    """Check time and pixel against the take."""
    step_s = float(np.median(np.diff(view.time_s))) if len(view.time_s) > 1 else 1.0
    first_s, last_s = float(view.time_s[0]), float(view.time_s[-1])
    if not first_s - step_s <= sighting.time_s <= last_s + step_s:
        raise InputError(
            f"{sighting.where}: expected time_s from {first_s:.2f} to {last_s:.2f} s, the part of "
            f"{sighting.camera}'s video that is used, found {sighting.time_s:g}; correct it"
        )
    size = view.size.tolist()
    if not all(-0.5 <= at <= length - 0.5 for at, length in zip(sighting.xy, size, strict=True)):
        raise InputError(
            f"{sighting.where}: expected a pixel of {sighting.camera}'s pictures of {size[0]} x "
            f"{size[1]} px, found {_px(sighting.xy)}; correct it"
        )


def _person(sighting: Sighting, index: NDArray, view: Keypoints2D) -> int:
    """Return the person whose body is at the pixel, in the nearest frame that shows somebody."""
    away_s = np.abs(view.time_s - sighting.time_s)
    step_s = float(np.median(np.diff(view.time_s))) if len(view.time_s) > 1 else 1.0
    limit_s = max(AROUND_S, 1.5 * step_s)
    unconfirmed = False
    for frame in np.argsort(away_s, kind="stable"):
        if away_s[frame] > limit_s:
            break
        off = off_body(view.xy[:, frame], sighting.xy)
        for row in np.argsort(off, kind="stable"):
            if off[row] > AROUND:
                break
            persons = np.flatnonzero(index[:, frame] == row)
            if len(persons):
                _alone(sighting, off, index[:, frame], int(row))
                return int(persons[0])
            unconfirmed = True
    raise InputError(_nobody(sighting, view, unconfirmed))


def _alone(sighting: Sighting, off: NDArray, rows: NDArray, row: int) -> None:
    """Check that no other person, of the `rows` of persons, is as near to the pixel as a row."""
    near = np.flatnonzero(off <= min(off[row] + CLOSE, AROUND))
    if off[row] > EXACT and (np.isin(rows, near) & (rows != row)).any():
        raise InputError(
            f"{sighting.where}: expected one person at {_px(sighting.xy)} px of {sighting.camera} "
            f"at {sighting.time_s:g} s, found two; choose another pixel, time or camera"
        )


def _nobody(sighting: Sighting, view: Keypoints2D, unconfirmed: bool) -> str:
    at = f"{_px(sighting.xy)} px of {sighting.camera} at {sighting.time_s:g} s"
    if unconfirmed:
        return (
            f"{sighting.where}: expected a person at {at} whom another camera sees too, found one "
            "in this camera alone; choose another time or camera"
        )
    frame = int(np.abs(view.time_s - sighting.time_s).argmin())
    shown = view.xy[:, frame][np.isfinite(view.xy[:, frame, :, 0]).any(axis=1)]
    places = ", ".join(_px(np.nanmean(xy, axis=0)) for xy in shown)
    return (
        f"{sighting.where}: expected a person at {at}, found "
        f"{f'people at {places}' if places else 'nobody in this picture'}; choose a pixel on the "
        "person's body, or another time or camera"
    )


def _px(xy: Sequence[float] | NDArray) -> str:
    return f"({xy[0]:.0f}, {xy[1]:.0f})"


def off_body(xy: NDArray, at_px: tuple[float, float]) -> NDArray:
    """Return how far a pixel is from bodies (P, J, 2) px, in shares of their size; inf without one.

    It is the distance from the nearest joint or the middle of the body; inside the box around the
    joints it is at most the least that counts as on the body.
    """
    off = np.full(len(xy), np.inf)
    for row, joints in enumerate(xy):
        known = joints[np.isfinite(joints).all(axis=1)]
        if len(known) < 3:
            continue
        low, high = known.min(axis=0), known.max(axis=0)
        size = max(float((high - low).max()), 1.0)
        points = np.vstack([known, np.median(known, axis=0)])
        share = float(np.linalg.norm(points - at_px, axis=1).min()) / size
        inside = bool((np.array(at_px) >= low).all() and (np.array(at_px) <= high).all())
        off[row] = min(share, AROUND) if inside else share
    return off


def timelines(found: People, marks: Sequence[Mark], n_subjects: int) -> tuple[NDArray, NDArray]:
    """Return the subject of each person (K, N), the person of each subject (S, N); -1 for none.

    Several marks of one subject on different persons join these persons: the subject changes from
    one to the next while both are out of sight for long, else when they are nearest. Marks of
    different subjects on one person split the person likewise, else where the person has no
    position or somebody else came near. Raises `InputError` if neither happened, or if persons to
    be joined were both there and never near. Marks with `from_s` or `to_s` hold within these;
    there, other marks do not, and two of them must not contradict each other.
    """
    count, n = found.path.shape[:2]
    owner, used = np.full((count, n), -1), np.full((n_subjects, n), -1)
    for before, after in combinations([mark for mark in marks if mark.bounded], 2):
        _one_statement(found, before, after)
    for person in sorted({mark.person for mark in marks}):
        own = sorted((m for m in marks if m.person == person), key=lambda m: m.time_s)
        owner[person] = _runs(found.time_s, own, lambda m: m.subject, _split_of(found, marks))
    for subject in sorted({mark.subject for mark in marks}):
        own = sorted((m for m in marks if m.subject == subject), key=lambda m: m.time_s)
        for before, after in pairwise(own):
            _one_place(found, before, after)
        used[subject] = _runs(found.time_s, own, lambda m: m.person, _join_of(found))
    return owner, used


def _runs(time_s: NDArray, own: Sequence[Mark], value: Value, change: Change) -> NDArray:
    """Return the value of the mark that holds at each time (N,); -1 where none does.

    Marks without bounds hold from one to the next, and before the first; `change` says when one
    gives way to the next, unless a mark with bounds lies between them. That holds within these.
    """
    always = [mark for mark in own if not mark.bounded]
    within = [mark for mark in own if mark.bounded]
    found = np.full(len(time_s), value(always[0]) if always else -1)
    for before, after in pairwise(always):
        if value(before) == value(after):
            continue
        stated = [m for m in within if before.time_s < m.time_s < after.time_s]
        change_s = _bound_s(stated[0]) if stated else change(before, after)
        found[time_s > change_s] = value(after)
    for mark in within:
        found[_within(time_s, mark)] = value(mark)
    return found


def _within(time_s: NDArray, mark: Mark) -> NDArray:
    """Return whether times (N,) are within the bounds of a mark."""
    start_s = -np.inf if mark.from_s is None else mark.from_s
    stop_s = np.inf if mark.to_s is None else mark.to_s
    return (time_s >= start_s) & (time_s <= stop_s)


def _one_statement(found: People, before: Mark, after: Mark) -> None:
    """Check that two marks with bounds do not say two things of one person or one subject."""
    same = before.person == after.person
    if same == (before.subject == after.subject):
        return
    both = _within(found.time_s, before) & _within(found.time_s, after)
    if not same:
        apart = np.linalg.norm(found.path[before.person] - found.path[after.person], axis=-1)
        both &= apart > MEET_M
    both_s = found.time_s[both]
    if len(both_s) and np.ptp(both_s) > GAP_S:
        what = "two subjects for one person" if same else "one subject at two places"
        raise InputError(
            f"{after.where}: expected times apart from those of {before.where}, found {what} from "
            f"{both_s[0]:.1f} to {both_s[-1]:.1f} s; correct from_s and to_s"
        )


def _bound_s(mark: Mark) -> float:
    """Return a bound of a mark that has one."""
    return float(next(at for at in (mark.from_s, mark.to_s) if at is not None))


def _split_of(found: People, marks: Sequence[Mark]) -> Change:
    """Return when a person who has marks of two subjects may have been exchanged."""

    def change(before: Mark, after: Mark) -> float:
        pair = {before.subject, after.subject}
        theirs = {m.person for m in marks if m.subject in pair} - {before.person}
        return _exchange_s(found, before, after, sorted(theirs))

    return change


def _exchange_s(found: People, before: Mark, after: Mark, theirs: Sequence[int]) -> float:
    """Return when a person may have become another between two marks, best one of `theirs`.

    That is while both were out of sight, else where they met, else while this one was out of sight
    or where somebody else came near.
    """
    person = before.person
    between = (found.time_s >= before.time_s) & (found.time_s <= after.time_s)
    at, path = found.time_s[between], found.path[:, between, :2]
    apart = np.linalg.norm(path - path[person], axis=-1)
    apart[person] = np.inf
    apart = np.nan_to_num(apart, nan=np.inf)
    seen = np.isfinite(path[..., 0])
    bounds = before.time_s, after.time_s
    of_both = [_longest_gap(at[seen[person] | seen[one]], *bounds) for one in theirs]
    alone = _longest_gap(at[seen[person]], *bounds)
    if after.time_s - before.time_s >= ONE_MOMENT_S:
        if max(of_both, default=(0.0, 0.0))[0] > AWAY_S:
            return max(of_both)[1]
        if apart[theirs].min(initial=np.inf) <= MEET_M:
            return float(at[int(np.argmin(apart[theirs].min(axis=0)))])
        if alone[0] > GAP_S:
            return alone[1]
        if apart.min(initial=np.inf) <= MEET_M:
            return float(at[int(np.argmin(apart.min(axis=0)))])
    raise InputError(
        f"{after.where}: expected another person than at {before.where}, found the same one, "
        "with nobody near in between; correct one of them, or state from_s and to_s in "
        "people.csv"
    )


def _longest_gap(known_s: NDArray, start_s: float, stop_s: float) -> tuple[float, float]:
    """Return the longest time without one of the times `known_s`: how long, and its middle."""
    edges_s = np.concatenate([[start_s], known_s, [stop_s]])
    gap = int(np.argmax(np.diff(edges_s)))
    return float(edges_s[gap + 1] - edges_s[gap]), float(edges_s[gap : gap + 2].mean())


def _one_place(found: People, before: Mark, after: Mark) -> None:
    """Check that two marks of one subject are not of two people at one moment."""
    now = int(np.abs(found.time_s - after.time_s).argmin())
    apart = float(np.linalg.norm(found.path[before.person, now] - found.path[after.person, now]))
    if after.time_s - before.time_s < ONE_MOMENT_S and apart > MEET_M:
        raise InputError(
            f"{after.where}: expected one place for each subject, found the subject of "
            f"{before.where} at the same time {apart:.1f} m away; correct one of them"
        )


def _join_of(found: People) -> Change:
    """Return the time at which a subject changes from one person to another."""

    def change(before: Mark, after: Mark) -> float:
        between = (found.time_s >= before.time_s) & (found.time_s <= after.time_s)
        at, path = found.time_s[between], found.path[:, between]
        apart = np.linalg.norm(path[before.person] - path[after.person], axis=-1)
        both_s = at[np.isfinite(apart)]
        if len(both_s):
            seen = np.isfinite(path[[before.person, after.person], :, 0]).any(axis=0)
            away_s, middle_s = _longest_gap(at[seen], before.time_s, after.time_s)
            met = np.nanmin(apart) <= MEET_M
            if away_s > (AWAY_S if met else GAP_S):
                return middle_s
            if not met and len(both_s) * np.median(np.diff(found.time_s)) > GAP_S:
                raise InputError(
                    f"{after.where}: expected the person of {before.where}, found another one, "
                    f"never nearer than {np.nanmin(apart):.1f} m in between; correct one of them, "
                    "or state from_s and to_s in people.csv"
                )
            return float(at[int(np.nanargmin(apart))])
        last = at[np.isfinite(path[before.person, :, 0])]
        return float(last[-1]) if len(last) else (before.time_s + after.time_s) / 2

    return change
