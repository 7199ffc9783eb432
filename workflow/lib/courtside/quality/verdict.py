"""Verdicts: good, doubtful or failed for each camera, each person and the take, in plain words."""

from collections.abc import Mapping
from itertools import chain
from typing import NamedTuple

import pandas as pd

from courtside.kinematics.filtering import runs
from courtside.quality import causes, measures
from courtside.quality.calibration_doubts import Doubts
from courtside.quality.seen import Seen, disagreement, shown, without
from courtside.reconstruction.association import associate
from courtside.study.execution.verdicts import (
    ALL,
    COLUMNS,
    DOUBTFUL,
    FAILED,
    GOOD,
    ORDER,
    WHOLE,
    WRONG_CAMERA,
)

AGREES = "it agrees with the other cameras"
ANY = "another of the cameras that disagree may be the wrong one"
NONE = Doubts()

AGREED = 0.02  # heights: usual takes have a disagreement of 0.007 to 0.012


class Limit(NamedTuple):
    """The limits from which a value is doubtful and failed, and its description in words."""

    doubtful: float
    failed: float
    words: str  # with `{}` for the value
    about: str  # what the value tells, behind "nothing is known of"
    falling: bool = True  # whether low values are the bad ones


def _share(doubtful: float, failed: float, words: str) -> Limit:
    """Return the limits of a share, "90% of ..." or "how many of ..."; low ones are bad."""
    return Limit(doubtful, failed, "{:.0%} " + words, f"how many {words}")


# ASSUME: chosen on the takes of the virtual sessions and walk-4cams, whose errors are known. With
# their usual network, cameras find and follow persons in 0.98 to 1 of the frames, 0.69 to 1 of
# their keypoints are used, and these are 0.012 to 0.031 of a height off; 0.96 to 1 of the joints
# rest on two views, 0.6 to 0.92 on three, all 0.007 to 0.01 off; limbs vary by 0.025 to 0.046.
# Failed is where less than half is right.
OF_CAMERA = {
    "found": _share(0.9, 0.5, "of the persons who should be in its picture were found"),
    "followed": _share(0.9, 0.5, "of the persons who should be in its picture are followed"),
    "accepted": _share(0.65, 0.35, "of its keypoints of limbs agree with the other cameras"),
    "reprojection": Limit(
        0.035,
        0.1,
        "its keypoints are {:.3f} of a person's height from the other cameras'",
        "how far its keypoints are from the other cameras'",
        falling=False,
    ),
}
OF_PERSON = {
    "views_2": _share(0.9, 0.5, "of the joints rest on two cameras or more"),
    "views_3": _share(0.5, 0.0, "of the joints rest on three cameras or more"),
    "accepted": _share(0.75, 0.4, "of the keypoints of limbs agree with each other"),
    "reprojection": Limit(
        0.02,
        0.06,
        "keypoints are {:.3f} of a person's height from the joints",
        "how far keypoints are from the joints",
        falling=False,
    ),
    "limb_length": Limit(
        0.09,
        0.25,
        "the lengths of limbs vary by {:.0%}",
        "how much the lengths of limbs vary",
        falling=False,
    ),
}


def level(limit: Limit, value: float) -> str:
    """Return the verdict on a value; an unknown one is `FAILED`: nothing was measured."""
    sign = 1 if limit.falling else -1
    if not sign * value >= sign * limit.failed:
        return FAILED
    return GOOD if sign * value >= sign * limit.doubtful else DOUBTFUL


def worst(verdicts: list[str]) -> str:
    """Return the worst of some verdicts; `GOOD` of none."""
    return max(verdicts, key=ORDER.index, default=GOOD)


def judge(seen: Seen, doubts: Doubts = NONE) -> pd.DataFrame:
    """Judge a take: a row for each measure of each camera and person, and for each as a whole.

    Columns `COLUMNS`. A row with the measure `WHOLE` has the verdict, the likelier cause where it
    is not good, and one sentence; that with `ALL` cameras and persons is the take's. A take failed
    if a person failed in it, or half of its cameras; another camera that is not good makes it
    doubtful, and so do `doubts` about its calibration, the `clock_doubts` of what was `seen`, and
    more people than can be followed.
    """
    each = zip(_cameras(seen, doubts), seen.clock_doubts, strict=True)
    by_camera = [_by_clock(_doubted(rows, doubts), doubt) for rows, doubt in each]
    by_person = [_person(seen, at) for at in range(len(seen.points.person_id))]
    take = _take([rows[0] for rows in by_camera], [rows[0] for rows in by_person], doubts)
    if crowd := _crowd(seen):
        take = _crowded(take, crowd)
    return pd.DataFrame([take, *chain(*by_camera, *by_person)], columns=COLUMNS)


def _crowd(seen: Seen) -> str:
    at_once = [int(shown(rows).sum(axis=0).max(initial=0)) for rows in seen.rows]
    names = [camera.name for camera in seen.cameras]
    return associate.crowd(dict(zip(names, at_once, strict=True)))


def _crowded(take: dict, crowd: str) -> dict:
    """Return the row of a take in which more people were found than can be followed."""
    good = take["verdict"] == GOOD
    found = {"verdict": DOUBTFUL, "cause": causes.IDENTITY} if good else {}
    sentence = f"{take['sentence']} More people than can be followed: {crowd}."
    return {**take, **found, "sentence": sentence}


def _doubted(rows: list[dict], doubts: Doubts) -> list[dict]:
    """Return the rows of a camera; one that agrees is doubtful if its calibration is doubted."""
    whole, *others = rows
    if not (said := doubts.of(whole["camera"])) or whole["verdict"] != GOOD:
        return rows
    sentence = f"{whole['sentence'].removesuffix('.')}, but {said}."
    return [_whole(whole["camera"], ALL, DOUBTFUL, causes.CALIBRATION, sentence), *others]


def _by_clock(rows: list[dict], doubt: str) -> list[dict]:
    """Return the rows of a camera whose clock its synchronisation doubts; the same without a doubt.

    It is doubtful at best, and the clock is the cause unless another that spoils measures is known.
    """
    whole, *others = rows
    if not doubt:
        return rows
    verdict, cause = worst([whole["verdict"], DOUBTFUL]), whole["cause"]
    cause = cause if cause in WRONG_CAMERA else causes.CLOCK
    sentence = f"{whole['sentence'].removesuffix('.')}; its clock is in doubt: {doubt}."
    return [_whole(whole["camera"], ALL, verdict, cause, sentence), *others]


def _cameras(seen: Seen, doubts: Doubts) -> list[list[dict]]:
    """Return the rows of each camera, that of the whole first.

    A wrong camera shifts the joints that the other cameras are compared with. If the others agree
    without it, or painted lines say that it is the wrong one, it is left out and the others are
    judged again.
    """
    fixed: dict[int, list[dict]] = {}
    while True:
        others = [at for at in range(len(seen.cameras)) if at not in fixed]
        fewer = bool(fixed) or not all(seen.followed[at].any() for at in others)
        agreed = fewer and disagreement(seen, others) <= AGREED
        judged = {at: _camera(seen, at, agreed, doubts) for at in others}
        suspects = _suspects(seen, others, doubts)
        odd = next((at for at in suspects if judged[at][0]["verdict"] != GOOD), None)
        if odd is None:
            rows = fixed | _uncertain(judged, doubts)
            return [rows[at] for at in range(len(seen.cameras))]
        fixed[odd] = judged[odd]
        seen = without(seen, (*seen.out, odd))


def _uncertain(judged: dict[int, list[dict]], doubts: Doubts) -> dict[int, list[dict]]:
    """Mark cameras that contradict one another: any of them may be the wrong one.

    Not where the check of a calibration file names the wrong ones.
    """
    wrong = [
        at
        for at, (whole, *rows) in judged.items()
        if whole["verdict"] != GOOD
        and not doubts.of(whole["camera"])
        and (
            whole["cause"] == causes.CLOCK
            or any(row["measure"] == "reprojection" and row["verdict"] != GOOD for row in rows)
        )
    ]
    if len(wrong) < 2 or doubts.by_check:
        return judged
    found = dict(judged)
    for at in wrong:
        whole, *rows = judged[at]
        poor = whole["cause"] == causes.DETECTION
        cause = causes.UNKNOWN if poor else whole["cause"]
        sentence = whole["sentence"].removesuffix(".")
        found[at] = [{**whole, "cause": cause, "sentence": f"{sentence}; {ANY}."}, *rows]
    return found


def _suspects(seen: Seen, others: list[int], doubts: Doubts) -> list[int]:
    """Return the cameras that may be the wrong one.

    First that without which the others agree far better, then those that painted lines speak
    against. Of two cameras none is suspected.
    """
    if len(others) < 3:
        return []
    named = [at for at in others if seen.cameras[at].name in doubts.by_lines]
    rest = {
        at: disagreement(seen, [one for one in others if one != at])
        for at in others
        if seen.followed[at].any()
    }
    ranked = sorted((value, at) for at, value in rest.items() if value == value)
    if len(ranked) < 3 or ranked[0][0] > causes.NEARER * ranked[1][0]:
        return named
    return [ranked[0][1], *named]


def _judged(
    found: Mapping[str, float], limits: Mapping[str, Limit], camera: str, person: str
) -> list[dict]:
    return [
        {
            "camera": camera,
            "person": person,
            "measure": name,
            "value": found[name],
            "doubtful_from": limits[name].doubtful,
            "failed_from": limits[name].failed,
            "verdict": level(limits[name], found[name]),
            "cause": "",
            "sentence": _sentence(limits[name], found[name]),
        }
        for name in limits
        if name in found
    ]


def _sentence(limit: Limit, value: float) -> str:
    known = value == value
    text = limit.words.format(value) if known else f"nothing is known of {limit.about}"
    return text[:1].upper() + text[1:] + "."


def _whole(camera: str, person: str, verdict: str, cause: str, sentence: str) -> dict:
    empty = dict.fromkeys(("value", "doubtful_from", "failed_from"), float("nan"))
    about = {"camera": camera, "person": person, "measure": WHOLE, **empty}
    return {**about, "verdict": verdict, "cause": cause, "sentence": sentence}


def _camera(seen: Seen, at: int, agreed: bool, doubts: Doubts) -> list[dict]:
    """Judge a camera: its rows, that of the whole first.

    `agreed`: all cameras agree except those that are left out or track nobody. The errors are then
    due to those cameras, or to joints triangulated by two cameras that face each other.
    """
    name = seen.cameras[at].name
    if not seen.expected(at).any() and not shown(seen.rows[at][:, seen.at]).any():
        sentence = f"Camera {name}: nobody should be in its picture, and nobody was found."
        return [_whole(name, ALL, GOOD, "", sentence)]
    found = measures.of_camera(seen, at)
    if found["followed"] == 0:  # what is not followed has no keypoints to be judged
        found = {key: found[key] for key in ("found", "followed")}
    rows = _judged(found, OF_CAMERA, name, ALL)
    # Keypoints are not accepted where a camera that is left out moved the joints.
    theirs = ("accepted", "reprojection") if agreed else ("accepted",) if seen.out else ()
    counted = [row for row in rows if row["measure"] not in theirs]
    verdict = worst([row["verdict"] for row in counted])
    if verdict == GOOD and (late := causes.late(seen, at)):
        return [_whole(name, ALL, DOUBTFUL, late.name, f"Camera {name}: {late.sentence}."), *rows]
    if verdict == GOOD:
        return [_whole(name, ALL, GOOD, "", f"Camera {name}: {AGREES}."), *rows]
    limit, others = OF_CAMERA["found"].doubtful, bool(doubts.by_check)
    why = causes.find(seen, at, found_limit=limit, doubt=doubts.of(name), others=others)
    if why.sentence == causes.UNCHECKED:  # so its distance from the others' joints says little
        rest = [row["verdict"] for row in counted if row["measure"] != "reprojection"]
        verdict = worst([DOUBTFUL, *rest])
    return [_whole(name, ALL, verdict, why.name, f"Camera {name}: {why.sentence}."), *rows]


def _person(seen: Seen, at: int) -> list[dict]:
    """Judge a person over all cameras: the rows, that of the whole first."""
    name = str(seen.points.person_id[at])
    found = measures.of_person(seen, at)
    if len(seen.cameras) < 3:  # by design no joint rests on three
        del found["views_3"]
    if found["views_2"] == 0:
        found = {"views_2": 0.0}
    judged = _judged(found, OF_PERSON, ALL, name)
    verdict = worst([row["verdict"] for row in judged])
    bad = [row["sentence"] for row in judged if row["verdict"] == verdict != GOOD]
    sentence = bad[0] if bad else f"The cameras agree{_when(seen, at)}."
    whole = _whole(ALL, name, verdict, "", f"{name}: {sentence[:1].lower()}{sentence[1:]}")
    return [whole, *judged]


def _when(seen: Seen, at: int) -> str:
    """Return between which times a person is judged; empty: in the whole take."""
    present, time_s = seen.present[at], seen.points.time_s
    parts = [f"{time_s[a]:.1f} to {time_s[b - 1]:.1f} s" for a, b in runs(present)]
    return "" if present.all() else f" from {' and '.join(parts)} of the take"


def _together(rows: list[dict]) -> list[str]:
    """Return the sentences on cameras, each once, with the cameras that share it."""
    names: dict[str, list[str]] = {}
    for row in rows:
        sentence = row["sentence"].removeprefix(f"Camera {row['camera']}: ")
        names.setdefault(sentence, []).append(row["camera"])
    return [
        f"Camera{'s' if len(of) > 1 else ''} {', '.join(of)}: {sentence}"
        for sentence, of in names.items()
    ]


def _take(cameras: list[dict], persons: list[dict], doubts: Doubts) -> dict:
    failed = [row for row in cameras if row["verdict"] == FAILED]
    verdict = worst([row["verdict"] for row in persons])
    if 2 * len(failed) >= len(cameras):
        verdict = FAILED
    if verdict == GOOD and (doubts.shared or any(row["verdict"] != GOOD for row in cameras)):
        verdict = DOUBTFUL
    if verdict == GOOD:
        return _whole(ALL, ALL, GOOD, "", "The cameras agree on every person.")
    bad = [row for row in cameras if row["verdict"] != GOOD]
    named = sorted(bad, key=lambda row: -ORDER.index(row["verdict"]))
    parts = [row["sentence"] for row in persons if row["verdict"] != GOOD]
    parts += _together(named)
    parts += [f"The calibration is in doubt: {'; '.join(doubts.shared)}."] * bool(doubts.shared)
    known = [row["cause"] for row in named if row["cause"] != causes.UNKNOWN]
    known += [causes.CALIBRATION] * bool(doubts.shared)
    # However many cameras have another fault, a wrong one spoils whatever is measured.
    measured = any(row["verdict"] != FAILED for row in persons)
    wrong = [cause for cause in known if measured and cause in WRONG_CAMERA] or known
    cause = max(wrong, key=wrong.count, default=causes.UNKNOWN)
    return _whole(ALL, ALL, verdict, cause, " ".join(parts))
