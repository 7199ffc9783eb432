"""A skeletal model of the body fitted to joints: constant bones, joint angles, uncertainty.

segments: `model`, `segment_of`: segments, axes of joints, ranges and priors
pose: `forward`, `derivatives`: forward kinematics over all frames
start: `pose`: where the fit starts
shape: `lengths`, `of_lengths`: a subject's segments and the points on them
held: `of_contacts`: heels and toes of standing feet keep their places
fit: `fit`: all frames together, Gauss-Newton on a banded system
angles: `measure`, `of_fit`: joint angles by name, plane and sign
take: `people`, `person`, `joints`, `motion`: a take's record fitted
source: `observed`, `even`: the record of a device to be fitted
"""
