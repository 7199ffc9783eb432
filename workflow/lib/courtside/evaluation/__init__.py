"""Comparison with truth: joints, detection, kinematics, sources, calibration, racket.

joints: `errors`, `table`, `distance_to_truth`, `limb_distances`, `distance_to_unused_view`: errors
    of 3D joints, against the truth and against other views
reliability: `counts`, `pooled`: how often ellipsoids hold, and how well outliers are
    flagged; not how well measures repeat
error_fit: `joints_of`, `sets_of_cameras`: what the model of joint errors is fitted on
detection: `evaluate`, `against`, `torso_px`, `is_hit`: errors of a network's 2D joints in the
    pictures
kinematics: `table`, `angles`: errors of paths and speeds, of joint angles
movement: contacts of feet, strokes
sources: `errors`, `table`, `split`: errors of devices and cameras, and their parts
round_trip: `table`, `distance_after`: the paper's table 1
camera_sets: `compare`, `gains`: fewer cameras, and other fusions
skin_depths: `estimate`: depth of joints behind the skin
calibration: `of_ties`, `of_known`, `score`: one trial of calibration; `over_volume`, `coverage`
racket: `calibrate`, `measure`, `score`, `rows`: one trial of measuring a racket
numbers: Numbers of the documents, and where each comes from
tables: Tables of the study from these

`docs/results.md` describes the columns of their tables.
"""
