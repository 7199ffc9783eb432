"""Verdicts on takes: shares, errors, and tests of why a camera disagrees with the others.

seen: `gather`, `without`, `disagreement`: a take on common times, persons by the other cameras
measures: `of_camera`, `of_person`: shares, errors in heights of the person, limb lengths
causes: `find`: detection, identity, clock, calibration or another camera's video, by test
moved_cameras: `find`: the pose of a camera by the people whom the others place
body_sizes: `doubt`: bodies too large or too small for people
calibration_doubts: `read`: what a calibration itself, and checks of it, say against its
    cameras
verdict: `judge`, `level`: good, doubtful or failed, in words
"""
