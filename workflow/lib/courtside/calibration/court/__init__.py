"""Calibration by a known court: clicks, alignment, joint adjustment, resection, checks.

court: read, of_places, to_line_centres, Court, ClickedPoints
line_edges: named, post, middle_line, stretches, paint: edges and areas of the painted lines;
    crossings, click_covariances, click_variances: how exactly clicks show where edges cross
sfm_alignment: reconstruct, align, paper_frame, check, stretch, refuse_misplaced_cameras
joint_adjustment: condense, condense_free, solve, solve_by_edges, solve_by_scatter,
    solve_with_factors, free, Ties, Solution: tie points with clicked court points
resection: dlt, nonlinear: one camera from known points, by `one_camera`
known_points: method, calibrate, cameras: all cameras from known points, each by itself
points_alone: calibrate, summary: all cameras from points alone, together
misfits: fitted: the same, and what is wrong with clicks that fit no camera
place_checks: read, as_court, shifts, check_cameras: the points of a session; places that are
    shifted, mirrored or in another unit
click_checks: leave_one_out, find_wrong_clicks, inward_shift, inward_shift_of_points, check
quality: check_cameras, adjust_and_check, check_maps, map_warning, one_place, sunken,
    leave_one_out_errors, expected_cm, expected_volume
"""
