"""Figures of one take: overlay, skeletons, reprojection, visibility, kinematics, clocks."""
