"""Measures of motion: filtering, speeds, distances, joint angles, centre of mass, smoothness.

filtering: `fill_gaps`, `leave_out_uncertain`, `zero_lag`, `runs`
skeleton_filter: `prepare`, `smooth` (of a take)
cutoffs: `by_group`, `choose_cutoff`, `table`, `read`
noise_propagation: `Noise`, `estimate`, `filtered_covariance`, `differentiate`
shared_errors: `Errors`, `of_person`, `alike` (what errors of joints have in common)
path_length: `measure`, `mean_norm`, `bridged` (the path in gaps)
joint_angles: `measure`, `between`, `trunk`
centre_of_mass: `shares`, `weights`, `place` (of one segment)
measures: `measure` (all of a take), `Filter`, `Person`, `Point`
joint_means: `table`
smoothness: `sparc`, `of_path`, `of_arcs`
wrist_arcs: `arcs`, `arcs_or_none`, `paths`, `distortion`
"""
