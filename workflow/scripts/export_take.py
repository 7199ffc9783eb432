"""Export one person of one take: 3D keypoints -> TRC, C3D, CSV, BVH and GLB."""

from courtside.exports import bvh, c3d, tidy, trc
from courtside.exports.trees import gltf, posing
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.execution.script import run


def main(pose3d_npz, skeleton_yaml, trc_path, c3d_path, csv_path, bvh_path, glb_path, *, person):
    points = keypoints.read_3d(pose3d_npz)
    column = points.person_id.tolist().index(person)
    trc.write(trc_path, points, column)
    c3d.write(c3d_path, points, column)
    tidy.write(csv_path, points, column)
    joints = skeleton.read(skeleton_yaml)
    posed = posing.turned(posing.of_joints(points.time_s, points.xyz[column], joints))
    bvh.write(bvh_path, posing.even(posed), only_root_moves=True)
    gltf.write(glb_path, posed, person, zero_s=points.time_s[0])


if __name__ == "__main__":
    run(main, snakemake)
