"""Offsets and drifts of clocks: cameras by what they see, devices by claps and motion."""
