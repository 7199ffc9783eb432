"""Cameras from a wand: two or three markers at known distances, moved where several cameras see it.

points: `Wand`, `Seen`, `read`: the markers, and where cameras see them, from CSV files
start: `guess`, `triangulated`: cameras before they are adjusted, two first, then one after another
adjustment: `adjust`: cameras and all places of the wand together, with covariance
world: `of_floor`, `of_cameras`, `of_clicks`: the frame that cameras are stated in
timing: `late`: cameras that do not film at the time of the others
calibration: `calibrate`: all of these
quality: `summary`: how well the wand fits
"""
