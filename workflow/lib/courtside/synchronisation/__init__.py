"""Offsets and drifts of clocks: cameras by what they see, devices by claps and motion.

cameras: synchronise (all fixed cameras against the first), place (coarse offsets).
devices: synchronise (all sources against the first), pair (claps of two devices).
clock_adjustment: adjust, with_prior (offsets and drifts together, with covariance).
epipolar, speed, motion_signals: the losses, with calibrated cameras, without, between devices.
smooth_tracks: build, sample (tracks with velocity and acceleration at any time).
"""
