"""Motion of devices, hierarchies of joints, clocks.

device_motion: `read`, `write`; `of_person`, `of_truth`: other sources as a device's motion
hierarchy: `forward`: forward kinematics of a posed tree of joints
clocks: `read`, `write`; `one_clock`, `stated`, `fault_line`, `wrist_error_mm`
"""
