"""Foot contacts with the floor: stances, steps, split steps, lunges, and their measures.

tracks: `tracks`: position and height of heel and toe of a foot, interpolated between frames
contact: `probability`: of contact, by a hidden Markov model
stances: `of_tracks`: onset and end of each stance with sigma
hops: `find`, `cut`, `lifted`: hops and jumps of both feet, which end and begin stances
kinds: `tables`: steps and events of a take
feet: `find`: all of this from the skeletons of a take
measures: `summary`, `corner`: counts, times, steps per corner, rallies
"""
