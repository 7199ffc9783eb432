"""Assign the subjects to the persons found, from the user's sightings and never by a guess."""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court.court import Court
from courtside.geometry import interpolation
from courtside.reconstruction.association import marks as marks_of
from courtside.reconstruction.association.associate import COUNTS, nowhere
from courtside.reconstruction.association.identity import GAP_S, MEET_M, confidence
from courtside.reconstruction.association.marks import Mark
from courtside.records.cameras.footage import Footage
from courtside.records.keypoints.people import People
from courtside.records.keypoints.sightings import Sighting
from courtside.study.errors import LONGEST, InputError

# ASSUME: who plays is this near the court's lines for a tenth of the take.
BESIDE_M = 2.0
Spans = list[tuple[float, float]]  # from and to, s
Free = dict[int, Spans]  # by person: the times of it that no subject uses


@dataclass(frozen=True)
class Wording:
    """Words for messages."""

    take: str  # session/take
    page: str  # where the page is on which people are named; empty without one
    file: str  # of the session


def name(
    found: People,
    seen: Sequence[Footage],
    sightings: Sequence[Sighting],
    subjects: Sequence[str],
    words: Wording,
    court: Court | None = None,
) -> People:
    """Return the subjects (S,) among the persons found, with the rows that show each one.

    Sightings assign persons to subjects (`marks`). If one subject has no sighting, it is the only
    person without a name who counts: tracked for a tenth of the take, near a `court`. Raises a
    one-line `InputError` if a subject is ambiguous or a sighting is wrong.
    """
    if not (found.placed > 0).any():
        raise InputError(nowhere(found.index))
    marks = [marks_of.locate(one, found, seen, list(subjects)) for one in sightings]
    owner, used = marks_of.timelines(found, marks, len(subjects))
    open_ = [s for s in range(len(subjects)) if not any(mark.subject == s for mark in marks)]
    free = _candidates(found, {mark.person for mark in marks}, court)
    if open_ and not marks and len(subjects) == 1 and not free:
        free = [int(np.argmax(found.placed))]
    if len(open_) > 1 or (open_ and len(free) > 1):
        raise InputError(*_ambiguous(found, seen, [subjects[s] for s in open_], free, words))
    for subject, person in zip(open_, free, strict=False):
        owner[person], used[subject] = subject, person
    return _named(found, seen, subjects, owner, used, marks)


def others(found: People, named: People) -> list[str]:
    """Return the persons found who are no subject: in a tenth of the take, or for some time."""
    free = _nameless(found, named)
    lines = []
    for at, (name, placed) in enumerate(zip(found.person_id, found.placed, strict=True)):
        if at in free:
            lines += [f"{name} (from {_spans(free[at])})"] if free[at] else []
        elif placed >= COUNTS:
            lines.append(f"{name} (placed in {placed:.0%} of the take)")
    return lines


def _nameless(found: People, named: People) -> Free:
    """Return by person the times, longer than 0.5 s, in which it is placed but no subject.

    Whoever is no subject at any time is left out.
    """
    used = (found.path[:, None] == named.path).all(axis=-1).any(axis=1)
    free = np.where(np.isfinite(found.path[..., 0]) & ~used, np.nan, 0.0)
    return {
        int(at): gaps_s(found.time_s, free[at, :, None]) for at in np.flatnonzero(used.any(axis=1))
    }


def lines(found: People, named: People) -> list[str]:
    """Return a log line for each subject: share of frames, probability, gaps and doubts."""
    free = _nameless(found, named)
    return [_line(found, named, at, free) for at in range(len(named.person_id))]


def _line(found: People, named: People, at: int, free: Free) -> str:
    if not named.placed[at]:
        return f"{named.person_id[at]}: not found"
    gaps: dict[str, Spans] = defaultdict(list)
    for gap in gaps_s(named.time_s, named.path[at]):
        gaps[_who_may_be(found, named.path[at], gap, free)].append(gap)
    parts = [f"placed from two views or more in {named.placed[at]:.0%} of the take"]
    parts += [f"one person throughout with probability {named.confidence[at]:.2f}"]
    parts += [f"not placed from {_spans(gaps.pop(''))}"] if "" in gaps else []
    parts += [
        f"not named from {_spans(spans)}: say who {who} is then" for who, spans in gaps.items()
    ]
    for _, start, stop, other, kept in named.to_check(at):
        span = f"{named.person_id[int(other)]} from {start:.1f} to"
        who = span if other >= 0 else "somebody else after"
        parts += [f"may be {who} {stop:.1f} s ({kept:.2f} that not): look at the page"]
    return f"{named.person_id[at]}: {'; '.join(parts)}"


def _who_may_be(found: People, path: NDArray, gap: tuple[float, float], free: Free) -> str:
    """Return the person who has no name in a gap of a subject's path, near it before or after."""
    ends = (np.abs(found.time_s[:, None] - gap) <= GAP_S).any(axis=1)
    near = (np.linalg.norm(found.path[:, ends] - path[ends], axis=-1) <= MEET_M).any(axis=1)
    for person, spans in free.items():
        overlap_s = sum(max(min(b, gap[1]) - max(a, gap[0]), 0) for a, b in spans)
        if overlap_s > GAP_S and near[person]:
            return str(found.person_id[person])
    return ""


def _spans(spans: Spans) -> str:
    return ", ".join(f"{a:.1f} to {b:.1f} s" for a, b in spans)


def gaps_s(time_s: NDArray, path: NDArray) -> Spans:
    """Return the times, longer than 0.5 s, without a place in a path (T, 3)."""
    known = np.isfinite(path[:, 0])
    bounds = np.concatenate([[time_s[0]], time_s[known], [time_s[-1]]])
    wide = np.flatnonzero(np.diff(bounds) > GAP_S)
    return [(float(bounds[i]), float(bounds[i + 1])) for i in wide]


def _candidates(found: People, taken: set[int], court: Court | None) -> list[int]:
    """Return the persons without a name who count, by how often they were placed.

    They are near the court in a tenth of the take, or a third as long as one who is.
    """
    share = found.placed
    if court is not None:
        xy = found.path[..., :2]
        near = (xy >= -BESIDE_M) & (xy <= court.size_m + BESIDE_M)
        share = np.minimum(share, near.all(axis=-1).mean(axis=-1))
    share = np.where(np.isin(np.arange(len(share)), list(taken)), 0.0, share)
    least = min(COUNTS, share.max() / 3) if share.max() >= COUNTS else COUNTS
    return np.flatnonzero(share >= least).tolist()


def _ambiguous(
    found: People, seen: Sequence[Footage], open_: list[str], free: list[int], words: Wording
) -> list[str]:
    """Return the error line that asks who the ambiguous subjects are.

    Without a page a team does not fit into it: then a line for each person follows.
    """
    shares = found.shares()
    people = []
    for k in free:
        x, y, _ = np.nanmedian(found.path[k], axis=0)
        by = ", ".join(camera for camera, share in shares.items() if share[k] >= COUNTS)
        people.append(
            f"{found.person_id[k]} ({found.placed[k]:.0%} of the take, about x {x:.1f} y {y:.1f} m,"
            f" seen by {by}{'' if words.page else _sighting(found, seen, k)})"
        )
    who = "which of them is" if len(free) != 1 else "whether this is"
    page = f"on the page {words.page} (people.csv), or " if words.page else ""
    wanted = f"{words.take}: expected a statement who is {' and who is '.join(open_)}, found "
    what_to_do = f"; say {who} {' or '.join(open_)} {page}by `seen` in {words.file}"
    line = f"{wanted}{', '.join(people) or 'nobody'}{what_to_do}"
    if words.page or len(line) <= LONGEST:
        return [line]
    return [f"{wanted}{len(people)} persons, listed below in the log{what_to_do}", *people]


def _sighting(found: People, seen: Sequence[Footage], person: int) -> str:
    """Return an entry of `seen` for a person, for takes without pictures."""
    for one in seen:
        rows = found.index[one.camera.name][person]
        xy = one.tracklets.xy[rows, np.arange(len(rows))]
        frames = np.flatnonzero((rows >= 0) & np.isfinite(xy[..., 0]).any(axis=1))
        if len(frames):
            at = frames[len(frames) // 2]
            x, y = np.nanmedian(xy[at], axis=0)
            time_s = one.tracklets.time_s[at]
            where = f"camera: {one.camera.name}, time_s: {time_s:.3f}, at_px: [{x:.0f}, {y:.0f}]"
            return f", {{{where}}}"
    return ""


def _named(
    found: People, seen: Sequence[Footage], subjects: Sequence[str], owner: NDArray, used: NDArray,
    marks: Sequence[Mark],
) -> People:  # fmt: skip
    """Return the record of the subjects; (S, N) of the person used at each instant."""
    index = {one.camera.name: _rows(found, one, owner, used) for one in seen}
    own = np.where(used >= 0, owner[np.maximum(used, 0), np.arange(used.shape[1])], -1)
    there = own == np.arange(len(subjects))[:, None]
    path = np.where(there[..., None], found.path[used, np.arange(used.shape[1])], np.nan)
    doubts = _doubts(found, owner, used, marks)
    return replace(
        found,
        person_id=np.array(subjects),
        placed=np.isfinite(path[..., 0]).mean(axis=1),
        index=index,
        path=path,
        doubts=doubts,
        confidence=confidence(doubts, len(subjects)),
    )


def _rows(found: People, one: Footage, owner: NDArray, used: NDArray) -> NDArray:
    """Return the row (S, F) of each subject in each frame of a camera."""
    index = found.index[one.camera.name]
    frame_s = one.clock.to_reference(one.tracklets.time_s)
    at = interpolation.nearest(found.time_s, frame_s)
    frames = np.arange(len(frame_s))
    person = used[:, at]
    own = (person >= 0) & (owner[np.maximum(person, 0), at] == np.arange(len(used))[:, None])
    return np.where(own, index[np.maximum(person, 0), frames], -1)


def _doubts(found: People, owner: NDArray, used: NDArray, marks: Sequence[Mark]) -> NDArray:
    """Return the doubts about subjects; two sightings that agree settle what lies between them."""
    kept, contradicted = [], defaultdict(list)
    for row in found.doubts:
        person, start_s, stop_s = int(row[0]), row[1], row[2]
        own = sorted((m for m in marks if m.person == person), key=lambda m: m.time_s)
        before = [m for m in own if m.time_s <= start_s][-1:]
        after = [m for m in own if m.time_s >= stop_s][:1]
        if before and after:
            contradicted[before[0], after[0]].append(row)
            continue
        at = np.abs(found.time_s - stop_s).argmin()
        subject = int(owner[person, at])
        if subject >= 0 and used[subject, at] == person:
            kept.append([subject, start_s, stop_s, -1.0, row[4]])
    for (first, second), rows in contradicted.items():
        if first.subject != second.subject and not (first.bounded or second.bounded):
            kept += _exchanged(found.time_s, owner, used, (first, second), np.array(rows))
    return np.array(kept, float).reshape(-1, 5)


def _exchanged(
    time_s: NDArray, owner: NDArray, used: NDArray, between: tuple[Mark, Mark], rows: NDArray
) -> list[list[float]]:
    """Return the doubts (subject, start, stop, other, probability) about when an exchange was.

    Two sightings say that one person is two subjects; it became the other in one of the doubts
    `rows` between them. The times from the first one to that where the person changes the subject,
    and from there to the last one, may be the other subject's.
    """
    before, after = between
    inside = (time_s >= before.time_s) & (time_s <= after.time_s)
    own_s = time_s[inside & (owner[before.person] == before.subject)]
    start_s, stop_s, odds = _apart(rows)
    at = int(np.abs((start_s + stop_s) / 2 - own_s.max(initial=before.time_s)).argmin())
    share, found = odds / odds.sum(), []
    for one, other, part, chance in (
        (before, after, slice(at + 1), share[:at].sum()),
        (after, before, slice(at, None), share[at + 1 :].sum()),
    ):
        span_s = start_s[part][0], stop_s[part][-1]
        there = (time_s >= span_s[0]) & (time_s <= span_s[1])
        if chance and (used[one.subject, there] == one.person).any():
            found.append([one.subject, *span_s, other.subject, 1 - chance])
    return found


def _apart(rows: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Return start, stop and odds of exchanges by doubts (D, 5); of those that overlap, of all."""
    rows = rows[np.argsort(rows[:, 1])]
    later = rows[1:, 1] > np.maximum.accumulate(rows[:-1, 2])
    first = np.flatnonzero(np.concatenate([[True], later]))
    odds = np.add.reduceat((1 - rows[:, 4]) / rows[:, 4], first)
    return rows[first, 1], np.maximum.reduceat(rows[:, 2], first), odds
