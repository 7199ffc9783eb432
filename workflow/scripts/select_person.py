"""Select the person who wears devices among those of the fixed cameras.

Reads 3D keypoints, writes them as one more source.
"""

from courtside.records.devices import device_motion
from courtside.records.keypoints import keypoints
from courtside.study.execution.script import run


def main(pose3d_npz, device_npz, *, person):
    points = keypoints.read_3d(pose3d_npz)
    device_motion.write(device_npz, device_motion.of_person(points, person))


if __name__ == "__main__":
    run(main, snakemake)
