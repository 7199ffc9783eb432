"""The 3D viewer of a take, one HTML file."""
