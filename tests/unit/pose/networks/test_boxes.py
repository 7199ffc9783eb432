"""Boxes of made networks: the grid of YOLOX, classes of RTMDet, suppression; two real detectors."""

import json

import cv2
import numpy as np
import pandas as pd
import pytest

from courtside.pose import open_network, tiles
from courtside.pose.networks import boxes
from courtside.study.errors import InputError
from fixtures.recordings import onnx_files
from fixtures.recordings.real_data import REAL, needs_real

SIZE = (96, 64)  # of the input
BGR = {"size": list(SIZE), "channels": "bgr"}
MEAN = {"mean": [103.53, 116.28, 123.675], "std": [57.375, 57.12, 58.395]}
PERSON = (40, 20, 80, 100)  # first and last white pixel of a picture twice as large as the input


def yolox(tmp_path, **options):
    path = onnx_files.yolox(tmp_path / "y.onnx", SIZE)
    how = {"decoder": "yolox", "input": BGR, "person_class": 1} | options
    return open_network.person_detector(path, **how)


def end_to_end(tmp_path, person=0, **options):
    path = onnx_files.end_to_end(tmp_path / "r.onnx", SIZE, person=person, least=1.5)
    how = {"decoder": "end-to-end", "input": BGR | MEAN} | options
    return open_network.person_detector(path, **how)


@pytest.mark.parametrize("make", [yolox, end_to_end])
@pytest.mark.parametrize(("size", "more"), [((192, 128), 1), ((384, 200), 2), ((170, 256), 2)])
def test_a_box_lies_where_the_person_is(tmp_path, make, size, more):
    box = np.array(PERSON) * more
    picture = onnx_files.white(box, size)
    scale = min(SIZE[0] / size[0], SIZE[1] / size[1])
    (region,) = make(tmp_path).detect(picture)
    width, height = region.box
    found = [region.x - width / 2, region.y - height / 2]
    found += [region.x + width / 2, region.y + height / 2]
    np.testing.assert_allclose(found, box, atol=0.1 if scale == 0.5 else 1 / scale)
    assert region.side == pytest.approx(1.4 * height)


@pytest.mark.parametrize("make", [yolox, end_to_end])
def test_small_or_doubtful_boxes_are_nobody(tmp_path, make):
    picture = onnx_files.white(PERSON, (192, 128))
    assert make(tmp_path, min_height=39).detect(picture)
    assert make(tmp_path, min_height=41).detect(picture) == []
    assert make(tmp_path, min_score=0.85).detect(picture) == []
    assert make(tmp_path).detect(picture * 0) == []


def test_only_persons_are_found(tmp_path):
    picture = onnx_files.white(PERSON, (192, 128))
    (region,) = end_to_end(tmp_path, person=3, person_class=3).detect(picture)
    assert region.box == pytest.approx((40, 80), abs=0.1)
    assert end_to_end(tmp_path, person=3, person_class=5).detect(picture) == []
    assert yolox(tmp_path, person_class=2).detect(picture) == []


def test_the_best_of_overlapping_boxes_is_kept():
    box = np.array([[0, 0, 10, 20], [1, 0, 11, 20], [30, 0, 40, 20], [0, 0, 10, 3], [5, 0, 4, 20]])
    score = np.array([0.6, 0.9, 0.7, 0.99, 0.99])
    assert boxes.chosen(box.astype(float), score, 0.3, 16) == [1, 2]
    assert boxes.chosen(box.astype(float), score, 0.8, 16) == [1]
    assert boxes.chosen(box * np.nan, score, 0.3, 16) == []


def test_intersection_over_union_of_half_overlapping_squares():
    many = np.array([[1.0, 0, 3, 2], [5, 0, 6, 1], [0, 0, 2, 2]])
    np.testing.assert_allclose(boxes.overlap(np.array([0.0, 0, 2, 2]), many), [1 / 3, 0, 1])


def test_a_tile_is_shrunk_to_the_detectors_own_input(tmp_path):
    finder = yolox(tmp_path)
    assert finder.side_px == 96
    asked = []
    detect = finder.detect
    finder.detect = lambda image: asked.append(image.shape) or detect(image)
    picture = onnx_files.white(np.array(PERSON) * 2, (384, 256))
    found = tiles.search(picture, tiles.tiles(384, 256)[:1], finder)
    assert asked == [(64, 96, 3)]
    np.testing.assert_allclose([found[0].x, found[0].y], [120, 120], atol=4)
    assert found[0].box == pytest.approx((80, 160), abs=8)


@pytest.mark.parametrize(
    ("made", "decoder", "part"),
    [
        ("yolox", "end-to-end", r"boxes \(1, N, 5\)"),
        ("end_to_end", "yolox", r"YOLOX's grid \(1, 126, 5 \+ classes\)"),
    ],
)
def test_another_detector_than_declared_is_one_line(tmp_path, made, decoder, part):
    path = getattr(onnx_files, made)(tmp_path / "n.onnx", SIZE)
    with pytest.raises(InputError, match=part) as caught:
        open_network.try_out(open_network.person_detector(path, decoder=decoder, input=BGR))
    assert len(caught.value.lines) == 1


REAL_ONES = {
    "yolox_nano": {"decoder": "yolox", "input": {"size": [416, 416], "channels": "bgr"}},
    "rtmdet_nano_person": {
        "decoder": "end-to-end",
        "input": {"size": [320, 320], "channels": "bgr"} | MEAN,
    },
}


@needs_real
@pytest.mark.parametrize("name", REAL_ONES)
@pytest.mark.parametrize("camera", [1, 3])
def test_a_real_detector_finds_a_real_person(name, camera):
    finder = open_network.person_detector(REAL / "models" / f"{name}.onnx", **REAL_ONES[name])
    stream = cv2.VideoCapture(str(REAL / f"walk-4cams/videos/cam{camera:02d}.mp4"))
    found, image = stream.read()
    assert found
    path = next((REAL / f"walk-4cams/openpose_body25b/cam{camera}_json").glob("*.0000.json"))
    joints = json.loads(path.read_text())["people"][0]["pose_keypoints_2d"]
    joints = np.reshape(joints, (-1, 3))
    xy = joints[joints[:, 2] > 0.3, :2]
    regions = tiles.search(image, tiles.tiles(*image.shape[1::-1]), finder)
    theirs = np.array([*xy.min(axis=0), *xy.max(axis=0)])
    middles = np.array([(r.x, r.y) for r in regions])
    sides = np.array([r.box for r in regions])
    shared = boxes.overlap(theirs, np.hstack([middles - sides / 2, middles + sides / 2]))
    assert np.sort(shared)[-1] > 0.6
    assert np.sort(shared)[:-1].max(initial=0) < 0.1  # nobody twice, and no part of them


@pytest.mark.skipif(
    not (REAL / "hall-markers").is_dir(), reason=f"no recording of a hall at {REAL}/hall-markers"
)
@pytest.mark.parametrize("name", REAL_ONES)
@pytest.mark.parametrize("camera", ["cam02", "cam08"])
def test_a_real_detector_finds_a_player_in_a_hall_of_4k(name, camera):
    finder = open_network.person_detector(REAL / "models" / f"{name}.onnx", **REAL_ONES[name])
    found, image = cv2.VideoCapture(str(REAL / "hall-markers" / f"{camera}.mp4")).read()
    assert found
    table = pd.read_csv(REAL / "hall-markers" / "annotations.csv")
    table = table[(table["camera"] == camera) & (table["frame_idx"] == 0)]
    xy = table[["x_px", "y_px"]].to_numpy()
    regions = tiles.search(image, tiles.tiles(*image.shape[1::-1]), finder)
    middles = np.array([(r.x, r.y) for r in regions])
    sides = np.array([r.box for r in regions])
    theirs = np.array([*xy.min(axis=0), *xy.max(axis=0)])
    shared = boxes.overlap(theirs, np.hstack([middles - sides / 2, middles + sides / 2]))
    assert (shared > 0.5).sum() == 1
