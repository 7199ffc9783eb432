"""Formats of the study itself: configuration, sessions, plans, courts, skeletons, run records."""

import base64
import io
import json
import re
import shutil
import tarfile
import zipfile
from pathlib import Path

import cv2
import numpy as np
import yaml

from courtside.calibration.court import court
from courtside.records.devices import clocks as sync
from courtside.records.keypoints import derived_joints, skeleton
from courtside.study.configuration import (
    configuration,
    plans,
    yaml_files,  # fmt: skip
)
from courtside.study.execution import artefacts, checksums, files, verdicts
from courtside.study.provenance import comparison, verification
from courtside.validation import remembered
from courtside.video.glance import SMALL_PX
from fuzz.format import Format, require

ROOT = Path(__file__).parents[2]
PICTURE = "the picture"  # in place of its path and date
CONFIG = ROOT / "config"
NAME = re.compile(r"[a-z0-9][a-z0-9_-]*")
SESSIONS = ("players-tiny", "single-view-tiny", "walk-4cams-tiny", "plain-tiny", "players-b")
OWN = {
    "description": "a hall of our own",
    "court": "badminton",
    "subjects": {"p1": {"height_m": 1.7, "mass_kg": 60, "sex": "f", "hand": "left"}, "p2": None},
    "cameras": {
        "left": {
            "static": "data/north/left.mp4",
            "chessboard": {"images": "data/north/board", "inner_corners": [7, 4], "square_m": 0.06},
        },
        "right": {"static": "data/north/right.mp4", "crop_px": [0, 0, 640, 480]},
        "door": {"static": "data/north/door.mp4", "name_in_calibration": "cam 3"},
    },
    "walks": {"walk1": {"video": "data/north/walk.mp4"}, "photos": {"images": "data/north/photos"}},
    "court_points": "data/north/points.csv",
    "views": {"two": ["left", "right"]},
    "halfbody": {"centre": "door", "left": "left", "right": "right"},
    "takes": {
        "smash1": {
            "videos": {c: f"data/north/smash_{c}.mp4" for c in ("left", "right", "door")},
            "devices": {
                "suit": {"file": "data/north/smash.bvh"},
                "depth": {"file": "data/north/smash.bag", "subject": "p1"},
            },
            "subjects": ["p1"],
            "clocks": {"suit": {"offset_s": 0.5, "drift_ppm": 20, "uncertainty_s": 0.02}},
            "trim_s": [0.5, 3.5],
            "steady": True,
        },
        "found": {
            "videos": {"left": "data/north/found_left.mp4", "right": "data/north/found_right.mp4"},
            "subjects": ["p1"],
            "synchronised": True,
            "pose2d": {"body25": {"left": "data/north/json_l", "right": "data/north/json_r"}},
            "pose3d": {"halpe26": {"p1": "data/north/p1.trc"}},
        },
    },
    "override": {"triangulate": {"max_error_px": 12}, "fusions": ["all-robust"]},
}


def study(folder, session):
    """Write a configuration with one session, as small as the checks allow."""
    made = folder / session
    (made / "config" / "sessions").mkdir(parents=True)
    for name in ("skeletons", "courts"):  # names are all that is looked at
        (made / "config" / name).mkdir()
        for path in (CONFIG / name).glob("*.yaml"):
            (made / "config" / name / path.name).touch()
    shutil.copy(CONFIG / "external.yaml", made / "config")
    for name in ("models.yaml", "detectors.yaml"):
        shutil.copy(CONFIG / name, made / "config")
    own = made / "config" / "sessions" / f"{session}.yaml"
    if session == "north":
        own.write_text(yaml.safe_dump(OWN, sort_keys=False), encoding="utf-8")
        for path in re.findall(r"data/north/[a-z_0-9.]+", own.read_text(encoding="utf-8")):
            (made / path).parent.mkdir(parents=True, exist_ok=True)
            (made / path).touch()
    else:
        shutil.copy(CONFIG / "sessions" / own.name, own)
    content = yaml_files.read(CONFIG / "config.yaml")
    content |= {"sessions": [session], "variations": [], "plans": []}
    text = yaml.safe_dump(content, sort_keys=False)
    (made / "config" / "config.yaml").write_text(text, encoding="utf-8")


def studies(folder):
    """Write one configuration for each session."""
    for session in ("north", *SESSIONS):
        study(folder, session)
    again = folder / "aliases"  # a mapping that would fill the memory if each part were written out
    shutil.copytree(folder / "north", again)
    (again / "config/sessions/north.yaml").rename(again / "config/sessions/aliases.yaml")


def load(folder):
    """Check a whole configuration, as every command of the study does first."""
    content = yaml_files.read(folder / "config" / "config.yaml")
    found = configuration.load(content, "config/config.yaml", folder / "config", root=folder)
    for name, session in found.sessions.items():
        there = [name, *session.cameras, *session.takes, *session.subjects, *session.walks]
        there += [d for take in session.takes.values() for d in (*take.devices, *take.subjects)]
        require(all(NAME.fullmatch(word) for word in there), f"names {there}")
    return found


def copies(pattern):
    """Return a function that copies committed files."""

    def make(folder):
        for path in sorted(ROOT.glob(pattern)):
            shutil.copy(path, folder)

    return make


def laughing(make):
    """Return a function that also writes YAML whose aliases would fill the memory."""

    def more(folder):
        make(folder)
        lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x, x]"]
        lines += [f"a{k}: &a{k} [{', '.join([f'*a{k - 1}'] * 10)}]" for k in range(1, 12)]
        (folder / "laughs.yaml").write_text("\n".join(lines) + "\njoints: *a11\n", encoding="utf-8")

    return more


def wheels(folder):
    """Write wheels with two small members."""
    for name in ("thing-1.0-py3-none-any.whl", "other-2.0-py3-none-any.whl"):
        with zipfile.ZipFile(folder / name, "w", compression=zipfile.ZIP_DEFLATED) as archive:
            for member in ("thing/a.txt", "thing/inner/b.bin", "thing-1.0.dist-info/RECORD"):
                archive.writestr(zipfile.ZipInfo(member), bytes(range(256)) * 20)


def packages(folder):
    """Write npm packages with two small members."""
    for name in ("thing-1.0.tgz", "other-2.0.tgz"):
        with tarfile.open(folder / name, "w:gz") as archive:
            for member in ("thing/a.txt", "thing/inner/b.bin", "thing/package.json"):
                info = tarfile.TarInfo(member)
                info.size = 256 * 20
                archive.addfile(info, io.BytesIO(bytes(range(256)) * 20))


def unpack_package(path):
    """Unpack two members, as if the package's checksum were right."""
    return unpack(path, package="thing@1.0")


def unpack(path, **kind):
    """Unpack two members, as if the wheel's checksum were right."""
    content = path.parent / "content"
    content.write_bytes(bytes(range(256)) * 20)
    members = dict.fromkeys(("thing/a.txt", "thing/inner/b.bin"), files.sha256(content))
    kind = kind or {"requirement": "thing==1.0"}
    artefact = artefacts.Artefact("thing", "0" * 64, members, "CC0", **kind)
    targets = {member: path.parent / "out" / member for member in members}
    artefacts.unpack(path, artefact, targets)
    for target in targets.values():
        require(files.sha256(target) == files.sha256(content), f"{target} is another file")
    return targets


def clocks(folder):
    """Write clocks of cameras."""
    found = sync.Clock(0.25, 12.0, 0.004, 3.0, "found", "three claps", (1.5, -2.0))
    sync.write(folder / "cameras.json", "a", {"a": sync.Clock(status="reference"), "b": found})


def read_clocks(path):
    """Read clocks and turn a time of the reference into theirs."""
    reference, found = sync.read(path)
    require(reference in found, "no reference")
    return [clock.to_reference(clock.from_reference(1.0)) for clock in found.values()]


def sidecars(folder):
    """Write the record of a run as it lies in results/run."""
    run = folder / "run" / "provenance" / "figures"
    run.mkdir(parents=True)
    content = {
        "format": 1, "file": "figures/a.png", "sha256": "0" * 64, "command": "snakemake a.png",
        "inputs": {"data/a.mp4": "0" * 64}, "artefacts": {}, "code": {"draw_a.py": "1" * 64},
        "lock_sha256": "2" * 64, "packages": {"numpy": "2.4"}, "python": "3.11",
        "platform": "Linux", "rule": "draw_a", "settings": {},
    }  # fmt: skip
    (run / "a.png.json").write_text(json.dumps(content), encoding="utf-8")


def read_sidecars(path):
    """Read sidecars and ask which files are out of date."""
    now = {"sha256": lambda path: None, "code": lambda script: None, "lock_sha256": None}
    now |= {"packages": {"numpy": "2.4"}, "python": "3.11", "platform": "Linux"}
    return [verification.changes(sidecar, now) for sidecar in verification.read(path)]


def sums(folder):
    """Write the checksums that are kept between runs."""
    content = {
        "format": 1,
        "files": {"data/a.mp4": [12, 34, "0" * 64]},
        "until": {"data/a.mp4": 56},
    }
    (folder / "checksums.json").write_text(json.dumps(content), encoding="utf-8")


def read_sums(path):
    """Read checksums, and ask for one."""
    known = checksums.Checksums(path)
    found = known.of(path)
    known.write()
    return found


def looks(folder):
    """Write what is remembered of a picture; its reader puts the picture there."""
    small = base64.b64encode(bytes(SMALL_PX[0] * SMALL_PX[1])).decode()
    look = {"size": [6, 4], "n_frames": None, "rate_hz": None, "even": True, "small": small}
    content = {"format": remembered.FORMAT, "looks": {PICTURE: look}}
    (folder / "recordings.json").write_text(json.dumps(content), encoding="utf-8")


def read_looks(path):
    """Look at the picture, which is remembered or looked at again."""
    picture, kept = path.parent / "picture.png", path.parent / "kept.json"
    cv2.imwrite(str(picture), np.zeros((4, 6, 3), np.uint8))
    state = picture.stat()
    key = f"{picture.absolute()} {state.st_size} {state.st_mtime_ns} None"
    kept.write_bytes(path.read_bytes().replace(PICTURE.encode(), key.encode()))
    known = remembered.Remembered(kept)
    found = known.look(picture)
    require(found.small.shape == SMALL_PX[::-1], "no small picture")
    known.save()
    return found


def verdicts_of(folder):
    """Write verdicts on a take."""
    head = ",".join([*verdicts.WAY, *verdicts.COLUMNS])
    rows = [
        "file,r,net,all,all,whole,,,,doubtful,clock,Words.",
        "file,r,net,a,all,found,1,,,good,,",
    ]
    (folder / "quality.csv").write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")


def read_verdicts(path):
    """Read verdicts, and tell them as the end of a run does."""
    return verdicts.read(path), verdicts.summary([path])


def facts(folder):
    """Write JSON as rules hand it to the report."""
    text = json.dumps({"warnings": ["a"], "n_images": 12, "error_px": 0.4, "versions": {"a": "1"}})
    (folder / "summary.json").write_text(text, encoding="utf-8")


def results(folder):
    """Write two small trees of results that are compared."""
    for name in ("one", "other"):
        made = folder / "pair" / name
        made.mkdir(parents=True)
        (made / "a.csv").write_text("x,y\n1,2.5\n3,4\n", encoding="utf-8")
        (made / "b.json").write_text('{"a": [1, 2.5], "b": "x"}', encoding="utf-8")
        (made / "c.toml").write_text('a = 1.5\n[b]\nc = ["x"]\n', encoding="utf-8")


def compare(path):
    """Compare two trees of results."""
    return comparison.compare(path / "one", path / "other")


FORMATS = [
    Format("session", 1500, studies, load, "sessions/*.yaml"),
    Format("config", 700, studies, load, "config/config.yaml"),
    Format("models", 400, studies, load, "config/[edm]*.yaml"),
    Format("plan", 600, laughing(copies("config/plans/*.yaml")), plans.read),
    Format("court", 1200, laughing(copies("config/courts/*.yaml")), court.read),
    Format("skeleton", 1000, laughing(copies("config/skeletons/*.yaml")), skeleton.read),
    Format("derived-joints", 400, copies("config/derived_joints.yaml"), derived_joints.read),
    Format("wheel", 800, wheels, unpack),
    Format("npm-package", 400, packages, unpack_package),
    Format("clocks", 700, clocks, read_clocks),
    Format("sidecar", 300, sidecars, read_sidecars),
    Format("checksums", 300, sums, read_sums, refuses=False),
    Format("looks", 400, looks, read_looks, refuses=False),
    Format("quality-csv", 400, verdicts_of, read_verdicts),
    Format("facts", 200, facts, files.read_json),
    Format("comparison", 300, results, compare, refuses=False),
]
