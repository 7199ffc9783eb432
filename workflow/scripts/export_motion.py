"""Export the skeletal motion of one person: motion -> OpenSim's .osim and .mot, BVH and GLB."""

from courtside.exports import bvh, opensim, opensim_model
from courtside.exports.trees import gltf, posing
from courtside.records.keypoints import skeletal_motion
from courtside.study.execution.script import run


def main(motion_npz, mot_path, osim_path, bvh_path, glb_path, *, person, sex_of, mass_kg_of):
    motion = skeletal_motion.read(motion_npz)
    column = motion.person_id.tolist().index(person)
    opensim.write_motion(mot_path, motion, column)
    known = {"mass_kg": mass_kg_of[person], "sex": sex_of[person]}
    opensim_model.write(osim_path, motion, column, **known)
    posed = posing.turned(motion.posed(column)[0])
    bvh.write(bvh_path, posing.even(posed))
    gltf.write(glb_path, posed, person)


if __name__ == "__main__":
    run(main, snakemake)
