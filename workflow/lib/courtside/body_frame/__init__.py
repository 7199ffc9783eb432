"""The body frame of a T-pose, and the frame that all sources of a take share.

frame: `anchors`, `at_tpose`, `axes`, `doubt`, `fixed`, `following`, `read_transform`, `BodyFrame`,
`Anchors`
common: `common`, `claps_of`, `aligned`, `counterpart`
"""
