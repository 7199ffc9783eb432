"""Drawings; the only room that uses matplotlib."""
