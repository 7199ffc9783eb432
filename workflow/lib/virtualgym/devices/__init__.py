"""Simulated devices: depth camera, chessboard, inertial suit and its errors."""
