"""Correction of an inertial suit by what cameras see: segments, heading, slow drift."""
