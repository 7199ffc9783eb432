"""Foot contacts with the floor: stances, steps, split steps, lunges, and their measures.

tracks: `tracks`: heel and toe of a foot, between frames too, above the floor
contact: `probability`: that a foot stands, by a hidden Markov model
stances: `of_tracks`: onset and end of each stance with sigma
kinds: `tables`: steps and events of a take
feet: `find`: all of this from the skeletons of a take
measures: `summary`, `corner`: counts, times, steps per corner, rallies
"""
