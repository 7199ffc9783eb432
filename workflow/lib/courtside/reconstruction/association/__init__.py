"""Assign tracklets of all cameras to persons, over the whole take.

scale: `check`: whether people have the size of people
rows: `Rows`, `describe`: one camera's tracklets: body centres, sizes, cuts
candidates: `Candidates`, `find`, `rays`: places that rows of several views agree on; rays of others
appearance: `learn`, `Looks`: how colours of clothes tell people apart
linking: `link`, `costs`, `follow`: candidates over time to persons, frames of rows to persons
identity: `doubts`, `confidence`: where somebody could have been exchanged, and how likely
lengths: `of_people`, `bones`: lengths of bones, by which people of different size differ
associate: `associate`: everybody found; `on_frames`: rows on a camera's own frames
everybody: `find`: everybody in the footage of a take
marks: `locate`, `timelines`: sightings of subjects, found again among the persons
naming: `name`: the subjects among the persons found; `lines`, `others`: what the log says
"""
