"""The page of a session for quality: each take and camera with verdict, reason and a picture."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from courtside.pages import page
from courtside.pages.report import facts, warnings
from courtside.pose import privacy, stick_drawing
from courtside.records.keypoints.keypoints import Keypoints2D
from courtside.records.keypoints.people import People
from courtside.records.keypoints.skeleton import Skeleton
from courtside.study.errors import StrPath
from courtside.study.execution.verdicts import ALL, ORDER, WAY, WHOLE
from courtside.video import reader

BOX_PX = (320, 240)  # ASSUME: enough to see what a camera saw; 10 kB
QUALITY = 80  # of JPEG
JPEG = "image/jpeg"
HALF = 0.5  # of the joints: fewer do not show a person
PERSONS, OTHERS = (0, 200, 255), (200, 120, 0)  # BGR of joints: yellow, blue


class Line(NamedTuple):
    """The page's entry for a camera, or for the take as a whole."""

    camera: str  # `ALL` for the take
    verdict: str
    reason: str
    others: tuple[str, ...]  # other verdicts, each with the way of measuring that got it


def lines(rows: Sequence[Mapping[str, str]]) -> list[Line]:
    """Return the lines of a take, its own first, from the rows of `verdicts.read`.

    Verdict and reason are of the first way of measuring that has the camera: the reported one.
    """
    found: dict[str, list[Mapping[str, str]]] = {ALL: []}
    for row in rows:
        if row["measure"] == WHOLE and row["person"] == ALL:
            found.setdefault(row["camera"], []).append(row)
    return [_line(camera, verdicts) for camera, verdicts in found.items() if verdicts]


def _line(camera: str, verdicts: Sequence[Mapping[str, str]]) -> Line:
    first, *rest = verdicts
    sentence = first["sentence"].removeprefix(f"Camera {camera}: ")
    others = [
        f"{row['verdict']} by {' '.join(row[key] for key in WAY)}"
        for row in rest
        if row["verdict"] != first["verdict"]
    ]
    return Line(camera, first["verdict"], sentence[:1].upper() + sentence[1:], tuple(others))


def thumbnail(view: Keypoints2D, people: People, video: StrPath, skeleton: Skeleton) -> bytes:
    """Return a small picture of a camera, JPEG, with the joints that its network found.

    It shows the frame with most persons of the take, of several the one nearest to the middle.
    Their faces, everybody else and the surroundings are made coarse.
    """
    own = people.assigned(view)
    frame, bones = shown_frame(own), skeleton.bone_indices()
    ((_, image),) = reader.read_frames(video, view.time_s[[frame]])
    persons, everybody = own.xy[:, frame], view.xy[:, frame]
    near = privacy.around(view.time_s, view.xy, frame)
    hidden = privacy.hide(image, persons, near, privacy.Body.of(skeleton))
    scale = min(most / length for most, length in zip(BOX_PX, image.shape[1::-1], strict=True))
    small = cv2.resize(hidden, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    for some, colour in ((everybody, OTHERS), (persons, PERSONS)):
        stick_drawing.draw(small, (some + 0.5) * scale - 0.5, bones, colour, 1, 0)
    return bytes(cv2.imencode(".jpg", small, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])[1])


def shown_frame(view: Keypoints2D) -> int:
    """Return the frame with most persons of half their joints, nearest to the middle."""
    seen: NDArray = np.isfinite(view.xy).all(axis=-1).mean(axis=-1) >= HALF
    n_seen = seen.sum(axis=0)
    best = np.flatnonzero(n_seen == n_seen.max())
    return int(best[np.abs(best - (len(n_seen) - 1) / 2).argmin()])


def build(
    session: str, takes: Sequence[Mapping[str, Any]], cameras: Mapping[str, Any] | None = None
) -> str:
    """Return the page, to be written by `page.write`.

    `cameras` has `calibration` (that of the verdicts), `others` (of the takes), `files` (of
    `facts.of_session`) and `limits` (of `warnings.of_session`). Each take has `name`, `lines`,
    `pictures` ({camera: JPEG}) and `left_out`: in words why there are no pictures, empty where
    there are.
    """
    pictures = {
        f"{at}.{camera}": (picture, JPEG)
        for at, take in enumerate(takes)
        for camera, picture in take["pictures"].items()
    }
    title = f"Quality of the takes: {session}"
    found, others = _of_cameras(**cameras) if cameras else (None, {})
    told = {"found": found, "others": others, "level": warnings.worst(found or [])}
    body = page.render("quality.html", title=title, takes=takes, all=ALL, order=ORDER, **told)
    return page.build(
        title, body, css=["report.css", "quality.css"], js=["report.js"], images=pictures
    )


def _of_cameras(
    calibration: str, others: Sequence[str], files: dict, limits: dict
) -> tuple[list[warnings.Warned], dict[str, list[warnings.Warned]]]:
    """Return the warnings of the session as the report has them, and of its other calibrations."""
    known = facts.of_session(files)
    more = {way: warnings.calibration(way, known["quality"][way]) for way in others}
    return warnings.of_session(known, calibration, **limits), more
