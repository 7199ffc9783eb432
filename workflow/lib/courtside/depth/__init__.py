"""Joints of one colour picture in 3D, by a depth camera or by the network alone.

lifting: lift_take, by_joint, summary (2D joints lifted by depth).
surfaces: Sampling, Sampler (surfaces at the joints of one frame).
single_view: main_person, landmarks (the network's own metric body).
"""
