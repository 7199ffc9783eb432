"""Import the skeleton that a device gives by itself.

Reads mocopi's BVH, Nuitrack's JSON or CSV; writes its motion.
"""

from courtside.devices import mocopi, nuitrack
from courtside.records.devices import device_motion
from courtside.records.keypoints import skeleton
from courtside.study.execution.script import run


def main(recording, skeleton_yaml, motion_npz, *, device, kind, unit=None, angles=None):
    joints = skeleton.read(skeleton_yaml)
    if kind == "inertial":
        motion = mocopi.read(recording, joints, source=device, unit=unit, angles=angles)
    else:
        motion = nuitrack.read(recording, joints.joints, device, unit=unit)
    device_motion.write(motion_npz, motion)


if __name__ == "__main__":
    run(main, snakemake)
