"""Skeletons, 2D and 3D keypoints, people, reasons of missing points.

keypoints: `read_2d`, `write_2d`, `read_3d`, `write_3d`, `while_there`, `full_score`
people: `read`, `write`, `People.assigned`: which tracklet is which person
sightings: `read`, `stated`, `every_row`: where the user says that a person is
skeleton: `read`: joints, bones, groups; `heel_and_toe`
derived_joints: `read`, `of`, `append`, `combine`: neck, head centre, mid-hip and the like
body_motion: `read`, `write`: a skeleton in the body's own frame and unit
skeletal_motion: `read`, `write`: segments of constant shape, their rotations, joint angles
missing_reason: Codes and `WORDS`
"""
