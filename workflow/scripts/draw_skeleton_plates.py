"""Draw the skeletons of all sources in the T-pose.

Reads body motions, skeletons and derived joints; writes figure and CSV.
"""

from courtside.figures.devices import skeleton_plates
from courtside.figures.style import joint_map, style
from courtside.records.keypoints import body_motion, derived_joints, skeleton
from courtside.study.execution.script import run


def main(body_npz, skeleton_yaml, derived_yaml, pdf, png, csv, *, skeletons, kinds):
    known = [skeleton.read(path) for path in skeleton_yaml]
    bodies = [body_motion.read(path) for path in body_npz]
    rows = joint_map.rows(known, derived_joints.read(derived_yaml))
    plates = skeleton_plates.plates(bodies, known, skeletons, kinds)
    drawing = skeleton_plates.draw(plates, rows)
    style.save(drawing, skeleton_plates.table(plates, rows), pdf, png, csv)


if __name__ == "__main__":
    run(main, snakemake)
