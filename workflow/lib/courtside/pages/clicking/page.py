"""A page on which a session's court points, and ends of rackets, are clicked."""

import hashlib
import json
from dataclasses import dataclass, field
from pathlib import Path

import cv2
import numpy as np

from courtside.calibration.court import line_edges
from courtside.pages import page
from courtside.video import images

SCRIPTS = (
    "clicking_table.js",
    "clicking_fit.js",
    "clicking_court.js",
    "clicking_view.js",
    "clicking.js",
)
ENDS = {
    "top": "tip of the racket's head: the outermost point of its frame",
    "butt": "end of the handle: the middle of the butt cap",
}


@dataclass(frozen=True)
class Frame:
    """One picture to click in.

    Attributes
    ----------
    camera : str
    size : (int, int)
        Width and height of the video, which is that of the picture, px.
    image : bytes
        PNG or JPEG of that size.
    mime : str
    take : str or None
        None for the static picture, in which court points are clicked; else ends of a racket.
    frame_idx : int
    clicks : dict of str to (x, y)
        Earlier clicks by point or end, px.
    proposals : dict of str to dict
        By point: `x`, `y` and `sigma_px`; shown hollow, to be confirmed.
    """

    camera: str
    size: tuple
    image: bytes
    mime: str = page.PNG
    take: str | None = None
    frame_idx: int = 0
    clicks: dict = field(default_factory=dict)
    proposals: dict = field(default_factory=dict)

    @property
    def identity(self):
        """A name that no other picture of the page has."""
        return (
            f"static.{self.camera}"
            if self.take is None
            else f"{self.take}.{self.camera}.{self.frame_idx}"
        )


def frame(camera, path, *, jpeg_quality=None, clicks=None, proposals=None, **which):
    """Read a picture to click in.

    Parameters
    ----------
    camera : str
    path : str or Path
        PNG or JPEG, without faces that can be recognised.
    jpeg_quality : int or None
        1 to 100 to make the page smaller; None to take the file as it is.
    clicks, proposals : dict, optional
        As `Frame` has them.
    **which
        `take` and `frame_idx` of a picture of a take.

    Returns
    -------
    frame : Frame

    Raises
    ------
    InputError
        If the file is no picture.
    """
    path = Path(path)
    content = path.read_bytes() if path.is_file() else b""
    image = images.decode(path, content, what="a PNG or JPEG picture", advice="make it again")
    mime = page.PNG if content.startswith(b"\x89PNG") else "image/jpeg"
    if jpeg_quality is not None:
        content = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, jpeg_quality])[1].tobytes()
        mime = "image/jpeg"
    marks = {"clicks": clicks or {}, "proposals": proposals or {}}
    return Frame(camera, image.shape[1::-1], content, mime, **which, **marks)


def by_point(xy, points):
    """Return clicks by point.

    Parameters
    ----------
    xy : (P, 2) float or None
        Px; NaN where not clicked.
    points : sequence of str, length P

    Returns
    -------
    clicks : dict of str to [x, y]
    """
    if xy is None:
        return {}
    known = np.isfinite(xy).all(axis=1)
    return {point: xy[at].tolist() for at, point in enumerate(points) if known[at]}


def build(session, court, frames, *, targets):
    """Make the page.

    Parameters
    ----------
    session : str
        Shown as the title.
    court : courtside.calibration.court.court.Court
    frames : list of Frame
        One picture of each fixed camera, then those of takes, in the order of their tabs.
    targets : dict of str to str
        Where the workflow reads "court_points.csv" and "racket.csv"; told beside the button that saves.

    Returns
    -------
    page : str
        For `page.write`.

    Raises
    ------
    ValueError
        If there is no picture, or two of one camera and time.
    """
    names = [frame.identity for frame in frames]
    if not frames or len(set(names)) < len(names):
        raise ValueError(f"expected pictures of different cameras and times, found {names}")
    shown = {
        "session": session,
        "stamp": _stamp(session, court, frames),
        "court": _court(court),
        "ends": [{"name": name, "edges": words} for name, words in ENDS.items()],
        "frames": [_frame(frame) for frame in frames],
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


def _frame(frame):
    return {
        "id": frame.identity,
        "camera": frame.camera,
        "take": frame.take,
        "frame_idx": frame.frame_idx,
        "size": frame.size,
        "clicks": frame.clicks,
        "proposals": frame.proposals,
    }


def _court(court):
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


def _stamp(session, court, frames):
    """Return what distinguishes this page's clicks from those of others that one browser keeps."""
    about = [session, court.points, [[f.identity, list(f.size), f.clicks] for f in frames]]
    text = json.dumps(about, default=lambda value: value.tolist())
    return f"{session} {hashlib.sha256(text.encode()).hexdigest()[:16]}"
