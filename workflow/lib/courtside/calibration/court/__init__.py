"""Calibration by a known court: clicks, alignment, joint adjustment, resection, checks."""
