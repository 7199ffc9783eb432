"""Assign tracklets of all cameras to persons, over the whole take.

scale: `check`: whether people have the size of people
rows: `Rows`, `describe`: one camera's tracklets: body centres, sizes, cuts; `separate`: pieces that
    show one body
candidates: `Candidates`, `find`, `rays`: positions on which rows of several views agree; rays
appearance: `learn`, `Looks`: colours of clothes as evidence of identity
linking: `link`, `costs`, `follow`: candidates over time to persons, frames of rows to persons
identity: `doubts`, `confidence`: where persons could have been exchanged, and the probability
lengths: `of_people`, `bones`: bone lengths, which distinguish people of different size
associate: `associate`: everybody found; `on_frames`: rows on a camera's own frames
everybody: `find`: everybody in the footage of a take
marks: `locate`, `timelines`: sightings of subjects, found again among the persons
naming: `name`: the subjects among the persons found; `lines`, `others`: what the log says
"""
