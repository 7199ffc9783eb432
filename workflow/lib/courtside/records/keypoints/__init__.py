"""Skeletons, 2D and 3D keypoints, people, reasons of missing points."""
