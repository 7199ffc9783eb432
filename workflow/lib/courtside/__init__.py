"""Courtside: markerless 3D human motion in a gymnasium.

A room imports rooms of lower levels only; this is their order (tests/test_layers.py).

1. study: configuration, jobs and targets, execution, provenance
2. geometry, video, statistics: mathematics, pictures, dependent samples
3. records: what rules hand to each other
4. pose, calibration, devices, depth, inertial, kinematics: one subject each
5. sfm, reconstruction, body_model, events, footwork, strokes, exports, drafting, validation, pages:
   what joins them
6. quality, evaluation, body_frame: verdicts on takes; comparison with truth; sources in one frame
   of the body
7. synchronisation, figures: clocks of cameras and devices; drawings
"""
