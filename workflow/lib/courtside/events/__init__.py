"""T-poses and claps: found in every source, timed by the contact of the hands.

tpose: find, rest, best, measure.
claps: find, candidates, separation, wrist_distance.
contact_time: fit (the contact between frames, with its uncertainty).
detect: shown (all sources of a take), wrists, events, checks (tables).
"""
