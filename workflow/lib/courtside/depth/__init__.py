"""Joints of one colour picture lifted into 3D by a depth camera."""
