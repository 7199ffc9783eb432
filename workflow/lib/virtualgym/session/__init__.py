"""Film a virtual session and its takes: videos, clicks, device recordings, truth.

session: `Settings`, `simulate`, `plan`, `backdrops`
take: `TakeSettings`, `simulate_take`, `perform`
take_devices: `build`, `record`, `of_take`
clicks: `click_points`, `clicks_of_persons` (court points); `of_camera`, `write`, `click_racket`,
    `swing` (rackets)
parallel: `workers`, `stream`, `generator`
"""
