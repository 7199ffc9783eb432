"""The virtual gymnasium: halls, players, recordings with exact truth, from a YAML file and seed.

hall, body, movement: what stands in the hall, who moves in it, and how
cameras, rendering: where cameras stand and how they shake; pictures with exact truth
devices: inertial suits, depth cameras, chessboards
session: videos, clicks, device recordings and truth of a session and its takes
presets: named settings of halls, players and cameras
worlds: what real halls and cameras do and no calibration knows of, by strength
"""
