"""Verdicts on takes: shares, errors, and tests of why a camera disagrees with the others.

seen: `gather`, `without`, `disagreement`: a take on common times, persons by the other cameras
measures: `of_camera`, `of_person`: shares, errors in heights of the person, limb lengths
causes: `find`: detection, identity, clock, calibration or another camera's video, by test
doubts: `read`: what checks of a calibration, and a calibration itself, say against its cameras
verdict: `judge`, `level`: good, doubtful or failed, in words
"""
