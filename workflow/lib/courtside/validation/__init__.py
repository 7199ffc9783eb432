"""Checks of sessions before any job: sizes, rates, copies, exchanged cameras, clicked points.

check: `check`: all sessions of a study; every fault in one `InputError`
bodies: `remarks`, `unlike`, `compared`: unlikely masses; persons who differ; nobody to compare
boards: `remarks`: a board of an impossible size; `unread_lenses` from chessboards
calibrated: `faults`: cameras and sizes against the calibration file, sizes of a camera's recordings
views: `faults`: one view given for two cameras, exchanged cameras
lengths: `faults`, `remarks`: numbers of frames and rates of the cameras of a take
points: `check`: clicked points: their file, their pictures, their number
devices: `faults`: recordings of devices that cannot be imported
keypoint_folders: `check`: another program's 2D keypoints: their frames, skeletons and cameras
stated_times: `faults`, `remarks`: times that a session states, against its videos
providers: `check`: execution providers of pose networks that the installed onnxruntime lacks
remembered: `Remembered`: looks at files, and files that were read, kept from run to run
"""
