"""Joint offsets on bodies that were left out of their fit: docs/numbers/joint_offsets.csv.

    python benchmarks/joint_offsets.py results

RESULTS hold the development sessions as `evaluate_joint_offsets` reads them (CONTRIBUTING.md, "A
network"). Each body is left out in turn: its errors are those of raw joints, by the true cameras,
less offsets that were fitted on the other bodies. Three ways to fit are compared: with the far
cameras of `players-dev` alone, by posture; with the cameras of all three sessions, by posture; and
with all of them, by posture and direction of view, as the study does.
"""

import argparse
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import stated
from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.evaluation import error_fit, joints
from courtside.evaluation.numbers.players import NETWORK
from courtside.reconstruction import joint_correction
from courtside.records.keypoints import skeleton
from courtside.study import paths
from courtside.study.configuration import configuration, yaml_files
from courtside.study.jobs import evaluation

SESSIONS = {
    "players-dev": "18 to 27 m away, 2 m high, badminton",
    "players-dev-stands": "on stands, 5.5 to 8 m high, free movements and badminton",
    "players-dev-near": "7 to 9 m away, free movements and walking",
}
WAYS = {"far": (("players-dev",), False), "posture": (SESSIONS, False), "view": (SESSIONS, True)}
SHAPE = skeleton.read(ROOT / "config" / "skeletons" / "blazepose33.yaml")
COMMAND = "`python benchmarks/joint_offsets.py results`"


def takes_of(results, sessions=SESSIONS, calibration="known18"):
    """Return, by session, the files of its takes, as `error_fit.footage_with_truth` needs them."""
    folder = ROOT / "config"
    content = yaml_files.read(folder / "config.yaml")
    content |= {"sessions": list(sessions), "variations": [], "plans": []}
    study = configuration.load(content, str(folder / "config.yaml"), folder, root=ROOT)
    found = {session: [] for session in sessions}
    for take in evaluation.fitted_takes(study, NETWORK, calibration):
        files = {key: below(results, path) for key, path in take.items() if key != "sex_of"}
        found[files["session_truth"].parent.name].append({**take, **files})
    return found


def below(results, path):
    """Return a file, or each of several, of the study's results in another folder of results."""
    if isinstance(path, list):
        return [below(results, one) for one in path]
    return results / Path(path).relative_to(paths.RESULTS)


def clips_of(takes):
    """Return [(body, raw joints, Clip)] of takes of one person, and the names of true joints."""
    step, found = yaml_files.read(ROOT / "config" / "config.yaml")["triangulate"], []
    for seen, sex_of, truth in error_fit.footage_with_truth(takes):
        raw = error_fit.triangulated(seen, SHAPE, list(sex_of), step)
        (clip,), (body,) = error_fit.clips(raw, seen, sex_of, truth), sex_of
        found.append((body, raw.frames(error_fit.thin(raw)), clip))
    return found, truth.joints.tolist()


def errors_m(points, true, true_joints, table=None, sex_of=None, cameras=()):
    """Return the errors (N,) m of limb joints against true ones (P, T, K, 3).

    Less the offsets of a table; raw without one.
    """
    if table is not None:
        moved = joint_correction.offsets(points, table, sex_of, cameras)
        points = replace(points, xyz=points.xyz - moved)
    names, error, _ = joints.errors(points, true_joints, true)
    limbs = [names.index(joint) for joint in skeleton.JOINTS]
    apart = np.linalg.norm(error[:, :, limbs], axis=-1).ravel()
    return apart[np.isfinite(apart)]


def left_out(of_session, true_joints, session, way):
    """Return the errors of a session's bodies, each left out of its fit."""
    found, (used, by_view) = [], WAYS[way]
    for body in sorted({body for body, _, _ in of_session[session]}):
        clips = [clip for name in used for other, _, clip in of_session[name] if other != body]
        if not by_view:
            clips = [replace(clip, cameras=(), accepted=None) for clip in clips]
        names = of_session[session][0][1].joints.tolist()
        table = joint_correction.estimate(clips, names, true_joints)
        tested = [(points, clip) for other, points, clip in of_session[session] if other == body]
        for points, clip in tested:
            sex_of = dict.fromkeys(map(str, points.person_id), clip.sex)
            given = clip.true[None], true_joints, table, sex_of, clip.cameras
            found.append(errors_m(points, *given))
    return np.concatenate(found)


def rows_of(results):
    """Yield the numbers of the table, and print them."""
    of_session = {}
    for session, takes in takes_of(results).items():
        of_session[session], true_joints = clips_of(takes)
    for session, words in SESSIONS.items():
        raw = [errors_m(p, clip.true[None], true_joints) for _, p, clip in of_session[session]]
        every = {"raw": np.concatenate(raw)}
        every |= {way: left_out(of_session, true_joints, session, way) for way in WAYS}
        for part, apart in every.items():
            printed = "{:.1f} / {:.1f}".format(*(1000 * np.quantile(apart, [0.5, 0.9])))
            print(session, part, printed, flush=True)
            row = "offset-layouts", f"`{session}`: {words}", part, printed, "mm", session
            yield *row, len(apart), 0, "benchmark", COMMAND


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path)
    given = parser.parse_args()
    rows = list(rows_of(given.results))
    stated.write(ROOT / "docs" / "numbers" / "joint_offsets.csv", rows)


if __name__ == "__main__":
    main()
