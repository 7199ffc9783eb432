"""Figures of one take: overlay, skeletons, reprojection, visibility, kinematics, footwork, clocks.

overlay: `table`, `draw`: detected and reprojected joints on the pictures
skeletons, reprojection, visibility, kinematics, footwork, rally, strokes, camera_shake,
    clock_errors: `table`, `draw`
"""
