"""One-stage networks made for tests: persons and their joints in one look, in px of the picture."""

import numpy as np
import pytest

from courtside.pose import detector, open_network
from courtside.pose.detector import Region
from courtside.study.errors import InputError
from fixtures.recordings import onnx_files

SIZE = (128, 96)
JOINTS = ("nose", "left_hip", "right_hip")
POINTS = [(0, (171.3, 88.7)), (1, (150.6, 150.2)), (2, (188.45, 160.9))]
TRUTH = np.array([xy for _, xy in POINTS])
IMAGE = onnx_files.picture(POINTS, (320, 260), sigma=9.0)
GIVEN = {
    "rtmo": {"size": list(SIZE), "channels": "bgr"},
    "yolo-pose": {"size": list(SIZE), "channels": "bgr", "std": [255, 255, 255]},
}


def network(tmp_path, decoder, joints=JOINTS, **options):
    make = {"rtmo": onnx_files.rtmo, "yolo-pose": onnx_files.yolo_pose}[decoder]
    path = make(tmp_path / "n.onnx", SIZE)
    return open_network.landmark_network(
        path, joints, decoder=decoder, input=GIVEN[decoder], **options
    )


@pytest.mark.parametrize("decoder", GIVEN)
def test_joints_of_a_region_are_placed(tmp_path, decoder):
    one = network(tmp_path, decoder)
    pose = one.estimate(IMAGE, Region(165, 130, 140))
    np.testing.assert_allclose(pose.xy, TRUTH, atol=0.1)
    np.testing.assert_allclose(pose.score, 0.7, atol=1e-6)
    assert pose.presence == pytest.approx(0.9)
    scale = 140 / 96
    expected = detector.around_box(TRUTH.min(axis=0) - 8 * scale, TRUTH.max(axis=0) + 8 * scale)
    assert pose.region.box == pytest.approx(expected.box, abs=0.2)
    again = one.estimate(IMAGE, pose.region)
    np.testing.assert_allclose(again.xy, TRUTH, atol=0.1)


@pytest.mark.parametrize("decoder", GIVEN)
def test_it_is_its_own_detector(tmp_path, decoder):
    one = network(tmp_path, decoder)
    (region,) = one.detect(IMAGE)
    scale = max(320 / 128, 260 / 96)
    low, high = TRUTH.min(axis=0) - 8 * scale, TRUTH.max(axis=0) + 8 * scale
    np.testing.assert_allclose([region.x, region.y], (low + high) / 2, atol=0.3)
    np.testing.assert_allclose(region.box, high - low, atol=0.5)
    assert one.side_px == 128


@pytest.mark.parametrize("decoder", GIVEN)
def test_nobody_is_found_where_nobody_is(tmp_path, decoder):
    one = network(tmp_path, decoder)
    assert one.detect(IMAGE * 0) == []
    away = Region(40, 200, 60)
    pose = one.estimate(IMAGE, away)
    assert pose.presence == 0
    assert pose.region == away
    assert np.isfinite(pose.xy).all()
    assert network(tmp_path, decoder, min_score=0.95).detect(IMAGE) == []


@pytest.mark.parametrize("decoder", GIVEN)
def test_a_person_at_the_rim_is_somebody_else(tmp_path, decoder):
    centre = TRUTH.mean(axis=0)
    pose = network(tmp_path, decoder).estimate(IMAGE, Region(*(centre - [160, 0]), 250))
    assert pose.presence == 0


@pytest.mark.parametrize("decoder", GIVEN)
def test_another_skeleton_is_one_line(tmp_path, decoder):
    with pytest.raises(InputError, match="as its skeleton has") as caught:
        open_network.try_out(network(tmp_path, decoder, joints=("nose", "left_hip")))
    assert len(caught.value.lines) == 1
    other = {"rtmo": "yolo-pose", "yolo-pose": "rtmo"}[decoder]
    wrong = open_network.landmark_network(
        tmp_path / "n.onnx", JOINTS, decoder=other, input=GIVEN[decoder]
    )
    with pytest.raises(InputError, match=r"n\.onnx: expected"):
        open_network.try_out(wrong)
