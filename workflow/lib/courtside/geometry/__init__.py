"""Geometry of cameras: projection, rotations, similarity, epipolar lines, triangulation."""
