"""Film a virtual session and its takes: videos, clicks, device recordings, truth.

session: `Settings`, `simulate`, `plan`, `backdrops`
take: `TakeSettings`, `simulate_take`, `perform`
take_devices: `build`, `record`, `of_take`
click_model: `covariance`, `person`, `bias_px`, `behind_net`
clicks: `click_points`, `click_court`, `clicks_of_persons`, `clicks_of_strengths`
rackets: `of_camera`, `write`, `click_racket`, `swing_of_run`
parallel: `workers`, `stream`, `generator`
"""
