"""T-poses and claps: found in every source, timed by the contact of the hands.

tpose: `find`, `rest`, `measure`
claps: `find`, `separation`, `wrist_distance`
contact_time: `fit`: the contact between frames, with its uncertainty
detect: `detect`: all sources of a take; `of_devices`; `events`, `wrists`: tables
"""
