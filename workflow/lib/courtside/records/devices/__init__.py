"""Motion of devices, hierarchies of joints, clocks.

device_motion: a skeleton of a device, or another source as such a one
hierarchy: forward kinematics of a posed tree of joints
clocks: of cameras and devices, with what is known of each
"""
