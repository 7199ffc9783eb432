"""Bundle adjustment of images, lenses and points, with clicked court points as control points.

problem: Network, see, residuals, linearised, without_points, with_points
solver: adjust, cost, normal_equations, mean, total, scaled, prior, Quadratic, Normal
elimination: normal_equations, Rows, Normal: the same of boards or wands in place of points
inverses: of_columns, pseudo_inverse: covariances
selection: thin, weigh, select, transform, add_control_points, marginalise, free_frame, between,
    images_only, with_lens_priors, centres, residual_spread
conversion: network_of, cameras_of, fixed_cameras: cameras as a network, and its images as cameras
variance_components: Factors, estimate, none, shift_columns
walk_parts: split, in_one_frame, centres, views, points, residual_spread
"""
