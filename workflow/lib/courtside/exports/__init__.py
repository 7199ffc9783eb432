"""Files for other programs: TRC, C3D, BVH, CSV, Pose2Sim and OpenSim, videos."""
