"""Simulated devices: depth camera, chessboard, wand, inertial suit.

- depth_camera: `DepthCamera`, `Recorder`, `of_hall`, `of_athletes`
- depth_noise: `DepthErrors`, `Sensor`
- realsense_writer: `write`: recordings that the camera's own program reads
- inertial_suit: `InertialSuit`, `record`, `Recording`
- inertial_errors: `Errors`, `STRENGTHS`, `wandering`, `disturbance`
- inertial_estimate: `guess`, `Turns`
- mocopi_skeleton: `Rig`, `SHARED`
- wand: `swing`, `film`: a wand and its markers in the pictures
- chessboard: `simulate`, `picture`, `poses`, `corners_m`
"""
