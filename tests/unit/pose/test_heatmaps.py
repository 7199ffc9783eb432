"""Peaks of heat maps with known centres, and a real network on a real photo with known joints."""

import json

import cv2
import numpy as np
import pytest

from courtside.pose import heatmaps
from courtside.pose.conversion import tflite_onnx
from courtside.pose.detector import Region
from courtside.records.keypoints import skeleton
from fixtures.recordings.real_data import REAL, needs_real


@pytest.mark.parametrize(("x", "y"), [(40.0, 20.0), (40.3, 20.4), (10.5, 60.25)])
def test_the_peak_of_a_gaussian_is_found_to_a_twentieth_of_a_cell(x, y):
    rows, columns = np.mgrid[:96, :96]
    maps = np.exp(-((columns - x) ** 2 + (rows - y) ** 2) / (2 * 2.0**2))[..., None]
    fraction, score = heatmaps.peaks(maps)
    np.testing.assert_allclose(fraction[0] * 96 - 0.5, [x, y], atol=0.05)
    assert score[0] == pytest.approx(maps.max())


def test_a_peak_at_the_border_stays_inside():
    maps = np.zeros((96, 96, 1))
    maps[0, 95] = 1
    fraction, _ = heatmaps.peaks(maps)
    np.testing.assert_allclose(fraction[0] * 96, [95.5, 0.5])


def test_the_region_holds_all_joints():
    xy = np.array([[10.0, 20.0], [110.0, 80.0], [60.0, 220.0]])
    region = heatmaps.around(xy)
    assert (region.x, region.y) == (60, 120)
    assert region.side == pytest.approx(200 * heatmaps.MARGIN)


@needs_real
def test_cpm_places_the_joints_of_a_photo(tmp_path):
    tflite_onnx.convert(REAL / "models" / "cpm-mobile-14.tflite", tmp_path / "cpm.onnx")
    network = heatmaps.HeatmapLandmarks(tmp_path / "cpm.onnx", (0, 255), "bgr", [2, 5, 8, 11])
    image = cv2.imread(str(REAL / "people" / "000000000785.jpg"))
    truth = json.loads((REAL / "people" / "coco_785.json").read_text())
    coco = truth if isinstance(truth, dict) else truth[0]
    coco = coco["annotations"][0] if "annotations" in coco else coco
    keypoints = np.array(coco["keypoints"], float).reshape(17, 3)
    visible = keypoints[keypoints[:, 2] > 0, :2]
    pose = network.estimate(image, heatmaps.around(visible))
    joints = skeleton.read(
        __import__("pathlib").Path(__file__).parents[3] / "config" / "skeletons" / "cpm14.yaml"
    ).joints
    pairs = {
        "shoulder": (5, 6),
        "elbow": (7, 8),
        "wrist": (9, 10),
        "hip": (11, 12),
        "knee": (13, 14),
    }
    height = np.ptp(visible[:, 1])
    errors = [
        np.linalg.norm(pose.xy[joints.index(f"{side}_{name}")] - keypoints[at, :2]) / height
        for name, ids in pairs.items()
        for side, at in zip(("left", "right"), ids, strict=True)
        if keypoints[at, 2] > 0
    ]
    assert len(errors) >= 8
    assert np.median(errors) < 0.10


def test_regions_are_upright_squares():
    assert heatmaps.around(np.zeros((3, 2))) == Region(0.0, 0.0, 1.0)
