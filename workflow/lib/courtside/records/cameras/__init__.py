"""Clicks, frames, shake and footage of cameras.

clicks, click_proposals: `read`, `write`: court points clicked, and those proposed for clicking;
    `clicks.read_static`: points at rest
placed_points: `read`: points with your own coordinates
frame_table, frame_times, shake_table: `read`, `write`: CSV tables of frames;
    `frame_times.on_device_clock`, `shake_table.read_all`
knock_table: `read`, `write`: two poses of a camera that was knocked during a take
footage: `read`, `between`: a take by its cameras
image_names: `static`, `frame`, `are_static`: names in COLMAP's models
"""
