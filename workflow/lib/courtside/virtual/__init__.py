"""Simulation: a ray-cast gymnasium with exact truth; nothing but its own scripts imports it."""
