"""Cameras refined, or found from nothing else, by the people that they film.

views: `Seen`, `joined`, `placed`, `check`: joints at common times, blocks of time, bad input
prior: `stated`, `knowledge`: what is known of cameras before
adjustment: `refine`, `Clicks`, `court_clicks`, `Limits`: cameras and joints adjusted together
held_out: `score`, `verdicts`, `better`: whether cameras are better, by what the fit did not see
knocks: `find`, `in_all`, `between`, `undone`, `row`, `lines`: cameras knocked have two poses
resection: `lost`, `find`, `widened`, `line`: cameras that agree with nobody, found again
relative_poses: `pair`, `pose`: where cameras stand to each other, by tracks of unknown persons
world_frame: `metres`, `floor`, `of_shape`: unit by stated heights, floor by feet, covariance
from_nothing: `guess`, `adjust`, `said`: cameras from people alone
refinement: `refine`, `unchanged`: which cameras are taken, what was wrong, the table
"""
