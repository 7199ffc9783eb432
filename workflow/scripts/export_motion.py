"""Export the skeletal motion of one person: motion -> OpenSim's .mot, BVH and GLB."""

from courtside.exports import bvh, opensim
from courtside.exports.trees import gltf, posing
from courtside.records.keypoints import skeletal_motion
from courtside.study.execution.script import run


def main(motion_npz, mot_path, bvh_path, glb_path, *, person):
    motion = skeletal_motion.read(motion_npz)
    column = motion.person_id.tolist().index(person)
    opensim.write_motion(mot_path, motion, column)
    posed = posing.turned(motion.posed(column)[0])
    bvh.write(bvh_path, posing.even(posed))
    gltf.write(glb_path, posed, person)


if __name__ == "__main__":
    run(main, snakemake)
