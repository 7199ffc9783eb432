"""Correction of an inertial suit by what cameras see: segments, heading, slow drift.

correction: `correct` (the entry)
fit: `Fit`
vision: `observe`, `Seen`, `Noise`, `estimate_noise`, `stated_noise`
segments: `segments_of`, `Segments`, `Model`, `Frames`
heading: `estimate`, `Alignment`, `turn_path`
splines: `Basis`, `basis_over`, `precision`, `gather`, `solve`, `Solution`
report: `CorrectionReport`, `describe`, `doubts`
"""
