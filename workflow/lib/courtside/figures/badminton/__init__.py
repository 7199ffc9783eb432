"""Figures beside those of the badminton paper, and accuracy with two to four cameras.

fig05, fig06, fig08, fig09, fig10, fig11, fig12, tab01: `table`, `draw`: the counterpart of that
    figure or table of [Shishido2020]
three_cameras: `table`, `draw`: errors with two, three and four cameras
"""
