"""Networks made for tests find blobs: crop, decoding and the way back place them to 0.1 px."""

import json
import re
from pathlib import Path
from types import SimpleNamespace

import cv2
import numpy as np
import pytest
import yaml

from courtside.pose import detector, open_network, tracking
from courtside.pose.conversion import tflite_onnx
from courtside.pose.detector import Region
from courtside.pose.networks import top_down
from courtside.records.keypoints import skeleton
from courtside.study.errors import InputError
from fixtures.recordings import onnx_files
from fixtures.recordings.real_data import REAL, needs_real

CONFIG = Path(__file__).parents[4] / "config"
JOINTS = ("nose", "left_shoulder", "left_hip")  # blue, green, red
POINTS = [(0, (171.3, 88.7)), (1, (140.6, 150.2)), (2, (188.45, 190.9))]
TRUTH = np.array([xy for _, xy in POINTS])
BOX = detector.around_box(np.array([110.5, 60.25]), np.array([220.0, 230.75]))
SIMCC = {"size": [96, 128], "channels": "bgr", "padding": 1.25}
MAPS = {"size": [96, 128], "channels": "bgr", "padding": 1.25}
UDP = MAPS | {"size": [97, 129]}  # cells from the first to the last pixel


def image(points=POINTS, sigma=9.0):
    return onnx_files.picture(points, (320, 260), sigma)


def simcc(tmp_path, shift=0, joints=JOINTS, white=1, **options):
    path = onnx_files.simcc(tmp_path / "n.onnx", (96, 128), shift=shift, full_score=white)
    return open_network.landmark_network(path, joints, decoder="simcc", input=SIMCC, **options)


def maps(tmp_path, cells, joints=JOINTS, layout="nchw", refine="dark", flip=False, **made):
    given = (UDP if cells == "udp" else MAPS) | {"layout": layout}
    first = {"centre": 2, "corner": 0, "udp": 0}[cells]
    path = tmp_path / "n.onnx"
    onnx_files.heat_maps(path, given["size"], 4, layout=layout, first=first, **made)
    how = {"cells": cells, "refine": refine, "flip_test": flip}
    return open_network.landmark_network(path, joints, decoder="heatmaps", input=given, **how)


def test_simcc_places_points(tmp_path):
    network = simcc(tmp_path)
    for region in (BOX, Region(165, 145, 240), Region(150, 150, 200, np.pi / 2)):
        pose = network.estimate(image(sigma=5.0), region)
        np.testing.assert_allclose(pose.xy, TRUTH, atol=0.1)
        assert pose.score.min() > 0.85
        assert pose.presence == pytest.approx(pose.score[1:].mean())
    box = pose.region.box
    assert box == pytest.approx(np.ptp(TRUTH, axis=0) * 1.25 + 1, abs=0.3)
    np.testing.assert_allclose(network.estimate(image(sigma=5.0), pose.region).xy, TRUTH, atol=0.1)


def followed(network):
    """Return the track of three joints that are seen less and less well, and its warning."""
    picture = (image(sigma=5.0) * [1, 0.8, 0.4]).astype(np.uint8)
    finder = SimpleNamespace(detect=lambda _: [BOX])
    frames = [(at / 30, picture) for at in range(3)]
    track = tracking.track_person(frames, finder, network, min_presence=0.4, redetect=False)
    return tracking.limited(track, "rtmw", network.maps.full_score)


def test_scores_are_shares_of_the_full_score(tmp_path):
    """RTMW's scores reach 5 and more (Tau-J/rtmlib#42); cut at 1, all joints would be certain."""
    usual, doubt = followed(simcc(tmp_path))
    assert not doubt
    assert usual.score[0].max(axis=0) == pytest.approx([0.95, 0.76, 0.38], rel=0.1)
    cut, doubt = followed(simcc(tmp_path, white=5))
    assert (cut.score == 1).all()
    advised = float(re.search(r"set `full_score: ([\d.]+)` of rtmw", doubt)[1])
    assert advised == pytest.approx(5 * usual.score.max(), rel=0.01)
    for full_score in (5, advised):
        track, doubt = followed(simcc(tmp_path, white=5, full_score=full_score))
        assert not doubt
        np.testing.assert_allclose(track.xy, usual.xy, atol=0.05)
        np.testing.assert_allclose(track.score, usual.score * 5 / full_score, atol=0.01)
    _, doubt = followed(simcc(tmp_path, white=5, full_score=2))
    assert f"set `full_score: {advised}` of rtmw" in doubt


def test_a_person_is_there_by_scores_up_to_one(tmp_path):
    """One shoulder of a high score does not show a person who is not there."""
    network = simcc(tmp_path, white=5)
    pose = network.estimate(image(POINTS[:2], sigma=5.0), BOX)
    assert pose.score[1] > 4
    assert pose.presence == pytest.approx(0.5)


@pytest.mark.parametrize("layout", ["nchw", "nhwc"])
@pytest.mark.parametrize("cells", ["centre", "corner", "udp"])
def test_heat_maps_that_are_not_square_place_points(tmp_path, cells, layout):
    pose = maps(tmp_path, cells, layout=layout).estimate(image(), BOX)
    np.testing.assert_allclose(pose.xy, TRUTH, atol=0.1)


def test_a_parabola_is_nearly_as_good(tmp_path):
    pose = maps(tmp_path, "corner", refine="parabola").estimate(image(), BOX)
    np.testing.assert_allclose(pose.xy, TRUTH, atol=0.25)


@pytest.mark.parametrize("cells", ["centre", "corner", "udp"])
def test_cells_read_otherwise_than_they_lie_are_off(tmp_path, cells):
    network = maps(tmp_path, cells)
    wrong = {"centre": "corner", "corner": "centre", "udp": "centre"}[cells]
    network.maps = top_down.HeatMaps(3, "nchw", wrong, "dark")
    assert np.abs(network.estimate(image(), BOX).xy - TRUTH).max() > 0.5


def test_the_mirrored_picture_takes_a_bias_away(tmp_path):
    middle = ("nose", "neck", "head_top")  # joints without sides
    for flip, off in ((False, 3), (True, 0)):
        network = maps(tmp_path, "corner", joints=middle, flip=flip, shift=2)
        network.presence_joints = [0]
        error = network.estimate(image(), BOX).xy - TRUTH
        scale = 213.125 / 128  # of the crop: the box's height times 1.25, in px of the input
        np.testing.assert_allclose(error, [[2 * scale if off else 0, 0]] * 3, atol=0.15)


def test_the_mirrored_picture_of_simcc_takes_a_bias_away(tmp_path):
    picture, middle = image(sigma=5.0), ("nose", "neck", "head_top")
    biased = simcc(tmp_path, shift=2).estimate(picture, BOX).xy - TRUTH
    assert biased[:, 0].min() > 2
    network = simcc(tmp_path, shift=2, joints=middle, flip_test=True)
    network.presence_joints = [0]
    np.testing.assert_allclose(network.estimate(picture, BOX).xy, TRUTH, atol=0.15)


def test_left_and_right_change_places_in_the_mirror(tmp_path):
    pair = ("left_shoulder", "right_shoulder")
    points = [(0, (195.0, 150.0)), (0, (135.0, 150.0))]
    network = maps(tmp_path, "corner", joints=pair, flip=True, halves=True)
    pose = network.estimate(image(points), BOX)
    np.testing.assert_allclose(pose.xy, [xy for _, xy in points], atol=0.15)
    network.pairs = [0, 1]
    assert network.estimate(image(points), BOX).score.max() < 0.6


def test_a_turned_region_without_a_box_holds_the_whole_person():
    assert top_down.box_of(Region(0, 0, 140)) == pytest.approx((50, 100))
    assert top_down.box_of(Region(0, 0, 140, np.pi / 2)) == pytest.approx((100, 50))
    assert top_down.box_of(BOX) == BOX.box == (109.5, 170.5)


def test_doubtful_joints_do_not_widen_the_next_box():
    xy = np.array([[0, 0], [10, 0], [10, 50], [0, 50], [400, 400]], float)
    region = top_down.around_person(xy, np.array([0.9, 0.9, 0.9, 0.9, 0.1]))
    assert (region.x, region.y) == (5, 25)
    assert region.box == pytest.approx((13.5, 63.5))


def test_the_region_holds_all_joints():
    xy = np.array([[10.0, 20.0], [110.0, 80.0], [60.0, 220.0]])
    region = top_down.around(xy)
    assert (region.x, region.y) == (60, 120)
    assert region.side == pytest.approx(200 * top_down.MARGIN)
    assert top_down.around(np.zeros((3, 2))) == Region(0.0, 0.0, 1.0)


@pytest.mark.parametrize(
    ("change", "part"),
    [
        ({"joints": JOINTS[1:]}, "expected 2 joints as in its skeleton, found 3"),
        ({"split": 3.0}, r"\[288, 384\] bins for x and y"),
        ({"outputs": ["simcc_x", "heat"]}, r"the outputs \['heat'\], found \['simcc_x'"),
        ({"outputs": ["simcc_x"]}, "two outputs"),
        ({"decoder": "heatmaps"}, "heat maps of one picture"),
        ({"input": SIMCC | {"size": [192, 256]}}, r"shape \[1, 3, 256, 192\]"),
        ({"input": SIMCC | {"layout": "nhwc"}}, r"shape \[1, 128, 96, 3\]"),
    ],
)
def test_another_network_than_declared_is_one_line(tmp_path, change, part):
    path = onnx_files.simcc(tmp_path / "n.onnx", (96, 128))
    how = {"joints": JOINTS, "decoder": "simcc", "input": SIMCC} | change
    with pytest.raises(InputError, match=part) as caught:
        open_network.try_out(open_network.landmark_network(path, **how))
    assert len(caught.value.lines) == 1
    assert str(path) in str(caught.value)


def test_maps_without_cells_are_one_line(tmp_path):
    graph = onnx_files.Graph([1, 3, 128, 96])
    none = graph.add("Slice", "image", graph.ints(0), graph.ints(0), graph.ints(2))
    graph.output(none, "maps")
    path = graph.write(tmp_path / "n.onnx")
    network = open_network.landmark_network(path, JOINTS, decoder="heatmaps", input=MAPS)
    with pytest.raises(InputError, match=r"heat maps of one picture.*\(1, 3, 0, 96\)"):
        open_network.try_out(network)


def cpm(tmp_path):
    """Return the network as `models.yaml` declares it, its joints, a photo and who is on it."""
    tflite_onnx.convert(REAL / "models" / "cpm-mobile-14.tflite", tmp_path / "cpm.onnx")
    joints = skeleton.read(CONFIG / "skeletons" / "cpm14.yaml").joints
    declared = yaml.safe_load((CONFIG / "models.yaml").read_text())["cpm-mobile-14"]
    how = {key: declared[key] for key in ("decoder", "input", "cells")}
    network = open_network.landmark_network(tmp_path / "cpm.onnx", joints, **how)
    photo = cv2.imread(str(REAL / "people" / "000000000785.jpg"))
    truth = json.loads((REAL / "people" / "coco_785.json").read_text())
    coco = truth if isinstance(truth, dict) else truth[0]
    coco = coco["annotations"][0] if "annotations" in coco else coco
    return network, joints, photo, np.array(coco["keypoints"], float).reshape(17, 3)


@needs_real
def test_cpm_places_joints_of_a_mirrored_photo_at_the_mirrored_places(tmp_path):
    """Where cells lie otherwise than declared, joints are off to one side in both pictures."""
    network, joints, photo, keypoints = cpm(tmp_path)
    region = top_down.around(keypoints[keypoints[:, 2] > 0, :2])
    width = photo.shape[1]
    turned = detector.Region(width - 1 - region.x, region.y, region.side)
    one = network.estimate(photo, region)
    other = network.estimate(np.ascontiguousarray(photo[:, ::-1]), turned)
    pairs = skeleton.mirror(joints)
    sure = (one.score > 0.4) & (other.score[pairs] > 0.4)
    off_px = (one.xy[:, 0] - (width - 1 - other.xy[pairs, 0])) / 2
    assert sure.sum() >= 8
    assert abs(np.median(off_px[sure])) < 0.6 * region.side / 192


@needs_real
def test_cpm_places_the_joints_of_a_photo(tmp_path):
    network, joints, image, keypoints = cpm(tmp_path)
    visible = keypoints[keypoints[:, 2] > 0, :2]
    pose = network.estimate(image, top_down.around(visible))
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
