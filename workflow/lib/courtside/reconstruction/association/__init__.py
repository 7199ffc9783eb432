"""Assign tracklets of all cameras to persons, over the whole take.

scale: `check`: whether people have the size of people
rows: `Rows`, `describe`: one camera's tracklets: body centres, sizes, cuts
candidates: `Candidates`, `find`, `rays`: places that rows of several views agree on; rays of others
linking: `link`, `costs`, `follow`: candidates over time to persons, frames of rows to persons
associate: `associate`: the whole method; `on_frames`: rows on a camera's own frames
"""
