"""Export the skeletal motion of one person: .osim, .mot, BVH, GLB; of its joints TRC, C3D, CSV."""

from courtside.body_model import segments
from courtside.exports import bvh, c3d, opensim, opensim_model, tidy, trc
from courtside.exports.trees import gltf, posing
from courtside.records.keypoints import keypoints, skeletal_motion
from courtside.study.execution.script import run


def main(
    motion_npz, pose3d_npz, mot_path, osim_path, trc_path, c3d_path, csv_path, bvh_path, glb_path,
    *, person, sex_of, mass_kg_of,
):  # fmt: skip
    points, motion = keypoints.read_3d(pose3d_npz), skeletal_motion.read(motion_npz)
    column = points.person_id.tolist().index(person)
    trc.write(trc_path, points, column)
    c3d.write(c3d_path, points, column)
    tidy.write(csv_path, points, column)
    column = motion.person_id.tolist().index(person)
    opensim.write_motion(mot_path, motion, column)
    known = {"mass_kg": mass_kg_of[person], "sex": sex_of[person]}
    opensim_model.write(osim_path, motion, column, **known)
    t_pose = segments.model().rest
    posed = posing.turned(posing.rested(motion.posed(column)[0], t_pose))
    bvh.write(bvh_path, posing.even(posed), only_root_moves=True)
    gltf.write(glb_path, posed, person, zero_s=motion.time_s[0])


if __name__ == "__main__":
    run(main, snakemake)
