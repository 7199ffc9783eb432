"""From 2D keypoints of several cameras to 3D: clocks applied, sides, fusion, shake, correction.

resampling: common_times, resample, nearest (each camera's clock applied).
left_right: swapped_views, apply_swaps (sides that a network confused).
fusion: triangulate_take, merge, with_cameras (triangulation, half bodies, the cameras' covariance).
camera_shake: steady, put_back, find, say (shake removed from keypoints, knocks described).
joint_correction: estimate, correct, keep (a network's joint offsets; constant limb lengths).
association: who is who across cameras and over time.
"""
