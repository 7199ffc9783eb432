"""Figures of devices, those of Homma 2023 among them.

thesis_fig3: `table`, `draw`, `draw_all`: the wrists seen along the trunk
wrist_distance: `read`, `table`, `draw`: the distance of the wrists, T-poses and claps
skeleton_plates: `plates`, `table`, `draw`: the skeletons of all sources
source_errors, smoothness_accuracy: `table`, `draw`: errors of sources and their parts; smoothness
    against accuracy
"""
