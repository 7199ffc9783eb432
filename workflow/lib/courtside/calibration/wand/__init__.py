"""Cameras from a wand: two or three markers at known distances, moved where several cameras see it.

points: `Wand`, `Seen`, `read`: the markers, and where cameras see them, from CSV files
start: `guess`: cameras before they are adjusted, from pairs of them and one after another
adjustment: `adjust`: cameras and all places of the wand together, with covariance
world: `of_floor`, `of_cameras`, `of_clicks`: the frame that cameras are stated in
calibration: `calibrate`, `said`: cameras from a wand, and how well it fits
"""
