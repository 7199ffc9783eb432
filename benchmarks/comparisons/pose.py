"""Pose of one person in whole frames of a video, with the networks of MediaPipe."""

import tempfile
from pathlib import Path

import numpy as np
import onnx

import detect_pose
import machine
import peers
import rows
from courtside.pose.conversion import tflite_onnx

NAME = "pose"
LIMIT = "additions and multiplications of the networks, over the core's"
BOUNDS = (
    "the landmark network, and on single pictures the person network before it; what surrounds "
    "them (cutting out, reading the heat maps) takes a tenth. Depthwise convolutions move more "
    "bytes than they compute, so that the core's peak is out of reach"
)
FRAMES = 10  # of the smallest run
OPERATIONS = {"static": (0, 1), "tracking": (1,)}  # networks that each frame needs, at least


def compare(given):
    """Return the rows of this project and MediaPipe, single pictures and tracking."""
    times = rows.TIMES[: 2 if given.quick else None]
    frames = detect_pose.decode(given.video, times[-1] * FRAMES)
    measured = detect_pose.measure(frames, given.environments)
    if "mediapipe" not in measured:
        raise SystemExit("mediapipe did not run: see the line above")
    needed = _operations(given.environments)
    found = []
    for mode, networks in OPERATIONS.items():
        least_s = sum(needed[at] for at in networks) / machine.measured().flops_32
        for side, runs in _sides(measured).items():
            spent = np.min([seconds[mode] for seconds, _ in runs], axis=0)
            away = np.linalg.norm(runs[0][1][mode] - measured["mediapipe"][1][mode], axis=-1)
            apart = (np.nanmedian(away), np.nanpercentile(away, 95))
            found += [  # a ratio is between rows of one comparison: of one mode
                rows.Row(f"{NAME}, {mode}", side, side == rows.OURS, "frame", n, n / FRAMES,
                         spent[:n].sum(), limit_s=n * least_s,
                         **_error(apart if side == rows.OURS else None))
                for n in (each * FRAMES for each in times) if n <= len(frames)
            ]  # fmt: skip
    return found


def _sides(measured):
    ours = [run for method, run in measured.items() if method.startswith("courtside")]
    return {rows.OURS: ours, "mediapipe": [measured["mediapipe"]]}


def _error(apart):
    if apart is None:
        return {}
    return {"error_median": apart[0], "error_p95": apart[1], "error_unit": "px from MediaPipe's"}


def _operations(environments):
    """Return how many additions and multiplications each network does for one picture."""
    paths = detect_pose.networks(peers.interpreter("mediapipe", environments))
    outputs = [None, ["Identity", "Identity_1", "Identity_3", "Identity_4"]]
    with tempfile.TemporaryDirectory() as folder:
        counted = []
        for path, kept in zip(paths, outputs, strict=True):
            converted = Path(folder) / f"{path.stem}.onnx"
            tflite_onnx.convert(path, converted, **({"outputs": kept} if kept else {}))
            counted.append(2 * multiplications(onnx.load(converted)))
    return counted


def multiplications(model):
    """Return how many multiplications the convolutions of a network do for one picture."""
    graph = onnx.shape_inference.infer_shapes(model).graph
    sizes = {
        value.name: [axis.dim_value for axis in value.type.tensor_type.shape.dim]
        for value in (*graph.value_info, *graph.output)
    }
    weights = {each.name: each.dims for each in graph.initializer}
    return sum(
        int(np.prod(sizes[node.output[0]])) * int(np.prod(weights[node.input[1]][1:]))
        for node in graph.node
        if node.op_type == "Conv"
    )
