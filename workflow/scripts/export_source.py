"""Export the joints of a depth camera or a single video as a moving tree: motion -> BVH and GLB."""

from courtside.exports import bvh
from courtside.exports.trees import gltf, posing
from courtside.records.devices import device_motion
from courtside.records.keypoints import skeleton
from courtside.study.execution.script import run


def main(device_npz, skeleton_yaml, bvh_path, glb_path, *, person):
    motion, joints = device_motion.read(device_npz), skeleton.read(skeleton_yaml)
    kept = motion.performed
    upright = device_motion.upright(motion)
    posed = posing.turned(posing.of_joints(motion.time_s[kept], upright[kept], joints))
    bvh.write(bvh_path, posing.even(posed), only_root_moves=True)
    gltf.write(glb_path, posed, person)


if __name__ == "__main__":
    run(main, snakemake)
