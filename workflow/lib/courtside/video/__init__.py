"""Video: reading, writing, frames of a walk, static pictures, movement of a fixed camera.

reader: probe, frame_times, frames, extract_frames, read_frame, write_png, sharpness.
packets, decoder: list_packets, pictures (every frame checked, damage reported).
glance: a quick look: size, frames, rate, the first picture made small.
writer: write_video (H.264, the same bytes for the same pictures, even or uneven times).
chapters: join (of a recording that its camera has cut up).
images, walk_frames: read, name_order; frames, spread, extract, read_photo (of video or photos).
static_picture: temporal_median, static_picture, check_still, check_kept_still, check_light.
camera_movement, shake_tracking: movement (between two pictures), measure_take (in every frame).
"""
