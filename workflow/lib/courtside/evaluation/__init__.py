"""Comparison with truth: joints, detection, kinematics, sources, calibration, racket."""
