"""Figures of calibrations: court points, error map, coverage, conditions, growth, plan."""
