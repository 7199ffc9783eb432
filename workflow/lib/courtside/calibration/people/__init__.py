"""Cameras refined, or found from nothing else, by the people that they film.

views: `Seen`, `joined`, `placed`, `check`: joints at common times, blocks of time, bad input
prior: `stated`, `knowledge`: what is known of cameras before
adjustment: `refine`, `Clicks`, `court_clicks`, `Limits`: cameras and joints adjusted together
held_out: `score`, `verdicts`, `better`: whether cameras are better, by what the fit did not see
knocks: `find`, `in_all`, `between`, `undone`, `row`, `lines`: cameras knocked have two poses
resection: `lost`, `find`, `widened`, `line`: cameras that agree with nobody, found again
relative_poses: `pair`, `pose`: where cameras stand to each other, by tracks of unknown persons
unit: `Body`, `KnownLength`, `of_clicks`, `find`: metres by stated heights and known lengths
world_frame: `floor`, `axes`, `of_shape`: floor by feet or points, axes, covariance
doubts: `lines`: what is doubtful about cameras from people alone
from_nothing: `guess`, `adjust`, `summary`: cameras from people alone
refinement: `refine`, `unchanged`: which cameras are taken, what was wrong, the table
"""
