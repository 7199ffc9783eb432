"""Structure from motion: the only room that uses pycolmap.

usable, grid: `judge`, `Grid`: usable frames of a walk
bridging, pairs: `choose`, `pair_list`: bridging images, and the pairs to match
features, matching: `extract`, `Group`, `match`: COLMAP's databases
database: `new`, `working_copy`, `image_ids`
mapping, registration: `map_images`; `outcome`, `n_seen`: models of the images, what to film again
two_views: `explained`, `with_known_lenses`: how much of the matches a map explains
model, model_files: `read`, `views`, `lens_prior`, `check`: a model as a `bundle.problem.Network`
"""
