"""The code that runs a network, by its decoder's name in `config/models.yaml`."""

from collections.abc import Sequence

from courtside.pose.blazepose import BlazePoseLandmarks
from courtside.pose.detector import LandmarkNetwork
from courtside.pose.heatmaps import HeatmapLandmarks
from courtside.study.errors import InputError, StrPath


def landmark_network(
    onnx_path: StrPath,
    joints: Sequence[str],
    *,
    decoder: str,
    input_range: tuple[float, float] | None = None,
    channels: str | None = None,
) -> LandmarkNetwork:
    """Open a landmark network for the joints of its skeleton.

    The decoder is "blazepose" or "heatmaps", which needs `input_range` and `channels`: see
    `courtside.pose.heatmaps.HeatmapLandmarks`. Raises `InputError` if the network has another
    number of joints than its skeleton.
    """
    network: LandmarkNetwork
    if decoder == "blazepose":
        network = BlazePoseLandmarks(onnx_path)
    elif input_range is None or channels is None:
        raise ValueError(f"{onnx_path}: a heat-map network needs input_range and channels")
    else:
        trunk = [at for at, joint in enumerate(joints) if joint.endswith(("_shoulder", "_hip"))]
        network = HeatmapLandmarks(onnx_path, input_range, channels, trunk)
    if network.n_joints != len(joints):
        raise InputError(
            f"{onnx_path}: expected {len(joints)} joints as in its skeleton, found "
            f"{network.n_joints}; correct `skeleton` in config/models.yaml"
        )
    return network
