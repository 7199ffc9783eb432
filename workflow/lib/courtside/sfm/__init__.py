"""Structure from motion: the only room that uses pycolmap.

usable, grid, bridging, pairs: judge; read, Grid; choose; pair_list: usable frames, bridging images,
    and the pairs to match
features, matching, database: extract, Group; match; new, working_copy, image_ids: COLMAP databases
mapping, registration: map_images; outcome, n_seen: models of the images, and what to film again
model, model_files: read, lens_prior; check: a model as a `calibration.bundle.problem.Network`
"""
