"""The names in config/models.yaml lead to networks that fit their skeletons."""

import pytest

from courtside.pose import blazepose, decoders, heatmaps
from courtside.pose.conversion import tflite_onnx
from courtside.study.errors import InputError
from fixtures.recordings import networks
from fixtures.recordings.real_data import REAL, needs_real


def test_blazepose_is_built():
    network = decoders.landmark_network(
        networks.landmarks_onnx(), ("joint",) * 33, decoder="blazepose"
    )
    assert isinstance(network, blazepose.BlazePoseLandmarks)


@needs_real
def test_a_skeleton_of_another_length_is_one_line(tmp_path):
    tflite_onnx.convert(REAL / "models" / "cpm-mobile-14.tflite", tmp_path / "n.onnx")
    options = {"decoder": "heatmaps", "input_range": (0, 255), "channels": "bgr"}
    joints = tuple(f"left_hip{at}" for at in range(14))
    network = decoders.landmark_network(tmp_path / "n.onnx", joints, **options)
    assert isinstance(network, heatmaps.HeatmapLandmarks)
    with pytest.raises(InputError, match="expected 13 joints"):
        decoders.landmark_network(tmp_path / "n.onnx", joints[1:], **options)
