"""Courtside: markerless 3D human motion in a gymnasium.

Rooms import one another in this order only:
study, then geometry and records, then sfm, pose, devices and motion, then exports, virtual,
figures and pages.
"""
