"""Files between rules of the calibration: tie-point constraints, joint covariance."""
