"""Skeletons over time: resampling, gaps, filters."""
