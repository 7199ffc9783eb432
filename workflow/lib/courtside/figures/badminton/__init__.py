"""Figures and table of Shishido & Kitahara 2020, reproduced."""
