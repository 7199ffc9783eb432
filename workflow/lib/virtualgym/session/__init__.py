"""Film a virtual session and its takes: videos, clicks, device recordings, truth.

session: `Settings`, `simulate`, `plan`, `backdrops`
take: `TakeSettings`, `simulate_take`, `perform`
take_devices: `build`, `record`, `of_take`
click_model: `covariance`, `person`, `bias_px`, `behind_net`
clicks: `click_points`, `click_court`, `clicks_of_persons`, `clicks_of_strengths` (court points);
    `of_camera`, `write`, `click_racket`, `swing` (rackets)
parallel: `workers`, `stream`, `generator`
"""
