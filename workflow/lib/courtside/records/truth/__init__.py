"""The truth of simulated sessions and takes; only evaluation reads it.

session_truth: `read`, `write`: cameras, walks, court points
take_truth: `read`, `write`: joints, rackets, clocks, events, shake, devices
"""
