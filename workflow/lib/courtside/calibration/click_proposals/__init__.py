"""Court points proposed from the lines and posts in a picture.

proposals: propose, register, Proposals, Registered: points for confirmation, and the camera moved
    to fit the lines
refine_pose: refine, moved, shifts: the camera moved so that lines appear where they are seen
view, line_profiles, line_shift, post_tips: View, Ray; sample_stretch, tangent_and_normal; shift;
    axis, tip: measurements of lines and posts
"""
