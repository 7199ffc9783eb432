"""A check of cameras that were calibrated elsewhere, by what they see.

court_place: `judge`, `locate`: cameras that see the painted lines of a court elsewhere
exchanged_videos: `match`, `judge`: whether each video is of its camera, by features of the hall
faults: `simple`, `fitted`: what usually goes wrong with such a file, and the cameras without it
inverted_poses: `judge`: whether poses are stated the other way round
residuals: `Rays`, `left_out`: how far views of static points and of people disagree
stated: `check`: what no calibration may state, such as one pose of two cameras
upright: `warning`: whether another axis than z is up
verdict: `Seen`, `judge`, `by_camera`: whether they disagree too much, and which fault explains it
"""
