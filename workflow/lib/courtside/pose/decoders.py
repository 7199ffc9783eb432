"""From a name in `config/models.yaml` to the code that runs such a network."""

from courtside.pose.blazepose import BlazePoseDetector, BlazePoseLandmarks
from courtside.pose.heatmaps import HeatmapLandmarks
from courtside.study.errors import InputError


def person_detector(onnx_path):
    """Return the `PersonDetector` of an ONNX file; there is one kind, BlazePose's."""
    return BlazePoseDetector(onnx_path)


def landmark_network(onnx_path, joints, *, decoder, input_range=None, channels=None):
    """Return the `LandmarkNetwork` of an ONNX file.

    Parameters
    ----------
    onnx_path : str or Path
    joints : tuple of str
        The skeleton's joints.
    decoder : {"blazepose", "heatmaps"}
    input_range, channels
        Of a heat-map network, see `courtside.pose.heatmaps.HeatmapLandmarks`.

    Returns
    -------
    network : LandmarkNetwork

    Raises
    ------
    InputError
        If the network has another number of joints than its skeleton.
    """
    if decoder == "blazepose":
        network = BlazePoseLandmarks(onnx_path)
    else:
        trunk = [at for at, joint in enumerate(joints) if joint.endswith(("_shoulder", "_hip"))]
        network = HeatmapLandmarks(onnx_path, input_range, channels, trunk)
    if network.n_joints != len(joints):
        raise InputError(
            f"{onnx_path}: expected {len(joints)} joints as in its skeleton, found {network.n_joints}; "
            "correct `skeleton` in config/models.yaml"
        )
    return network
