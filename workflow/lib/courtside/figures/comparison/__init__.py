"""Figures of agreement between networks, and of measures over sessions."""
