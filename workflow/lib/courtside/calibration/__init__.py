"""Calibration of fixed cameras: court points and lines, walks, boards, people, imported files.

The rooms: boards, court, court_lines, bundle, planning, click_proposals, file_check, foreign,
people, records, wand.

file_formats: read, read_session, rename, check_apart, known_lenses, with_principal_points:
    calibrations by other programs
arrangement: `expected`: errors of how cameras stand to each other without a court
robust_poses: essential, relative, resected, placed: poses of cameras by RANSAC or by all points
point_covariance: point_covariance, sensitivity, field, shown, views
vertical: upright, axes, up_in_pictures, error_of_pictures, is_unknown, words, sigma_deg: z up as
    in the pictures
"""
