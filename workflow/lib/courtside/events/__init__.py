"""Detection of T-poses and claps in every source; the contact of the hands times a clap.

tpose: `find`, `rest`, `measure`
claps: `find`, `separation`, `wrist_distance`
contact_time: `fit`: the contact between frames, with its uncertainty
detect: `detect`: all sources of a take; `of_devices`; `events`, `wrists`: tables
"""
