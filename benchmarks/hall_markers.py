"""A real hall against a marker system: joints, with two calibrations, beside hand annotations.

    python benchmarks/hall_markers.py DATA [--study FOLDER] [--csv TABLE.csv]

DATA is a folder of the recording "mocap_8" (pictures CC BY 4.0), which is no part of the project:
`cam02.mp4`, `cam05.mp4`, `cam08.mp4`, `cam13.mp4`, their cameras in `calibration_refined.toml`,
points of the court in `court_points.csv`, what the marker system saw in `mocap.csv`, joints set by
hand in `annotations.csv`, and in `calibration_given.json` the cameras as the source gives them, in
which camera 8 is wrong. The script writes a study into FOLDER (by default a temporary one), with
the file's cameras, with cameras found from court points alone, as a second session with the given
ones, and with all of these refined by the people in the take, runs it, and compares with the
markers: time shift and one rigid motion are found from the joints, the scale
is not fitted. It writes docs/numbers/hall_markers.csv, a source of docs/make_tables.py.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd
import yaml
from scipy.spatial.transform import Rotation

import marker_system
import real_people
import stated
from many_sessions import copied
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))

from courtside.evaluation.numbers.players import NETWORK
from courtside.geometry import camera as camera_models
from courtside.geometry import triangulation
from courtside.records.cameras import placed_points
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.configuration import yaml_files
from courtside.study.execution.files import read_json
from courtside.study.methods import STAGE_WORDS as STAGES

CAMERAS = ("cam02", "cam05", "cam08", "cam13")
FILES = (
    *("mocap.csv", "annotations.csv", "court_points.csv", "calibration_refined.toml"),
    "calibration_given.json",
)
SIZE = (3840, 2160)
# Who is meant, as a user says it: the player stands there in the first picture. Somebody else is in
# all pictures, too.
SUBJECTS = {
    "player": {
        "sex": "m",
        "consent": ["analysis"],
        "seen": {"camera": "cam02", "time_s": 0, "at_px": [1980, 1000]},
    }
}
HAND_PX = {"max_error_px": 15, "fade_px": 20}  # of joints set by hand, persons 160 to 540 px tall
WAYS = {"file": "cameras of the source, refined", "known": "cameras from court points alone"}
GIVEN = "hall-given"
REFINED = {  # by session and calibration, in the table `ways`
    ("hall-markers", "file"): "file of the source, refined to court points",
    ("hall-markers", "known"): "court points alone",
    (GIVEN, "file"): "file as given, camera 8 wrong",
}
FUSED = "takes/play/{stage}/{way}/all-robust/{model}.npz"
# Of the marker system, wrong in the first 2 s: the study and the hand annotations agree with each
# other there, to 38 mm in the median, and both are 0.2 to 0.5 m from it.
DOUBTFUL = ("left_ankle",)
LABEL = "real, basketball player in a marker suit, sports hall, against the marker system's joints"
# Their shoulders are joints, unlike those of the marker system.
SET_BY_HAND = marker_system.JOINTS | {"left_shoulder": "LShoulder", "right_shoulder": "RShoulder"}
BY_HAND = "hall, against joints set by hand"
COMMAND = "`python benchmarks/hall_markers.py DATA`"


def calibrations(session):
    """Return the calibrations of a session: each alone and refined by people."""
    bases = [way for name, way in REFINED if name == session]
    return [*bases, *(f"{way}-people" for way in bases)]


def write_study(folder, data, model):
    """Write the sessions and their study; return the name of the study's configuration."""
    (folder / "data").mkdir(exist_ok=True)
    points = pd.read_csv(data / "court_points.csv").assign(z_m=0.0)
    points = points[points["camera"].isin(CAMERAS)]
    points[list(placed_points.COLUMNS)].to_csv(folder / "data" / "court_points.csv", index=False)
    given = json.loads((data / "calibration_given.json").read_text())
    camera_models.write_toml(folder / "data" / "given.toml", as_given(given), source="given")
    content = {
        "description": "A sports hall with a marker system, 4 fixed cameras, 12 pictures a second",
        "court": "none",
        "subjects": SUBJECTS,
        "cameras": {name: {} for name in CAMERAS},
        "calibration": {"file": str(data / "calibration_refined.toml")},
        "court_points": "data/court_points.csv",
        "takes": {
            "play": {
                "synchronised": True,
                "videos": {name: str(data / f"{name}.mp4") for name in CAMERAS},
            }
        },
    }
    other = {key: value for key, value in content.items() if key != "court_points"}
    other["calibration"] = {"file": "data/given.toml"}
    for name, session_content in {"hall-markers": content, GIVEN: other}.items():
        ways = calibrations(name)
        session_content["override"] = {
            "models": [model],
            "calibrations": ways,
            "take_calibrations": ways,
        }
        session = folder / "config" / "sessions" / f"{name}.yaml"
        session.write_text(yaml.safe_dump(session_content, sort_keys=False), encoding="utf-8")
    study = folder / "config" / "hall-markers-study.yaml"
    study.write_text(
        yaml.safe_dump({"sessions": ["hall-markers", GIVEN], "plans": [], "variations": []}),
        encoding="utf-8",
    )
    return str(study.relative_to(folder))


def as_given(content):
    """Return the cameras of `calibration_given.json`, whose lengths are mm."""
    found = []
    for name in CAMERAS:
        rows = content[name]
        turn = Rotation.from_rotvec(np.ravel(rows["rvecs"])).as_matrix()
        pose = np.column_stack([turn, np.ravel(rows["tvecs"]) / 1000])
        lens = np.array(rows["mtx"]), np.ravel(rows["dist"])
        found.append(camera_models.Camera(name, SIZE, *lens, pose))
    return found


def run(folder, data, model):
    """Make the skeletons of all stages with all calibrations; return the results' folder."""
    copied(folder)
    study, results = write_study(folder, data, model), Path("results")
    made = [
        results / name / FUSED.format(stage=stage, way=way, model=model)
        for name in ("hall-markers", GIVEN)
        for way in calibrations(name)
        for stage in STAGES
    ]
    command = [sys.executable, "-m", "snakemake", "--configfile", study, "--", *map(str, made)]
    subprocess.run(command, cwd=folder, check=True)
    return folder / results / "hall-markers"


def truth(data):
    """Return the times (U,) s and places (U, J, 3) m of the marker system's joints."""
    table = pd.read_csv(data / "mocap.csv")
    places = [
        table[[f"{name}_{axis}_m" for axis in "xyz"]] for name in marker_system.JOINTS.values()
    ]
    return table["time_s"].to_numpy(), np.stack(places, axis=1)


def by_hand(data, cameras, rate_hz, joints=tuple(marker_system.JOINTS)):
    """Return times (T,) s and joints (T, J, 3) m set by hand, triangulated by these cameras."""
    table = pd.read_csv(data / "annotations.csv")
    shape = (len(cameras), table["frame_idx"].max() + 1, len(joints))
    xy = np.full((*shape, 2), np.nan)
    names = {SET_BY_HAND[joint]: at for at, joint in enumerate(joints)}
    order = {camera.name: at for at, camera in enumerate(cameras)}
    table = table[table["joint"].isin(names) & table["camera"].isin(order)]
    at = table["camera"].map(order), table["frame_idx"], table["joint"].map(names)
    xy[tuple(column.to_numpy() for column in at)] = table[["x_px", "y_px"]]
    score = np.isfinite(xy[..., 0]).astype(float)
    step = yaml_files.read(ROOT / "config" / "config.yaml")["triangulate"]
    step = {key: step[key] for key in ("min_score", "min_views")}
    flat = xy.reshape(len(cameras), -1, 2), score.reshape(len(cameras), -1)
    found = triangulation.triangulate_robust(cameras, *flat, **step, **HAND_PX)
    return np.arange(shape[1]) / rate_hz, found.xyz.reshape(*shape[1:], 3)


def measured(results, data, model, ways=WAYS):
    """Yield (way, stage, Fit, table of errors)."""
    names, (true_s, true) = list(marker_system.JOINTS), truth(data)
    for way in ways:
        for stage, word in STAGES.items():
            points = keypoints.read_3d(results / FUSED.format(stage=stage, way=way, model=model))
            own, rate_hz = [points.joints.tolist().index(name) for name in names], points.rate_hz
            fit = marker_system.fit(points.time_s, points.xyz[0][:, own], true_s, true)
            covariance = points.covariance[0][:, own]
            table = marker_system.table(names, fit, covariance, rate_hz, DOUBTFUL)
            yield way, word, fit, table
        cameras = camera_models.read_toml(results / "calibration" / way / "cameras.toml")
        time_s, xyz = by_hand(data, cameras, rate_hz)
        found = marker_system.fit(time_s, xyz, true_s, true)
        unknown = np.full((*xyz.shape, 3), np.nan)
        table = marker_system.table(names, found, unknown, rate_hz, DOUBTFUL)
        yield way, "hand", found, table


def rows_by_hand(results, data, model, way="file"):
    """Return the rows of the table `real-people`: without alignment, the pictures are the same."""
    files = {
        word: FUSED.format(stage=stage, way=way, model=model) for stage, word in STAGES.items()
    }
    rate_hz = keypoints.read_3d(results / files["raw"]).rate_hz
    cameras = camera_models.read_toml(results / "calibration" / way / "cameras.toml")
    _, other = by_hand(data, cameras, rate_hz, skeleton.JOINTS)
    stages = {word: real_people.limbs(results / file)[: len(other)] for word, file in files.items()}
    other = other[: len(stages["raw"])]
    return list(real_people.rows(BY_HAND, "hall-markers", stages, other, COMMAND))


def way_rows(results, data, model):
    """Yield the rows of the table `ways`: each calibration alone and refined by people."""
    for (session, base), words in REFINED.items():
        folder, row = results.parent / session, f"`hall-markers`: {words}"
        for part, way in (("alone", base), ("refined", f"{base}-people")):
            found = {stage: one for _, stage, _, one in measured(folder, data, model, [way])}
            raw, corrected = (found[stage].iloc[0] for stage in ("raw", "corrected"))
            printed = f"markers {raw['median_mm']:.0f} / {raw['p90_mm']:.0f} mm"
            yield "ways", row, part, printed, "mm", raw
            printed = f"corrected {corrected['median_mm']:.0f} / {corrected['p90_mm']:.0f} mm"
            yield "ways", row, f"{part}_shape", printed, "mm", corrected
            points = keypoints.read_3d(folder / FUSED.format(stage="pose3d", way=way, model=model))
            limbs = [list(points.joints).index(name) for name in skeleton.JOINTS]
            share = 100 * points.accepted[0][:, limbs].mean(axis=(0, 1))
            printed = ", ".join(f"{one:.0f}" for one in share)
            yield "ways", row, f"{part}_accepted", printed, "%", raw
        quality = read_json(folder / "calibration" / f"{base}-people" / "quality.json")
        yield "ways", row, "refined_taken", quality["taken"], "", raw


def rows(found):
    """Yield the rows of docs/numbers: one line of the table `footage`, and the table `markers`."""
    for way, stage, fit, table in found:
        every = table.iloc[0]
        if stage != "hand":
            for part in ("median", "p90"):
                value = f"{every[f'{part}_mm']:.1f}"
                yield "footage", f"{LABEL}; {WAYS[way]}", f"{stage}_{part}", value, "mm", every
        for _, row in table.iterrows():
            label = f"{row['joint'].replace('_', ' ')}; {WAYS[way]}"
            for part, unit in (("median", "mm"), ("p90", "mm"), ("coverage_90", "%")):
                key = f"{part}_percent" if unit == "%" else f"{part}_mm"
                if np.isfinite(row[key]):
                    yield "markers", label, f"{stage}_{part}", f"{row[key]:.0f}", unit, row
            for end in ("from", "to"):
                value = f"{row[f'median_{end}_mm']:.0f}"
                yield "markers", label, f"{stage}_median_{end}", value, "mm", row
            value = f"{row['missing_percent']:.1f}"
            yield "markers", label, f"{stage}_missing", value, "%", row
        label = f"all; {WAYS[way]}"
        yield "markers", label, f"{stage}_scale", f"{100 * (fit.scale - 1):+.1f}", "%", every


def register_rows(found):
    """Yield the rows as docs/make_tables.py reads them."""
    for name, row, part, value, unit, counted in found:
        n, missing = int(counted["n"]), counted["missing_percent"] / 100
        failed = round(n * missing / (1 - missing))
        yield [name, row, part, value, unit, "hall-markers", n, failed, "benchmark", COMMAND]


def checked(data):
    """End with one line where the recording is not there."""
    needed = (*FILES, *(f"{one}.mp4" for one in CAMERAS))
    lacking = [name for name in needed if not (data / name).is_file()]
    if lacking:
        sys.exit(
            f"{data}: expected the recording mocap_8, found no {lacking[0]}; it is no part of the "
            "project: docs/measured/real_footage.md says where it is from"
        )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=Path)
    parser.add_argument("--study", type=Path, help="a folder for the study, kept")
    parser.add_argument("--results", type=Path, help="of a run that is finished")
    parser.add_argument("--model", default=NETWORK)
    parser.add_argument("--csv", type=Path, help="where the errors are written, too")
    given = parser.parse_args()
    checked(given.data)
    with tempfile.TemporaryDirectory() as temporary:
        folder = given.study or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        results = given.results or run(folder, given.data.resolve(), given.model)
        found = list(measured(results, given.data, given.model))
        ways = list(way_rows(results, given.data, given.model))
        beside = rows_by_hand(results, given.data, given.model)
    for way, stage, fit, table in found:
        print(f"\n{WAYS[way]}, {stage}: the markers' clock is found {fit.shift_s:.3f} s "
              f"ahead; scale {fit.scale:.4f}, not fitted")  # fmt: skip
        print(table.round(1).to_string(index=False))
    if given.csv:
        labelled = [table.assign(way=way, stage=stage) for way, stage, _, table in found]
        pd.concat(labelled).to_csv(given.csv, index=False, float_format="%.3f")
    if given.model == NETWORK:
        stated.write(
            ROOT / stated.FOLDER / "hall_markers.csv",
            [*register_rows(rows(found)), *beside, *stated.joined(register_rows(ways))],
        )


if __name__ == "__main__":
    main()
