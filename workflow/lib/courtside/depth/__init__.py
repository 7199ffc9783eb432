"""Joints of one colour picture lifted into 3D by a depth camera.

lifting: `lift_take`, `by_joint`, `summary`, `doubt`, `size_doubt`: 2D joints lifted by depth
surfaces: `Sampling`, `Sampler`: surfaces at the joints of one frame
single_view: `main_person`, `landmarks`, `doubt`, `doubt_of_one`: the network's own metric body
"""
