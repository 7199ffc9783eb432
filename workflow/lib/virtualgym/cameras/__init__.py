"""Cameras of a virtual session: layouts of fixed ones, the walked one's path, camera shake.

- layouts: `fixed_cameras`, `LAYOUTS`, `lens`, `court_centre`
- walk_path: `plan`, `worsened`, `Walk`, `way`
- lens_errors: `added`
- row_warp: `shifts`
- chebyshev: `nodes`, `to_pixels`
- camera_shake: `Shake`, `Shaking`, `Warp`, `turned`
"""
