"""How many persons each detector finds, in recorded pictures and in virtual ones.

    python benchmarks/find_persons.py RESULTS --models FOLDER [--demo DEMO] [--hall DATA]
        [--session crowd-dev] [--every 8] [--min_score 0.3]

RESULTS is of a run with BlazePose's detector and the `--session`; FOLDER has `yolox_nano.onnx` and
`rtmdet_nano_person.onnx` (those that are missing are left out). DEMO is Pose2Sim's demonstration,
whose person OpenPose's keypoints show; DATA is the recording of `hall_markers.py`, whose player
joints set by hand show; the truth shows the virtual ones. A person of 80 px or more counts as found
if a region lies on it: centres apart by less than a quarter of its height, size right within a
factor of 1.7. `whole`: the detector looks at the whole picture; `tiles`: as the study does where it
follows nobody. With all scenes, all detectors and the default settings it writes
docs/numbers/find_persons.csv, a source of docs/make_tables.py.
"""

import argparse
import json
import sys
from pathlib import Path

import cv2
import numpy as np
import pandas as pd

import hall_markers
import stated
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))

from courtside.geometry import camera as camera_models
from courtside.pose import open_network, tiles
from courtside.pose.detector import SIDE_OF_BOX, Region
from courtside.records.truth import session_truth, take_truth

TABLE, OUTPUT = "persons-found", ROOT / stated.FOLDER / "find_persons.csv"
COMMAND = "`python benchmarks/find_persons.py`"  # its arguments stand in benchmarks/README.md
MIN_HEIGHT_PX, NEAR, FACTOR, SURE = 80, 0.25, 1.7, 0.3
OWN = {  # as config/README.md, "Your own network", declares them
    "yolox_nano": {"decoder": "yolox", "input": {"size": [416, 416], "channels": "bgr"}},
    "rtmdet_nano_person": {
        "decoder": "end-to-end",
        "input": {
            "size": [320, 320],
            "channels": "bgr",
            "mean": [103.53, 116.28, 123.675],
            "std": [57.375, 57.12, 58.395],
        },
    },
}


def detectors(results, folder, min_score):
    """Return the detectors by name; `min_score` is that of the user's own."""
    found = {}
    for path in sorted((results / "networks").glob("*/detector.onnx"))[:1]:
        found["blazepose-detector"] = open_network.person_detector(path, decoder="blazepose")
    for name, how in OWN.items():
        if (path := folder / f"{name}.onnx").is_file():
            found[name] = open_network.person_detector(path, min_score=min_score, **how)
    return found


def pictures(video, every):
    """Yield number and picture of some frames of a video."""
    capture, at = cv2.VideoCapture(str(video)), 0
    while capture.grab():
        if at % every == 0:
            yield at, capture.retrieve()[1]
        at += 1


def walked(demo, every):
    """Yield pictures of the demonstration and the joints (K, 2) px of their person."""
    for camera in range(1, 5):
        files = sorted((demo / "openpose_body25b" / f"cam{camera}_json").glob("*.json"))
        for at, picture in pictures(demo / "videos" / f"cam0{camera}.mp4", every):
            for person in json.loads(files[at].read_text())["people"][:1]:
                points = np.reshape(person["pose_keypoints_2d"], (-1, 3))
                yield picture, [points[points[:, 2] > SURE, :2]]


def played(data, every):
    """Yield pictures of the hall and the joints of its player."""
    table = pd.read_csv(data / "annotations.csv").groupby(["camera", "frame_idx"])
    for camera in hall_markers.CAMERAS:
        for at, picture in pictures(data / f"{camera}.mp4", every):
            yield picture, [table.get_group((camera, at))[["x_px", "y_px"]].to_numpy()]


def simulated(results, session, every):
    """Yield pictures of a virtual session and the joints of the persons who are whole in them."""
    folder = results / "virtual" / session
    cameras = session_truth.read(folder / "truth.npz").cameras
    for truth_npz in sorted(folder.glob("takes/*/truth.npz")):
        truth = take_truth.read(truth_npz)
        for camera in cameras:
            for at, picture in pictures(truth_npz.with_name(f"{camera.name}.mp4"), every):
                xy = camera_models.project(camera, truth.xyz[:, min(at, len(truth.time_s) - 1)])
                whole = ((xy > 0) & (xy < camera.size)).all(axis=(1, 2))
                yield picture, list(xy[whole])


def shows(region, joints):
    """Return whether a region shows the person with these joints (K, 2) px."""
    low, high = joints.min(axis=0), joints.max(axis=0)
    apart = np.abs(np.array([region.x, region.y]) - (low + high) / 2).max()
    size = max(region.box) if region.box else region.side / SIDE_OF_BOX
    height = (high - low).max()
    return apart < NEAR * height and height / FACTOR < size < FACTOR * height


def counted(scene, found):
    """Return {(detector, way): (persons found, regions elsewhere)} and the numbers of both kinds.

    `scene` yields pictures with the joints of their persons, `found` has the detectors.
    """
    counts = {(name, way): np.zeros(2, int) for name in found for way in ("whole", "tiles")}
    n_pictures = n_persons = 0
    for picture, everybody in scene:
        tall = [one for one in everybody if np.ptp(one, axis=0).max() >= MIN_HEIGHT_PX]
        n_pictures, n_persons = n_pictures + 1, n_persons + len(tall)
        height, width = picture.shape[:2]
        ways = {"whole": [Region(width / 2, height / 2, max(width, height))]}
        ways["tiles"] = tiles.tiles(width, height)
        for (name, way), count in counts.items():
            regions = tiles.search(picture, ways[way], found[name])
            count[0] += sum(any(shows(one, person) for one in regions) for person in tall)
            count[1] += sum(not any(shows(one, who) for who in everybody) for one in regions)
    return counts, n_pictures, n_persons


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("--models", type=Path, required=True)
    parser.add_argument("--demo", type=Path, help="Pose2Sim's demonstration with OpenPose's JSON")
    parser.add_argument("--hall", type=Path, help="the recording mocap_8")
    parser.add_argument("--session", nargs="*", default=[], help="virtual, of the results")
    parser.add_argument("--every", type=int, default=8, help="of the recorded frames, and x5")
    parser.add_argument("--min_score", type=float, default=0.3)
    given = parser.parse_args()
    found = detectors(given.results, given.models, given.min_score)
    scenes = {
        f"virtual, `{s}`": simulated(given.results, s, 5 * given.every) for s in given.session
    }
    if given.demo:
        scenes["real, `walk-4cams`, person of OpenPose"] = walked(given.demo, given.every)
    if given.hall:
        scenes["real, sports hall, player with joints set by hand"] = played(
            given.hall, given.every
        )
    rows = []
    for words, scene in scenes.items():
        counts, n_pictures, n_persons = counted(scene, found)
        for (name, way), (hits, others) in counts.items():
            about = [TABLE, f"{words}; `{name}`"]
            rest = ["", n_persons, n_persons - hits, "benchmark", COMMAND]
            share, more = f"{100 * hits / n_persons:.1f}", f"{others / n_pictures:.1f}"
            rows.append([*about, way, share, "%", *rest])
            print(f"{words}; {name}, {way}: {hits} of {n_persons}, {share} %; others {more}")
    usual = all(getattr(given, key) == parser.get_default(key) for key in ("every", "min_score"))
    if usual and given.demo and given.hall and given.session and set(OWN) < set(found):
        stated.write(OUTPUT, rows)


if __name__ == "__main__":
    main()
