"""Recordings of RealSense cameras in rosbag files.

recording: `read`: a `.bag` or `.db3` file as a `DepthRecording`
rosbag: `opened`: topics and messages; `colour`, `depth`: the pictures in messages
text: `lens`, `place`, `clock`, `stamps`, `stamp`: data beside the pictures
lens: `five_coefficients`: lens models as OpenCV's coefficients
"""
