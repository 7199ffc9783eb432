"""Calibration of fixed cameras: files of other programs, chessboards, and the rooms below."""
