"""Files between rules of the calibration.

support: `Support`: how much of the verified matches a map explains
tie_points: `Record`, `read`, `write`: tie-point constraints of one structure from motion
covariance: `CameraCovariance`, `of_network`, `read`, `write`: joint covariance of the fixed cameras
"""
