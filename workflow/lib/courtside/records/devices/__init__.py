"""Motion of devices, hierarchies of joints, T-poses and claps, clocks.

device_motion: `read`, `write`; `of_person`, `of_truth`: other sources as a device's motion
hierarchy: `forward`: forward kinematics of a posed tree of joints
events: `read`, `write`: T-poses and claps of sources
clocks: `read`, `write`; `one_clock`, `stated`, `fault_line`
"""
