"""Networks as ONNX files of any maker: opened, given a picture, and their outputs decoded.

session: `Network`: a file in onnxruntime with its execution providers; `check_file`.
batches: `of_size`: a network for one picture as one for several.
inputs: `Input`, `Window`, `letterbox`: a part of a picture as the tensor that a network expects.
peaks: places of peaks in heat maps and SimCC lines, to a fraction of a cell.
top_down: `TopDown`: the joints of one person from heat maps or SimCC lines.
boxes: `BoxDetector`: persons as boxes, of YOLOX and of networks with their own suppression.
one_stage: `OneStage`: boxes and joints of all persons at once, RTMO and YOLO-pose.
"""

import os

# Else onnxruntime keeps a number of this machine and records of its use below ~/.cache.
os.environ.setdefault("ORT_DISABLE_TELEMETRY", "1")
