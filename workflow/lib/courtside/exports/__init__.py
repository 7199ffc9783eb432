"""Files for other programs: TRC, C3D, BVH, GLB, CSV, Pose2Sim and OpenSim, cameras, videos.

trc, c3d, bvh, tidy: `write`: one person or body in that form (`tidy`: CSV); `trc.read`.
device: `points`, `named`, `performed`: data of an inertial suit for these formats.
trees: joints as trees of bones; GLB.
measures: `frames`, `summary`, `angles`: tables of kinematics.
pose2sim, opensim, markers: `write_project`, `read_takes`, `write_markers`, `write_motion`: for
    Pose2Sim and OpenSim, with their joint names.
opensim_model: `write`, `coordinates`: a subject's skeletal model for OpenSim.
camera_files: `write`: cameras for EasyMocap and COLMAP.
overlay_video: `track`, `pictures`: a take's video with skeletons drawn in.
"""
