"""Figures: the only room that uses matplotlib.

Most modules have `table` (the numbers drawn, which become the CSV, with the columns that
`docs/results.md` describes) and `draw`. Constants that place things on the page are chosen by eye.

style: What figures share
calibration, take, devices, comparison: Figures by subject
badminton: Counterparts of the figures of [Shishido2020]
"""
