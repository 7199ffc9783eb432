"""Measures of motion: filtering, speeds, distances, joint angles, centre of mass, smoothness."""
