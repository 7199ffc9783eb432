"""Geometry of cameras: projection, rotations, similarity, epipolar lines, triangulation.

camera: `Camera`, `plain`, `look_at`, `project`, `undistort`, `crop`, `scaled`, `check_size`, and
    TOML files
picture_size: `relation`, `scaled_size`, `advice`: a video's size against the calibrated one
camera_fields: checked numbers of calibration files (`numbers`, `pose`, `distortions`)
lens_fit: `five`, `fit`: lenses of other models as five coefficients
rotations: `rotation_from_rodrigues`, `rodrigues_from_rotation`, `interpolate`, `invert`, `composed`
similarity: `Sim3`, `umeyama`, `rigid`, `fit_many`, `kabsch`
robust_similarity: `fit`, `triples`: the similarity on which most points agree
interpolation: `linear`, `between`, `nearest`, `shares`
boxes: `usual_side`
epipolar: `straight_px`, `relative_pose`, `fundamental`, `lines`, `distance_px`, `ray_sines`
triangulation: `triangulate_robust`, `triangulate_plain`, `triangulate_all`, `triangulate`, `spread`
depth_registration: `rays`, `points_in_colour`
"""
