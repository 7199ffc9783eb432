"""What rules hand to each other: files with their units, checked when read.

npz: arrays with stated keys, shapes and kinds
tables: CSV tables
cameras, devices, keypoints: what is known of each; truth: of simulated sessions, for evaluation
"""
