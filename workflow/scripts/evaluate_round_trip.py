"""Evaluate the round trip of table 1: 3D keypoints by set of cameras, truth -> rows per joint."""

import pandas as pd

from courtside.evaluation import joints as joint_errors
from courtside.evaluation import round_trip
from courtside.geometry import camera as cameras
from courtside.records import tables
from courtside.records.devices import clocks as sync
from courtside.records.keypoints import derived_joints as derived
from courtside.records.keypoints import keypoints, people, skeleton
from courtside.records.truth import take_truth
from courtside.study.execution.script import run


def main(
    pose3d_npz,
    cameras_toml,
    people_npz,
    skeleton_yaml,
    derived_yaml,
    rows_csv,
    *,
    pose2d_npz=(),
    sync_json=None,
    truth_npz=None,
    session,
    take,
    **step,
):
    known = cameras.read_toml(cameras_toml)
    names = skeleton.read(skeleton_yaml).name
    table = derived.read(derived_yaml)
    who = people.read(people_npz)
    views = {view.camera: who.assigned(view) for view in map(keypoints.read_2d, pose2d_npz)}
    clocks = sync.read(sync_json)[1] if sync_json else {}
    truth = None
    if truth_npz:
        truth = take_truth.read(truth_npz)
        truth = joint_errors.derive_truth(truth, table, names, step["derived_joints"])
    rows, stated = [], f"evaluate_round_trip.takes.{session}/{take}"
    for path in pose3d_npz:
        points = derived.append(keypoints.read_3d(path), table, names, step["derived_joints"])
        others = [
            (camera, views[camera.name], clocks.get(camera.name))
            for camera in known
            if camera.name in views and camera.name not in points.cameras
        ]
        rows.append(rows_of(points, known, others, truth, stated, **step))
    tables.write(rows_csv, pd.concat(rows, ignore_index=True))


def rows_of(
    points, known, others, truth, stated, *, joints, derived_joints, n_frames, start_s, **options
):
    chosen = round_trip.span(points, n_frames, start_s, stated)
    joints = [*derived_joints, *joints]
    return round_trip.table(points, known, joints, chosen, truth=truth, others=others, **options)


if __name__ == "__main__":
    run(main, snakemake)
