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

Axes, where the world has z up:
TRC, OpenSim (`.osim`, `.mot`): y up, X, Y, Z are the world's y, z, x; `trc.WORLD_AXES`.
C3D: the world's, z up, as X_SCREEN +X and Y_SCREEN +Z say; `c3d.write`.
CSV: the world's, z up; columns x_m, y_m, z_m; `tidy.table`.
BVH, GLB: y up, X, Y, Z are the world's x, z, -y; `trees.posing.turned` (a suit's BVH and GLB have
    the suit's own axes, y up).
Pose2Sim: cameras in the world's axes, TRC as above; `pose2sim.write_project`.
Cameras for EasyMocap and COLMAP: those of the world; `calibration.foreign`.
"""
