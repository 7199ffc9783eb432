"""The 3D viewer of a take, one HTML file.

viewer: `build`: the page
layers: `read`, `of_points`, `of_device`, `placed`: skeletons of one method, to be overlaid
packing: `integers`, `positions`, `sizes`, `ellipsoids`: arrays as short text
"""
