"""Figures: the only room that uses matplotlib."""
