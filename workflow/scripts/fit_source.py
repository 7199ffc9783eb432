"""Fit the skeletal model to a source of a take: device motion -> joints, motion, angles."""

from courtside.body_model import source, take
from courtside.exports import device as device_export
from courtside.exports import measures
from courtside.kinematics import cutoffs, filtering
from courtside.records import tables
from courtside.records.devices import device_motion
from courtside.records.keypoints import keypoints, skeletal_motion, skeleton
from courtside.study.execution.script import run


def main(
    device_npz, skeleton_yaml, joints_npz, motion_npz, angles_csv,
    *, person, height_m, sigma_m, max_gap_s, cutoff_hz,
):  # fmt: skip
    motion, shape = device_motion.read(device_npz), skeleton.read(skeleton_yaml)
    seen = source.observed(device_export.points(motion, person), sigma_m)
    points = filtering.fill_gaps(seen, max_gap_s)
    chosen = cutoffs.by_group(points, shape, cutoff_hz, path=device_npz)
    by_group = {group: choice.cutoff_hz for group, choice in chosen.items()}
    by_joint = dict(zip(shape.joints, shape.by_group(by_group), strict=True))
    fits = take.people(points, by_joint, {person: height_m})
    keypoints.write_3d(joints_npz, take.joints(points, fits))
    found = take.motion(points, fits, max_gap_s)
    skeletal_motion.write(motion_npz, found)
    tables.write(angles_csv, measures.angles(found))


if __name__ == "__main__":
    run(main, snakemake)
