"""Import the skeleton that a device gives by itself.

Reads mocopi's BVH, Nuitrack's JSON or CSV; writes its motion.
"""

from courtside.devices import open_motion
from courtside.records.devices import device_motion
from courtside.records.keypoints import skeleton
from courtside.study.execution.script import run


def main(recording, skeleton_yaml, motion_npz, *, device, kind, unit=None, angles=None):
    joints = skeleton.read(skeleton_yaml)
    motion = open_motion.read(recording, joints, device=device, kind=kind, unit=unit, angles=angles)
    device_motion.write(motion_npz, motion)


if __name__ == "__main__":
    run(main, snakemake)
