"""Detection of strokes in skeletons, with time, hand and position; reactions to the opponent.

local_fit: `fit`: position, velocity and acceleration of a path, robust to lost joints
signals: `of_person`: reach, height and speed of both wrists, and the trunk
detect: `find`, `playing_hand`, `table`: strokes with their times and sigmas
cues: `times`: the time of a stroke from each published hypothesis
reaction: `join`: from the opponent's stroke to the split step and to the first step
"""
