"""Export the skeleton of an inertial suit: its motion -> TRC, C3D, CSV, BVH and GLB."""

from courtside.exports import bvh, c3d, device, tidy, trc
from courtside.exports.trees import gltf
from courtside.records.devices import device_motion
from courtside.records.keypoints import skeleton
from courtside.study.execution.script import run


def main(device_npz, skeleton_yaml, trc_path, c3d_path, csv_path, bvh_path, glb_path, *, person):
    motion = device_motion.read(device_npz)
    points = device.points(motion, person)
    trc.write(trc_path, points, 0)
    c3d.write(c3d_path, points, 0)
    tidy.write(csv_path, points, 0)
    names = skeleton.read(skeleton_yaml)
    bvh.write(bvh_path, device.named(motion.posed, names))
    gltf.write(glb_path, device.named(device.performed(motion), names), person)


if __name__ == "__main__":
    run(main, snakemake)
