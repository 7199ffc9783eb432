"""From the 2D keypoints of several cameras to 3D: clocks, sides, fusion, shake, correction.

resampling: `common_times`, `resample`, `nearest`: each camera's clock applied
common_views: `of_takes`, `of_footage`: limb joints of everybody in several takes; `of_limbs`:
    without a network's joint offsets
lost_cameras: `recover`: cameras in which nobody is associated, found again by people
self_calibration: `calibrate` (the entry), `tracks`, `guess`, `seen`: takes for a calibration from
    people alone
person_height: `in_pictures`: the height of a person in each picture, for limits in shares of it
left_right: `swapped_views`, `apply_swaps`, `exchange`: sides that a network confused
fusion: `triangulate_take`, `merge`, `with_cameras`: half bodies, the cameras' covariance
camera_shake: `steady`, `put_back`, `read_as_filmed`: shake removed from keypoints, and put back for
    pictures; `still`, `knocked`: tables of it; `find`, `say`: knocks described
offset_vectors: `every`, `of_body`, `of_views`, `of_each_view`, `views`, `names`, `size_of`: what
    joint offsets consist of
joint_correction: `estimate`, `correct`: a network's joint offsets; `keep`: constant limb lengths;
    `correct_then_filter`, `offsets`; `in_pictures`: keypoints without them
error_signs: `keypoints_used`, `of_points`: what a method sees of wrong joints
joint_errors: `fit`, `state`, `design`, `read`, `table`: errors that residuals do not show

Folder: `association` (who is who across cameras and over time).
"""
