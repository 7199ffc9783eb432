"""Networks on the same frames: recorded pictures beside virtual ones, and processor time.

    python benchmarks/networks.py RESULTS [--demo DEMO] [--hall DATA] [--study FOLDER]

RESULTS is of a default run, with figures/networks.table.csv. DEMO is Pose2Sim's demonstration with
OpenPose's keypoints in `openpose_body25b/cam1_json` to `cam4_json`; DATA is the recording of
`hall_markers.py`, with joints set by hand in `annotations.csv`. With these the script writes a
study into FOLDER (by default a temporary one), in which each network is compared with them on the
road that `evaluate_networks` has for recorded takes. Times are of the landmark stage, one person,
one thread, all networks in turn on each picture; the least of the pictures counts. It writes
docs/numbers/networks.csv, a source of docs/make_tables.py, which takes virtual takes from RESULTS;
what was not measured again stays.
"""

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np
import pandas as pd
import yaml

import hall_markers
import marker_system
import stated
from many_sessions import copied
from real_footage import LATER
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))

from courtside.evaluation.numbers import networks as numbers
from courtside.evaluation.numbers import register
from courtside.pose import open_network
from courtside.records.keypoints import skeleton
from courtside.study import paths
from courtside.study.configuration import sessions, yaml_files

OUTPUT = ROOT / stated.FOLDER / "networks.csv"
COMMAND = "`python benchmarks/networks.py results --demo DEMO --hall DATA`"
WALK, HALL = "walk-4cams", "hall-markers"
WORDS = {
    (WALK, "body25b"): "real, `walk-4cams`, against OpenPose (no truth)",
    (HALL, "body25"): "real, sports hall, against joints set by hand",
}
N_PICTURES, VIDEO = 20, "external/pose2sim/Pose2Sim/Demo_SinglePerson/videos/cam03.mp4"
HAND = {f"{side}_shoulder": f"{side[0].upper()}Shoulder" for side in ("left", "right")}


def write_json(data, folder):
    """Write joints set by hand as OpenPose writes its own; return the folders by camera."""
    table, names = pd.read_csv(data / "annotations.csv"), {**HAND, **marker_system.JOINTS}
    joints = skeleton.read(ROOT / "config" / "skeletons" / "body25.yaml").joints
    place = {theirs: joints.index(ours) for ours, theirs in names.items()}
    table = table[table["joint"].isin(place) & table["camera"].isin(hall_markers.CAMERAS)]
    for (camera, frame), part in table.groupby(["camera", "frame_idx"]):
        points = np.zeros((len(joints), 3))
        points[part["joint"].map(place)] = part[["x_px", "y_px"]].assign(score=1.0)
        person = {"pose_keypoints_2d": points.ravel().tolist()}
        path = folder / camera / f"{camera}_{frame:06d}.json"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps({"people": [person]}))
    return {camera: str(folder / camera) for camera in hall_markers.CAMERAS}


def openpose_folders(demo, folder):
    """Copy OpenPose's files, numbered as the frames that they show; return folders by camera."""
    found = {}
    for at in range(1, 5):
        target = folder / f"cam0{at}"
        target.mkdir(parents=True)
        files = sorted((demo / "openpose_body25b" / f"cam{at}_json").glob("*.json"))
        for number, path in enumerate(files[:-LATER], start=LATER):
            shutil.copy(path, target / f"cam0{at}_{number:06d}.json")
        found[target.name] = str(target)
    return found


def write_study(folder, demo, data, networks):
    """Write the sessions of recorded pictures and their study; return its configuration."""
    takes, places = {}, folder / "config" / "sessions"
    if demo:
        content = yaml_files.read(places / f"{WALK}.yaml")
        found = openpose_folders(demo, folder / "data" / "openpose")
        content["takes"]["balancing"]["pose2d"] = {"body25b": found}
        (places / f"{WALK}.yaml").write_text(yaml.safe_dump(content, sort_keys=False))
        takes[f"{WALK}/balancing"] = "body25b"
    if data:
        hall_markers.checked(data)
        hall_markers.write_study(folder, data.resolve(), networks[0])
        content = yaml_files.read(places / f"{HALL}.yaml")
        content["takes"]["play"]["pose2d"] = {"body25": write_json(data, folder / "data" / "hand")}
        (places / f"{HALL}.yaml").write_text(yaml.safe_dump(content, sort_keys=False))
        takes[f"{HALL}/play"] = "body25"
    study = {"sessions": [name.split("/")[0] for name in takes], "plans": [], "variations": []}
    study["evaluate_networks"] = {"takes": takes, "networks": networks, "skeletons": []}
    (folder / "config" / "networks-study.yaml").write_text(yaml.safe_dump(study))
    return "config/networks-study.yaml"


def recorded(folder, results, demo, data, networks):
    """Return the table of networks on recorded pictures; pinned files are those of the results."""
    study = write_study(copied(folder), demo, data, networks)
    for part in ("external", "networks"):
        shutil.copytree(results / part, folder / "results" / part, dirs_exist_ok=True)
    command = [sys.executable, "-m", "snakemake", "--configfile", study, "--", paths.NETWORK_ERRORS]
    subprocess.run(command, cwd=folder, check=True)
    return pd.read_csv(folder / paths.NETWORK_ERRORS)


def times(results, networks):
    """Return each network's least processor time, ms, over some pictures of one person."""
    models = yaml_files.read(ROOT / "config" / "models.yaml")
    detectors = yaml_files.read(ROOT / "config" / "detectors.yaml")
    found, detector = {}, None
    for name in networks:
        one = sessions.model(name, models[name], detectors)
        joints = skeleton.read(ROOT / "config" / "skeletons" / f"{one.skeleton}.yaml").joints
        file = {part: results / "networks" / name / f"{part}.onnx" for part in paths_of(one)}
        found[name] = open_network.landmark_network(
            file["landmarks"], joints, **one.decoder_options()
        )
        detector = detector or open_network.person_detector(
            file["detector"], **one.detector.decoder_options()
        )
    capture, seconds = cv2.VideoCapture(str(results / VIDEO)), {name: [] for name in networks}
    for _ in range(N_PICTURES):
        picture = capture.read()[1]
        region = detector.detect(picture)[0]
        for name, network in found.items():
            start = time.process_time()
            network.estimate(picture, region)
            seconds[name].append(time.process_time() - start)
    return {name: 1000 * min(each) for name, each in seconds.items()}


def paths_of(model):
    """Return the parts of a network that are files."""
    return ["landmarks", *(["detector"] if model.detector else [])]


def rows(table, ms):
    """Yield the rows of docs/numbers: recorded takes; of virtual ones the time alone."""
    for row in table.itertuples():
        if row.against != "truth":
            about = [numbers.TABLE, f"`{row.network}`; {WORDS[row.session, row.against]}"]
            rest = [row.unit, row.session, row.n, 0, "benchmark", COMMAND]
            decimals = numbers.DECIMALS.get(row.measure, numbers.DECIMALS[row.unit])
            for end, column in numbers.ENDS.items():
                text = register.printed(getattr(row, column), decimals)
                yield [*about, row.measure + end, text, *rest]
        elif row.measure == "pck":
            about = [numbers.TABLE, numbers.label(row.network, row.session)]
            ratio = ms[row.network] / ms[table["network"].iloc[0]]
            rest = ["", row.session, N_PICTURES, 0, "benchmark", COMMAND]
            yield [*about, "time", f"{ratio:.2f}", *rest]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("--demo", type=Path, help="Pose2Sim's demonstration with OpenPose's JSON")
    parser.add_argument("--hall", type=Path, help="the recording mocap_8")
    parser.add_argument("--study", type=Path, help="a folder for the study, kept")
    given = parser.parse_args()
    table = pd.read_csv(given.results / Path(paths.NETWORK_ERRORS).relative_to(paths.RESULTS))
    networks = list(dict.fromkeys(table["network"]))
    ms = times(given.results, networks)
    print(*(f"{name}: {value:.1f} ms" for name, value in ms.items()), sep="\n")
    if given.demo or given.hall:
        with tempfile.TemporaryDirectory() as temporary:
            folder = given.study or Path(temporary)
            folder.mkdir(parents=True, exist_ok=True)
            real = recorded(folder, given.results, given.demo, given.hall, networks)
        table = pd.concat([table, real], ignore_index=True)
    print(table.round(2).to_string(index=False))
    others = stated.of_other_sessions(OUTPUT, set(table["session"]))
    stated.write(OUTPUT, [*rows(table, ms), *others])


if __name__ == "__main__":
    main()
