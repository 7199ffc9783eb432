"""Readers for files of devices and other programs: BVH, mocopi, Nuitrack, OpenPose, depth.

bvh: `read`: any BVH file as a posed hierarchy; `read_text`: its checked content
open_motion: `read`: the motion of one person as a `DeviceMotion`, by the kind of the device
mocopi, nuitrack: `read`: the same, for each kind
openpose: `read`: keypoints of one camera; `skeletons`; `link`: persons followed through frames
frame_numbers: `matched`, `common`: which frames the files of a folder are of
open_depth: `read`: colour and depth of any form as a `DepthRecording`; `baseline`
depth_folder: `read`: colour and depth from a folder of plain files; `is_one`
depth_recording: `DepthRecording`
plausible: units of a file, by the size of a body and the rate; stray and reset times

Folder: `realsense` (recordings of RealSense cameras).
"""
