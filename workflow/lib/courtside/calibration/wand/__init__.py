"""Camera calibration with a wand: two or three markers at known distances on a stick.

points: `Wand`, `Seen`, `read`: the markers and their positions in the pictures, from CSV files
start: `guess`, `placed`, `triangulated`: initial cameras, two first, then one after another
culprit: `named`: the camera that does not agree with the others, each left out in turn
adjustment: `adjust`: bundle adjustment of cameras and wand positions, with covariance
world: `of_floor`, `of_cameras`, `of_clicks`: the world frame of the cameras
floor_errors: `covariances`: errors of cameras and frame by the markers on the floor
timing: `delays`: delays of cameras relative to the others
calibration: `calibrate`: all these steps together
quality: `summary`: fit of the markers by camera, and warnings
"""
