"""The names in config/models.yaml and config/detectors.yaml lead to networks that fit."""

import numpy as np
import pytest

from courtside.pose import blazepose, open_network
from courtside.pose.networks import boxes, one_stage, top_down
from courtside.study.errors import InputError
from fixtures.recordings import networks, onnx_files

GIVEN = {"size": [96, 128], "channels": "bgr"}
JOINTS = ("nose", "left_hip", "right_hip")


def test_blazepose_is_built(run_folder):
    landmarks, detector = networks.landmarks_onnx(run_folder), networks.detector_onnx(run_folder)
    network = open_network.landmark_network(landmarks, ("joint",) * 33, decoder="blazepose")
    assert isinstance(network, blazepose.BlazePoseLandmarks)
    finder = open_network.person_detector(detector, decoder="blazepose", min_score=0.7)
    assert isinstance(finder, blazepose.BlazePoseDetector)
    assert (finder.min_score, finder.side_px) == (0.7, 224)
    open_network.try_out(network)
    open_network.try_out(finder)


def test_blazepose_of_another_file_is_one_line(tmp_path):
    path = onnx_files.simcc(tmp_path / "n.onnx", (96, 128))
    with pytest.raises(InputError, match=r"n\.onnx: expected one input"):
        open_network.landmark_network(path, ("joint",) * 33, decoder="blazepose")
    with pytest.raises(InputError, match="expected 14 joints as in its skeleton, found 33"):
        open_network.landmark_network(path, ("joint",) * 14, decoder="blazepose")


@pytest.mark.parametrize(
    ("make", "decoder", "kind"),
    [
        (onnx_files.simcc, "simcc", top_down.TopDown),
        (onnx_files.rtmo, "rtmo", one_stage.OneStage),
        (onnx_files.yolo_pose, "yolo-pose", one_stage.OneStage),
    ],
)
def test_every_decoder_is_built_and_tried(tmp_path, make, decoder, kind):
    network = open_network.landmark_network(
        make(tmp_path / "n.onnx", (96, 128)), JOINTS, decoder=decoder, input=GIVEN
    )
    assert isinstance(network, kind)
    open_network.try_out(network)


def test_outputs_may_be_named_in_the_decoders_order(tmp_path):
    path = onnx_files.simcc(tmp_path / "n.onnx", (96, 128))
    given = {"decoder": "simcc", "input": GIVEN | {"padding": 1.25}}
    turned = open_network.landmark_network(path, JOINTS, **given, outputs=["simcc_y", "simcc_x"])
    with pytest.raises(InputError, match=r"\[192, 256\] bins for x and y"):
        open_network.try_out(turned)
    open_network.try_out(open_network.landmark_network(path, JOINTS, **given))


def test_a_flip_test_knows_the_sides(tmp_path):
    path = onnx_files.simcc(tmp_path / "n.onnx", (96, 128))
    given = {"decoder": "simcc", "input": GIVEN | {"padding": 1.25}}
    assert open_network.landmark_network(path, JOINTS, **given).pairs is None
    assert open_network.landmark_network(path, JOINTS, **given, flip_test=True).pairs == [0, 2, 1]
    many, path = JOINTS * 11, onnx_files.blazepose_landmarks(tmp_path / "b.onnx")
    blaze = open_network.landmark_network(path, many, decoder="blazepose", flip_test=True)
    assert blaze.pairs[:3] == [0, 2, 1]
    open_network.try_out(blaze)


def test_a_skeleton_of_another_length_is_one_line(tmp_path):
    path = onnx_files.heat_maps(tmp_path / "n.onnx", (96, 96), 4, layout="nhwc")
    given = {"size": [96, 96], "layout": "nhwc", "channels": "bgr"}
    network = open_network.landmark_network(path, JOINTS[:2], decoder="heatmaps", input=given)
    with pytest.raises(InputError, match="expected 2 joints as in its skeleton, found 3"):
        open_network.try_out(network)


def test_detectors_take_their_limits(tmp_path):
    finder = open_network.person_detector(
        onnx_files.yolox(tmp_path / "n.onnx", (96, 64)),
        decoder="yolox",
        input={"size": [96, 64], "channels": "bgr"},
        person_class=1,
        min_score=0.4,
        min_height=30,
    )
    assert isinstance(finder, boxes.BoxDetector)
    assert (finder.person_class, finder.min_score, finder.min_height) == (1, 0.4, 30)
    assert finder.detect(np.zeros((60, 90, 3), np.uint8)) == []
