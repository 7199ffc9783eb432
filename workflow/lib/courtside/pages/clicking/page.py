"""The page on which a session's court points and racket ends are clicked."""

import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.court import line_edges
from courtside.calibration.court.court import Court
from courtside.pages import page
from courtside.study.errors import StrPath
from courtside.video import images

PARTS = "_table", "_fit", "_court", "_view", ""
SCRIPTS = ["keeping.js", "csv.js", *(f"clicking{part}.js" for part in PARTS)]
FRAME_KEYS = ("camera", "take", "frame_idx", "size", "clicks", "proposals")  # that scripts get
ENDS = {
    "top": "tip of the racket's head: the outermost point of its frame",
    "butt": "end of the handle: the middle of the butt cap",
}


@dataclass(frozen=True)
class Frame:
    """One picture to click in.

    `take` is None for the static picture, in which court points are clicked; else racket ends are.
    """

    camera: str
    size: tuple[int, int]  # width and height of the video and of the picture, px
    image: bytes  # PNG or JPEG
    mime: str = page.PNG
    take: str | None = None
    frame_idx: int = 0
    clicks: dict[str, Sequence[float]] = field(default_factory=dict)  # (x, y) px by point or end
    proposals: dict[str, dict] = field(default_factory=dict)  # by point: x, y, sigma_px; hollow

    @property
    def identity(self) -> str:
        """A name that no other picture of the page has."""
        if self.take is None:
            return f"static.{self.camera}"
        return f"{self.take}.{self.camera}.{self.frame_idx}"


def frame(
    camera: str,
    path: StrPath,
    *,
    clicks: dict | None = None,
    proposals: dict | None = None,
    **which: Any,
) -> Frame:
    """Read a picture to click in, a PNG or JPEG without recognisable faces, else `InputError`.

    `clicks` and `proposals` are as in `Frame`, `which` are `take` and `frame_idx` of a picture of a
    take.
    """
    path = Path(path)
    content = path.read_bytes() if path.is_file() else b""
    image = images.decode(path, content, what="a PNG or JPEG picture", advice="make it again")
    mime = page.PNG if content.startswith(b"\x89PNG") else "image/jpeg"
    size = image.shape[1::-1]
    return Frame(
        camera, size, content, mime, **which, clicks=clicks or {}, proposals=proposals or {}
    )


def by_point(xy: NDArray | None, points: Sequence[str]) -> dict[str, list[float]]:
    """Return clicks [x, y] by point, of an array (P, 2) of px that is NaN where not clicked."""
    if xy is None:
        return {}
    known = np.isfinite(xy).all(axis=1)
    return {point: xy[at].tolist() for at, point in enumerate(points) if known[at]}


def build(session: str, court: Court, frames: list[Frame], *, targets: dict[str, str]) -> str:
    """Return the page, to be written by `page.write`.

    `frames` are one picture of each fixed camera, then those of takes, in the order of their tabs;
    `ValueError` if there is none, or two of one camera and time. `targets` say where the workflow
    reads "court_points.csv" and "racket.csv", shown beside the save button.
    """
    names = [frame.identity for frame in frames]
    if not frames or len(set(names)) < len(names):
        raise ValueError(f"expected pictures of different cameras and times, found {names}")
    # What tells this page's clicks from those of other pages in one browser.
    about = [session, court.points, [[f.identity, list(f.size), f.clicks] for f in frames]]
    stamp = hashlib.sha256(json.dumps(about, default=lambda value: value.tolist()).encode())
    shown = {
        "session": session,
        "stamp": f"{session} {stamp.hexdigest()[:16]}",
        "court": _court(court),
        "ends": [{"name": name, "edges": words} for name, words in ENDS.items()],
        "frames": [
            {"id": frame.identity, **{key: getattr(frame, key) for key in FRAME_KEYS}}
            for frame in frames
        ],
        "targets": {name: targets.get(name, name) for name in ("court_points.csv", "racket.csv")},
    }
    return page.build(
        f"Court points: {session}",
        page.render("clicking.html", session=session),
        css=["clicking.css"],
        js=SCRIPTS,
        data={"clicking": shown},
        images={frame.identity: (frame.image, frame.mime) for frame in frames},
    )


def _court(court: Court) -> dict:
    edges = line_edges.named(court)
    points = [
        {
            "name": name,
            "xyz": court.xyz[at],
            "edges": court.edges[at],
            "marks": [{"axis": e.axis, "at_m": e.at_m, "side": e.side} for e in edges[at]],
            "on_post": line_edges.post(court, at) is not None,
        }
        for at, name in enumerate(court.points)
    ]
    keys = ("size_m", "line_width_m", "lines_m", "net")
    return {"points": points, **{key: getattr(court, key) for key in keys}}
