"""Figures of agreement between networks, of stated errors, and of measures over sessions.

agreement: `read`, `choose`, `draw`: limits of agreement of two networks
archive: `table`, `draw`: measures of one subject over sessions
networks: `table`, `draw`: networks on the same frames
reliability: `table`, `draw`: how far the stated errors of joints hold
"""
