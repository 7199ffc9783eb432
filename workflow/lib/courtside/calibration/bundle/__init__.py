"""Bundle adjustment of images, lenses and points, with clicked court points as control points.

problem: Network, residuals, linearised, without_points, with_points
solver: adjust, cost, normal_equations, mean, scaled, Quadratic, Normal
selection: thin, weigh, select, transform, add_control_points, marginalise, free_frame, cameras,
    of_cameras
variance_components: Factors, estimate, none
walk_parts: split, centres, points, residual_spread
"""
