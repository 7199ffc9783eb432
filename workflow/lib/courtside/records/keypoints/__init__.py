"""Skeletons, 2D and 3D keypoints, people, reasons of missing points.

keypoints: of one camera in 2D, of one take in 3D
people: which tracklet is which person
skeleton: joints, bones, groups
derived_joints: neck, head centre, mid-hip and the like
body_motion: a skeleton in the body's own frame and unit
missing_reason: codes and words
"""
