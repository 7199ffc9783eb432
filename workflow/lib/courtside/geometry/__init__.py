"""Cameras and points: projection, triangulation, uncertainty."""
