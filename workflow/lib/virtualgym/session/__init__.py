"""Film a virtual session and its takes: videos, clicks, device recordings, truth.

- session: `Settings`, `simulate`, `plan`, `backdrops`
- take: `TakeSettings`, `simulate_take`, `perform`
- take_devices: `build`, `record`, `of_take`
- clicks: `simulate`, `draws` (court points); `of_camera`, `write`, `draw`, `click`, `swing`
(rackets) - parallel: `workers`, `stream`, `generator`
"""
