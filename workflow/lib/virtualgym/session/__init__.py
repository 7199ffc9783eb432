"""A virtual session and its takes: videos, clicks, devices, truth."""
