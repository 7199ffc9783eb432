"""Figures of agreement between networks, and of measures over sessions.

agreement: `read`, `choose`, `draw`: limits of agreement of two networks
archive: `table`, `draw`: measures of one subject over sessions
"""
