"""Assign tracklets of all cameras to persons, over the whole take.

rows: Rows, describe (one camera's tracklets: body centres, sizes, cuts).
candidates: Candidates, find, rays (places that rows of several views agree on; rays of the rest).
linking: link, costs, follow (candidates over time to persons, frames of rows to persons).
associate: associate, on_frames (the whole method; rows on a camera's own frames).
"""
