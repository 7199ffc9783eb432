"""2D pose networks in onnxruntime: detection, tracking, decoding, privacy.

open_network: `landmark_network`, `person_detector`: a network file, by the name of its decoder.
detector: `Region`, `Pose`, `cut_out`: the interface of networks; blazepose: MediaPipe's.
clothing: `Clothing`: the colours of a person's clothes.
tracking, tracklets: `track_person`, `track_people`: people followed through the pictures of one
    camera; `limited`: their scores up to 1.
search, tiles, foreground: `Search`: where people are searched for: in tiles of the whole picture,
    and first where it differs from the background.
privacy, stick_drawing: `hide_faces`, `only_persons`, `hide`; `draw`.

Folders: `networks` (ONNX files of any maker), `conversion` (networks from TFLite to ONNX).
"""
