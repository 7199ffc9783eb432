"""Clock offsets and drifts: of cameras from their views, of devices from claps and motion.

cameras: `of_take`, `synchronise`: all fixed cameras against the first; `place`: coarse offsets
devices: `synchronise`: all sources against the first; `pair`: claps of two devices
clock_doubts: `refuse_other_claps`, `doubts`: what speaks against a device's clock
clock_adjustment: `adjust`, `with_prior`: offsets and drifts together, with covariance
lost_frames: `doubt`: whether a part of a camera's video has another offset than its clock
epipolar, speed: `Epipolar`, `Speeds`: the losses with calibrated cameras, and without
motion_signals: `Signals`: the loss between devices; `common_axes`
smooth_tracks: `build`, `sample`: tracks with velocity and acceleration at any time
"""
