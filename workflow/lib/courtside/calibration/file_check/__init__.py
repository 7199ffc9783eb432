"""A check of cameras that were calibrated elsewhere, by what they see.

court_place: `judge`, `locate`: cameras that see the painted lines of a court elsewhere
faults: `simple`, `fitted`: what usually goes wrong with such a file, and the cameras without it
residuals: `Rays`, `left_out`: how far views of static points and of people disagree
verdict: `Seen`, `judge`, `by_camera`: whether they disagree too much, and which fault explains it
"""
