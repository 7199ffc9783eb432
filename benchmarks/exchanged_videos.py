"""How often exchanged videos are found by features of the hall, and how often falsely.

    python benchmarks/exchanged_videos.py RESULTS ... [--hall DATA]

All virtual sessions in the folders of results whose fixed cameras have static pictures are judged
with their true cameras: as they are; with each pair exchanged; of three cameras and more, all off
by one; and with one camera turned, moved or with another focal length, which is no exchange. DATA
is a folder of `hall-markers`: the first frames of its videos are judged, too.
"""

import argparse
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import cv2
import numpy as np
import pandas as pd
from numpy.typing import NDArray

from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.calibration.file_check import exchanged_videos
from courtside.geometry.camera import Camera, read_toml, turned
from courtside.records.truth import session_truth
from courtside.video import images, reader

N_WRONG = 60  # cameras of a session that are wrong otherwise


def main() -> None:
    """Print a row for each session, and their sum."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("results", nargs="+", type=Path)
    parser.add_argument("--hall", type=Path)
    given = parser.parse_args()
    rows = [row(*each) for folder in given.results for each in virtual(folder)]
    rows += [row(*real(given.hall))] if given.hall else []
    table = pd.DataFrame(rows).set_index("session")
    table.loc["all"] = table.sum()
    print(table.to_markdown())


def virtual(results: Path) -> Iterator[tuple[str, list[Camera], list[NDArray]]]:
    """Yield each session's name, true cameras and static pictures."""
    for truth_npz in sorted(results.glob("virtual/*/truth.npz")):
        name = truth_npz.parent.name
        static = results / name / "static"
        cameras = [
            camera
            for camera in session_truth.read(truth_npz).cameras
            if (static / f"{camera.name}.png").is_file()
        ]
        if len(cameras) > 1:
            paths = [static / f"{camera.name}.png" for camera in cameras]
            yield name, cameras, [images.read(path, cv2.IMREAD_GRAYSCALE) for path in paths]


def real(folder: Path) -> tuple[str, list[Camera], list[NDArray]]:
    """Return the same of a real hall, with the first frame of each video."""
    cameras = read_toml(folder / "calibration_refined.toml")
    cameras = [camera for camera in cameras if (folder / f"{camera.name}.mp4").is_file()]
    first = [next(reader.frames(folder / f"{camera.name}.mp4"))[1] for camera in cameras]
    return folder.name, cameras, [cv2.cvtColor(one, cv2.COLOR_BGR2GRAY) for one in first]


def row(name: str, cameras: Sequence[Camera], pictures: Sequence[NDArray]) -> dict[str, object]:
    """Judge a session's cameras in all ways."""
    matches, own = exchanged_videos.match(pictures), list(range(len(cameras)))
    pairs = list(combinations(own, 2))
    exchanged = [
        [other if k == one else one if k == other else k for k in own] for one, other in pairs
    ]
    off_by_one = [[*own[1:], own[0]]] if len(own) > 2 else []
    told = {
        what: [told_rightly(cameras, matches, order) for order in orders]
        for what, orders in (("exchanged", exchanged), ("off by one", off_by_one))
    }
    wrong = [exchanged_videos.judge(some, matches).warnings for some in otherwise_wrong(cameras)]
    return {
        "session": name,
        "cameras": len(cameras),
        "false alarms": len(exchanged_videos.judge(cameras, matches).warnings),
        **{key: n for what, each in told.items() for key, n in counts(what, each).items()},
        "wrong otherwise": len(wrong),
        "of these told as exchanged": sum(map(bool, wrong)),
    }


def counts(what: str, told: list[bool | None]) -> dict[str, int]:
    return {
        what: len(told),
        f"{what}: told rightly": told.count(True),
        f"{what}: told wrongly": told.count(False),
    }


def told_rightly(
    cameras: Sequence[Camera], matches: exchanged_videos.Matches, order: Sequence[int]
) -> bool | None:
    """Return whether cameras given in another order are told rightly; None if nothing is told."""
    given = [replace(cameras[k], name=own.name) for own, k in zip(cameras, order, strict=True)]
    found = exchanged_videos.judge(given, matches)
    if not found.warnings:
        return None
    true = {cameras[k].name: cameras[at].name for at, k in enumerate(order)}
    wrong = sorted(name for name, of in true.items() if of != name)
    return found.names == true or any(sorted(pair) == wrong for pair in found.also)


def otherwise_wrong(cameras: Sequence[Camera]) -> Iterator[list[Camera]]:
    """Yield the cameras with one that is turned, has another focal length, or was moved."""
    rng = np.random.default_rng(0)
    for k in range(N_WRONG):
        at, direction = rng.integers(len(cameras)), rng.normal(size=3)
        one = cameras[at]
        if k % 3 == 0:
            angle = np.deg2rad(rng.choice([0.5, 1, 2, 5, 20]))
            changed = turned(one, angle * direction / np.linalg.norm(direction))
        elif k % 3 == 1:
            factor = np.exp(0.2 * rng.normal())
            changed = replace(one, K=one.K * [[factor, 1, 1], [1, factor, 1], [1, 1, 1]])
        else:
            pose = one.cam_from_world.copy()
            pose[:, 3] += direction * rng.choice([0.05, 0.5, 3])
            changed = replace(one, cam_from_world=pose)
        yield [*cameras[:at], changed, *cameras[at + 1 :]]


if __name__ == "__main__":
    main()
