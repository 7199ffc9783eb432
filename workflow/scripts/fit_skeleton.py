"""Fit the skeletal model to a take.

Reads raw keypoints, which it corrects as `correct_joints` does but does not filter: the fit has the
filter's cut-offs in its prior. Of the corrected skeletons it takes what the cameras' errors are; of
their contacts, which heels and toes stand.
"""

from courtside.body_model import take
from courtside.exports import measures
from courtside.geometry import camera
from courtside.kinematics import cutoffs, skeleton_filter
from courtside.reconstruction import joint_correction
from courtside.records import footwork, tables
from courtside.records.keypoints import keypoints, skeletal_motion, skeleton
from courtside.study.execution.script import run


def main(paths, joints_npz, motion_npz, angles_csv, *, max_gap_s, sex_of, height_m_of, recorded):
    raw = skeleton_filter.prepare(keypoints.read_3d(paths.raw), max_gap_s)
    cameras, offsets = camera.read_toml(paths.cameras), joint_correction.read(paths.offsets)
    points = joint_correction.correct(raw, offsets, sex_of, cameras)
    shape, (chosen, _) = skeleton.read(paths.skeleton), cutoffs.read(paths.cutoffs)
    cutoff_hz = dict(zip(shape.joints, shape.by_group(chosen), strict=True))
    contacts = footwork.read_contacts(paths.contacts)
    fits = take.people(points, cutoff_hz, height_m_of, contacts, recorded=recorded)
    keypoints.write_3d(joints_npz, take.joints(keypoints.read_3d(paths.corrected), fits))
    motion = take.motion(points, fits, max_gap_s)
    skeletal_motion.write(motion_npz, motion)
    tables.write(angles_csv, measures.angles(motion))


if __name__ == "__main__":
    run(main, snakemake)
