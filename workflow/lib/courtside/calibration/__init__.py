"""Calibration of fixed cameras: files of other programs, chessboards, and the rooms below.

The rooms: court, bundle, planning, click_proposals, court_lines, file_check, records.

file_formats: read, rename, with_principal_points: calibrations by other programs
chessboard: find, calibrate: a lens from pictures of a chessboard
point_covariance: point_covariance, sensitivity, of_columns, pseudo_inverse, mahalanobis, ellipsoid
"""
