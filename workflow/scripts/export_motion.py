"""Export the skeletal motion of one person: motion -> OpenSim's .mot."""

from courtside.exports import opensim
from courtside.records.keypoints import skeletal_motion
from courtside.study.execution.script import run


def main(motion_npz, mot_path, *, person):
    motion = skeletal_motion.read(motion_npz)
    opensim.write_motion(mot_path, motion, motion.person_id.tolist().index(person))


if __name__ == "__main__":
    run(main, snakemake)
