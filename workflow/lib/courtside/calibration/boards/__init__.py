"""Calibration of several cameras from a board of known size that they see, and of one lens.

chessboard: `find`, `calibrate`, `solve`, `warnings`: a lens from pictures of a chessboard, of one
    camera alone
board: `Board`: a ChArUco board, chessboard or grid of tags: its corners, found in a picture
corners: `Corners`, `of_pictures`, `of_videos`, `of_table`: where cameras see a board's corners
start: `lens`, `poses`: lenses, cameras and boards before they are adjusted
adjustment: `calibrate`: all cameras and boards together, with covariance
quality: `summary`, `neighbours_mm`: how well the corners fit, and what is wrong with clocks, lenses
"""
