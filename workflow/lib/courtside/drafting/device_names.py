"""File names that cameras and recorders give: what in them is a camera, a moment, a counter.

Qualisys names take, camera and serial number; GoPro chapters and a counter; OBS and phones the
moment when a recording began, or a counter. Counters and moments name neither cameras nor takes.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime


@dataclass(frozen=True)
class DeviceName:
    """What a camera or a recorder has said in a file name."""

    before: str  # what stands before it: words of the user
    after: str = ""  # what stands behind it
    mark: str = ""  # the counter or moment as it stands: no word of its own
    camera: str = ""  # the camera, where the name says it
    serial: str = ""  # of the camera
    chapter: int = 1  # of a recording that the camera cut into several files
    begun: datetime | None = None  # on the device's own clock
    copy_of: str = ""  # the mark of the recording of which this is an edited copy


DATE = r"(?P<y>20\d\d)(?P<mo>[01]\d)(?P<d>[0-3]\d)"
TIME = r"(?P<h>[0-2]\d)_?(?P<mi>[0-5]\d)_?(?P<s>[0-5]\d)"
EDGE, END = r"(?<![A-Za-z0-9])", r"(?![A-Za-z0-9])"


def _qualisys(found: re.Match) -> dict:
    return {"camera": f"{found['model']}{found['n']}".lower(), "serial": found["serial"]}


def _gopro(found: re.Match) -> dict:
    return {"chapter": int(found["chapter"])}


def _moment(found: re.Match) -> dict:
    try:
        begun = datetime.strptime(
            "".join(found[key] for key in ("y", "mo", "d", "h", "mi", "s")), "%Y%m%d%H%M%S"
        )
    except ValueError:
        return {}
    return {"begun": begun}


def _nothing(_: re.Match) -> dict:
    return {}


FORMS: tuple[tuple[re.Pattern, Callable[[re.Match], dict]], ...] = (
    (
        re.compile(
            rf"{EDGE}(?P<model>Miqus|Oqus|Arqus)_(?P<n>\d+)_(?P<serial>\d+){END}", re.IGNORECASE
        ),
        _qualisys,
    ),
    (re.compile(rf"{EDGE}G[HXL](?P<chapter>\d\d)\d{{4}}{END}", re.IGNORECASE), _gopro),
    (re.compile(rf"{EDGE}GOPR\d{{4}}{END}", re.IGNORECASE), _nothing),
    (  # later chapters of GOPRnnnn
        re.compile(rf"{EDGE}GP(?P<chapter>0[1-9]|[1-9]\d)\d{{4}}{END}", re.IGNORECASE),
        lambda found: {"chapter": int(found["chapter"]) + 1},
    ),
    (
        re.compile(
            rf"{EDGE}(?P<y>20\d\d)-(?P<mo>[01]\d)-(?P<d>[0-3]\d)[ _T]"
            rf"(?P<h>[0-2]\d)[-.](?P<mi>[0-5]\d)[-.](?P<s>[0-5]\d){END}"
        ),
        _moment,
    ),
    (
        re.compile(
            rf"{EDGE}(?:(?:VID|PXL|MVIMG|IMG|WIN|DJI)_)?{DATE}_?{TIME}"
            rf"(?:\d{{3}}|_Pro|_\d{{4}}(?:_[A-Z])?)?{END}"
        ),
        _moment,
    ),
    (  # of WhatsApp: when it was sent
        re.compile(rf"{EDGE}(?:VID-\d{{8}}-WA\d{{4}}|WhatsApp Video [\d-]+ at [\d.]+){END}"),
        _nothing,
    ),
    (  # of an iPhone, beside the recording itself
        re.compile(rf"{EDGE}IMG_E(?P<n>\d{{4}}){END}", re.IGNORECASE),
        lambda found: {"copy_of": f"img_{found['n']}"},
    ),
    (
        re.compile(rf"{EDGE}(?:IMG|MVI|DSC|DSCN|DSCF|MOV|DJI)_?\d{{4,5}}{END}", re.IGNORECASE),
        _nothing,
    ),
    (re.compile(rf"{EDGE}P1\d{{6}}{END}"), _nothing),  # Panasonic
    (re.compile(rf"{EDGE}C\d{{4}}{END}", re.IGNORECASE), _nothing),  # Sony
)


def read(stem: str) -> DeviceName | None:
    """Read the name of a file without its suffix; None where no device has named it."""
    for pattern, said in FORMS:
        if found := pattern.search(stem):
            more = said(found)
            mark = "" if "camera" in more else found[0].lower()
            return DeviceName(stem[: found.start()], stem[found.end() :], mark, **more)
    return None
