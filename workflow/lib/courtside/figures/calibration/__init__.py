"""Figures of calibrations: court points, error map, coverage, conditions, worlds, growth, plan.

court_points, error_map, coverage, conditions, worlds, plan: `table`, `draw`
growth: `table`, `exponents`, `draw`: run times and their power laws
"""
