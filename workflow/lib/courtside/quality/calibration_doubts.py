"""What is said against the cameras of a take: by their calibration itself, and by checks of a file.

Cameras may agree on everybody and be wrong all the same: all of them, or by less than people show.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from courtside.study.errors import StrPath
from courtside.study.execution.files import read_json


@dataclass(frozen=True)
class Doubts:
    """What is said against cameras; nothing by default."""

    by_lines: Mapping[str, str] = field(default_factory=dict)  # by camera, after "it": a court's
    by_check: Mapping[str, str] = field(default_factory=dict)  # by camera: faults of the file
    shared: tuple[str, ...] = ()  # against no single camera

    def of(self, camera: str) -> str:
        """Return what is wrong with a camera's calibration, as a clause; empty if nothing is."""
        said = [f"it {self.by_lines[camera]}"] if camera in self.by_lines else []
        if camera in self.by_check:
            said.append(f"by the check of the calibration file {self.by_check[camera]}")
        return ", and ".join(said)


def read(quality_json: StrPath, check_json: StrPath = "", court_json: StrPath = "") -> Doubts:
    """Read the warnings of a calibration, and what checks of its file say, if there are any."""
    shared = list(read_json(quality_json).get("warnings", ()))
    check = read_json(check_json) if check_json else {}
    court = read_json(court_json) if court_json else {}
    faults = check.get("faults", ())
    shared += check.get("shared", ()) if faults else check.get("warnings", ())
    shared += court.get("shared", ())
    return Doubts(court.get("cameras", {}), _by_camera(faults), tuple(shared))


def _by_camera(faults: list[dict[str, Any]]) -> dict[str, str]:
    found: dict[str, list[str]] = {}
    for fault in faults:
        for name in fault["cameras"]:
            found.setdefault(name, []).append(fault["what"])
    return {name: " and ".join(words) for name, words in found.items()}
