"""The truth of simulated sessions and takes; only evaluation reads it.

session_truth: cameras, walks, court points
take_truth: joints, rackets, clocks, events, shake, devices
"""
