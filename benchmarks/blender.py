"""BVH and GLB opened in Blender, beside the records that they were made of.

    python benchmarks/blender.py RESULTS [--environments DIR]

Every BVH and GLB file of the takes of RESULTS is imported into Blender, with the options that
docs/results.md names. The heads of its bones are compared, at the frames of the record, with the
joints of the skeletal model (`motion/`), of the stages, or of the device. A bone that is no joint
of the record is left out. It writes nothing; its numbers stand in docs/numbers/by_hand.csv.
"""

import argparse
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd

import peers
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))

from courtside.records.devices import device_motion, hierarchy
from courtside.records.keypoints import keypoints, skeletal_motion, skeleton

SAME_S = 1e-3
SUIT = ROOT / "config" / "skeletons" / "mocopi27.yaml"


def of_motion(npz):
    """Yield each person; names, times and places (T, J, 3) of segments; the time of a GLB's zero.

    Places are NaN in frames that are not in the files.
    """
    motion = skeletal_motion.read(npz)
    for column, person in enumerate(motion.person_id.tolist()):
        posed, fitted = motion.posed(column)
        xyz = np.full((len(fitted), len(motion.segments), 3), np.nan)
        xyz[fitted] = hierarchy.forward(posed)[0]
        yield person, motion.segments.tolist(), motion.time_s, xyz, motion.time_s[0]


def of_joints(npz):
    """Yield the same of a take's joints."""
    points = keypoints.read_3d(npz)
    for column, person in enumerate(points.person_id.tolist()):
        yield person, points.joints.tolist(), points.time_s, points.xyz[column], points.time_s[0]


def of_device(npz, suit):
    """Yield the same of a suit's or another device's motion, upright; it has no person."""
    motion = device_motion.read(npz)
    if (motion.posed is not None) != suit:
        return
    names = motion.joints.tolist()
    if suit:  # its files have the names of its app
        body = skeleton.read(SUIT)
        called = dict(zip(body.joints, body.device_names(), strict=True))
        names = [called[joint] for joint in names]
    known = motion.performed & np.isfinite(motion.xyz).all(axis=2).any(axis=1)
    xyz = device_motion.upright(motion)
    yield "", names, motion.time_s, xyz, motion.time_s[known.argmax()]


RECORDS = {
    "skeletal model": ("motion/**/*.npz", of_motion),
    "joints of cameras": ("pose3d*/**/*.npz", of_joints),
    "joints of a device": ("devices/*.npz", partial(of_device, suit=False)),
    "suit": ("devices/*.npz", partial(of_device, suit=True)),
}


def files(results):
    """Yield the kind and the path of each file, and the record that it was made of."""
    for kind, (pattern, read) in RECORDS.items():
        for npz in sorted(results.glob(f"*/takes/*/{pattern}")):
            for suffix in ("bvh", "glb"):
                if any(npz.parent.glob(f"{npz.stem}*.{suffix}")):
                    for person, *record in read(npz):
                        path = npz.parent / ".".join(filter(None, (npz.stem, person, suffix)))
                        if path.is_file():
                            yield f"{kind}, {suffix.upper()}", path, record


def distances_mm(names, time_s, xyz, zero_s, found):
    """Return the distances (N, B) of bones from the record at its frames, and how many it has.

    The times of a BVH file begin with the first frame in which its root is known.
    """
    bones = found["bones"].tolist()
    known = np.flatnonzero(np.isfinite(xyz[:, names.index(bones[0])]).all(axis=1))
    own_s = time_s[known] - (time_s[known[0]] if zero_s is None else zero_s)
    near = np.abs(found["time_s"][:, None] - own_s).argmin(axis=0)
    same = np.abs(found["time_s"][near] - own_s) < SAME_S
    both = [at for at, bone in enumerate(bones) if bone in names]
    wanted = xyz[known[same]][:, [names.index(bones[at]) for at in both]]
    return 1000 * np.linalg.norm(found["xyz"][near[same]][:, both] - wanted, axis=2), len(known)


def compared(results, python, folder):
    """Return one row of numbers for each file."""
    rows = []
    given = list(files(results))
    report = peers.run_method(
        python, "import_blender.py", folder / "r.npz", *(path.resolve() for _, path, _ in given)
    )
    if "failed" in report:
        raise SystemExit(f"import_blender.py: {report['failed']}")
    print(report)
    with np.load(folder / "r.npz") as made:
        for at, (kind, path, (*record, zero_s)) in enumerate(given):
            found = {key: made[f"{at}_{key}"] for key in ("bones", "time_s", "xyz")}
            begin_s = zero_s if path.suffix == ".glb" else None
            apart, frames = distances_mm(*record, begin_s, found)
            rows.append(
                {
                    "file": path.relative_to(results),
                    "kind": kind,
                    "frames": frames,
                    "not in the file": frames - len(apart),
                    "median, mm": np.nanmedian(apart),
                    "95 %, mm": np.nanpercentile(apart, 95),
                    "largest, mm": np.nanmax(apart),
                }
            )
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("--environments", type=Path, default=peers.FOLDER)
    given = parser.parse_args()
    try:
        python = peers.interpreter("blender", given.environments)
    except (subprocess.CalledProcessError, OSError) as error:
        print(f"blender: not installable here, nothing compared: {error}")
        return
    with tempfile.TemporaryDirectory() as folder:
        table = pd.DataFrame(compared(given.results, python, Path(folder)))
    print(table.round(4).to_string(index=False))
    by_kind = table.groupby("kind")
    together = by_kind["median, mm"].agg(["count", "median"])
    together["largest, mm"] = by_kind["largest, mm"].max()
    print(together.round(4).to_string())


if __name__ == "__main__":
    peers.on_one_thread()
    main()
