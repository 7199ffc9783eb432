"""Cameras refined by the people that they film, or calibrated from people alone.

views: `Seen`, `Limits`, `joined`, `placed`, `check`, `longest_way`: joints at common times, blocks
    of time, bad input
prior: `stated`, `knowledge`: what is known of cameras before
adjustment: `refine`, `Clicks`, `court_clicks`: cameras and joints adjusted together
held_out: `score`, `verdicts`, `better`: whether cameras are better, by what the fit did not see
knocks/: cameras knocked during a take or between takes have two poses
resection: `lost`, `expected`, `find`, `widened`, `line`: cameras that agree with nobody
relative_poses: `pair`, `pose`: relative poses of cameras from tracks of unknown persons
metric_scale: `Scale`, `Body`, `KnownLength`, `of_clicks`, `find`, `combined`, `by_lengths`,
    `by_heights`: the scale from stated heights and known lengths
world_frame: `floor`, `frame_error`, `of_shape`: the floor from feet or points, covariance
warnings: `find`: warnings about cameras from people alone
from_nothing: `guess`, `adjust`, `check`, `summary`: cameras from people alone
refinement: `refine`, `unchanged`, `without_knocks`: which cameras are taken, what was wrong, the
    table
"""
