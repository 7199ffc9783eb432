"""BlazePose run here against MediaPipe's own Python solution; its geometry against mathematics."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pandas as pd
import pytest

from courtside.pose import blazepose, detector
from courtside.records.keypoints import skeleton
from fixtures.recordings import networks, onnx_files
from fixtures.recordings.real_data import REAL, needs_real

RECORDED = Path(__file__).with_name("mediapipe_landmarks.csv")
SHAPE = Path(__file__).parents[3] / "config" / "skeletons" / "blazepose33.yaml"
JOINTS = skeleton.read(SHAPE).joints


@pytest.fixture(scope="module")
def blazepose_pair(run_folder):
    return (
        blazepose.BlazePoseDetector(networks.detector_onnx(run_folder)),
        blazepose.BlazePoseLandmarks(networks.landmarks_onnx(run_folder)),
    )


def pictures(name, frames):
    """Yield some frames of a video, in their order, or the one picture of a photo."""
    if name.isdigit():
        yield cv2.imread(str(REAL / "people" / f"{name}.jpg"))
        return
    stream = cv2.VideoCapture(str(REAL / "walk-4cams" / "videos" / f"{name}.mp4"))
    for frame_idx in range(max(frames) + 1):
        found, image = stream.read()
        assert found, f"{name}: no frame {frame_idx}"
        if frame_idx in frames:
            yield image


@needs_real
def test_joints_agree_with_mediapipe(blazepose_pair):
    find, place = blazepose_pair
    recorded = pd.read_csv(RECORDED, comment="#", dtype={"video": str})
    distances_px, metric_m = [], []
    found = recorded.groupby(["video", "frame_idx"]).filter(lambda rows: rows.x_px.notna().all())
    for video, of_video in found.groupby("video"):
        each = of_video.groupby("frame_idx")
        for (_, rows), image in zip(each, pictures(video, list(each.groups)), strict=True):
            pose = place.estimate(image, find.detect(image)[0])
            distances_px.append(np.linalg.norm(pose.xy - rows[["x_px", "y_px"]].to_numpy(), axis=1))
            own = rows[["world_x_m", "world_y_m", "world_z_m"]].to_numpy()
            metric_m.append(pose.xyz_in_body - own)
    assert len(distances_px) >= 25
    assert np.mean(distances_px) <= 2.0
    assert np.abs(metric_m).mean() <= 0.01


def test_the_region_of_an_upright_person_is_upright():
    region = blazepose.region_from_points(np.array([100.0, 300.0]), np.array([100.0, 100.0]))
    assert (region.x, region.y, region.angle_rad) == (100, 300, pytest.approx(0))
    assert region.side == pytest.approx(2 * 200 * 1.25)


@pytest.mark.parametrize("angle_deg", [-150, -90, -30, 10, 90, 170])
def test_the_region_turns_with_the_person(angle_deg):
    angle = np.deg2rad(angle_deg)
    rim = [100 + 50 * np.sin(angle), 300 - 50 * np.cos(angle)]
    region = blazepose.region_from_points(np.array([100.0, 300.0]), np.array(rim))
    assert region.angle_rad == pytest.approx(angle)


def test_overlapping_boxes_merge_by_their_scores():
    box = np.array([[0.5, 0.5, 0.2, 0.2], [0.52, 0.5, 0.2, 0.2], [0.9, 0.9, 0.1, 0.1]])
    merged = blazepose.merge_overlapping(box, np.array([0.75, 0.5, 0.9]))
    np.testing.assert_allclose(merged[0], box[2])
    np.testing.assert_allclose(merged[1], [0.508, 0.5, 0.2, 0.2])
    weak = blazepose.merge_overlapping(box, np.array([0.3, 0.1, 0.4]))
    np.testing.assert_allclose(weak[1], [0.505, 0.5, 0.2, 0.2])


def test_a_sure_box_is_not_averaged_with_weak_ones():
    box = np.array([[0.5, 0.5, 0.2, 0.2], [0.52, 0.5, 0.2, 0.2], [0.9, 0.9, 0.1, 0.1]])
    merged = blazepose.merge_overlapping(box, np.array([0.6, 0.4, 0.3]))
    np.testing.assert_allclose(merged, box[[0, 2]])


def test_intersection_over_union_of_half_overlapping_squares():
    one = np.array([0.0, 0.0, 2.0, 2.0])
    many = np.array([[1.0, 0.0, 2.0, 2.0], [5.0, 0.0, 1.0, 1.0], [0.0, 0.0, 2.0, 2.0]])
    np.testing.assert_allclose(blazepose.overlap(one, many), [1 / 3, 0, 1])


def test_a_landmark_moves_to_the_centre_of_its_heat():
    maps = np.full((64, 64, 2), -20.0, np.float32)
    maps[20:23, 30:33, 0] = 8.0
    start = np.array([[30.4 / 64, 22.1 / 64], [0.5, 0.5]])
    refined = blazepose.refine(start, maps)
    np.testing.assert_allclose(refined[0] * 64, [31, 21], atol=1e-3)
    np.testing.assert_array_equal(refined[1], start[1])


def centre_of_mass(start, logits):
    """Return where one landmark (2,) moves by its heat map (H, W), step by step."""
    column, row = (start * logits.shape[::-1]).astype(int)
    cells = [
        (x, y, 1 / (1 + np.exp(-float(logits[y, x]))))
        for y in range(max(0, row - 3), min(logits.shape[0], row + 4))
        for x in range(max(0, column - 3), min(logits.shape[1], column + 4))
    ]
    if max(weight for *_, weight in cells) < 0.5:
        return start
    middle = np.average([cell[:2] for cell in cells], axis=0, weights=[cell[2] for cell in cells])
    return middle / logits.shape[::-1]


def test_landmarks_move_to_the_centre_of_mass_at_edges_too():
    rng = np.random.default_rng(0)
    maps, start = rng.normal(-4, 2, (48, 64, 60)).astype(np.float32), rng.random((60, 2))
    start[:8] *= 0.03
    refined = blazepose.refine(start, maps)
    wanted = [centre_of_mass(one, maps[:, :, at]) for at, one in enumerate(start)]
    np.testing.assert_allclose(refined, wanted, rtol=0, atol=1e-12)
    moved = (refined != start).any(axis=1)
    assert moved[:8].any() and 10 < moved.sum() < 60  # near the edge too; not where all is unlikely
    outside = np.array([[-0.1, 0.5], [0.5, 1.01]])
    np.testing.assert_array_equal(blazepose.refine(outside, maps[:, :, :2]), outside)


def test_the_detector_has_an_anchor_for_every_output():
    assert blazepose.anchors().shape == (2254, 2)


def test_the_logistic_function_does_not_overflow():
    with np.errstate(over="raise"):
        values = blazepose.sigmoid(np.array([-1e6, 0.0, 1e6], np.float32))
    np.testing.assert_allclose(values, [0, 0.5, 1], atol=1e-12)


@needs_real
def test_a_turned_picture_gives_turned_joints(blazepose_pair):
    find, place = blazepose_pair
    (image,) = pictures("cam03", [0])
    upright = place.estimate(image, find.detect(image)[0])
    turned_region = detector.Region(
        image.shape[0] - upright.region.y,
        upright.region.x,
        upright.region.side,
        upright.region.angle_rad + np.pi / 2,
    )
    same = place.estimate(image, upright.region)
    turned = place.estimate(cv2.rotate(image, cv2.ROTATE_90_CLOCKWISE), turned_region)
    expected = np.stack([image.shape[0] - same.xy[:, 1], same.xy[:, 0]], axis=1)
    assert np.median(np.linalg.norm(turned.xy - expected, axis=1)) < 3


def test_with_a_flip_test_the_mirror_image_gives_the_mirrored_joints(tmp_path):
    path, joints = onnx_files.blazepose_landmarks(tmp_path / "n.onnx"), skeleton.mirror(JOINTS)
    flip_test = blazepose.BlazePoseLandmarks(path, pairs=joints)
    image = np.random.default_rng(1).integers(0, 255, (300, 320, 3), dtype=np.uint8)
    image = cv2.GaussianBlur(image, (0, 0), 9)
    region = detector.Region(150, 140, 256)
    pose = flip_test.estimate(image, region)
    other = flip_test.estimate(np.ascontiguousarray(image[:, ::-1]), replace(region, x=320 - 150))
    expected = np.column_stack([319 - pose.xy[joints, 0], pose.xy[joints, 1]])
    np.testing.assert_allclose(other.xy, expected, atol=1e-4)
    np.testing.assert_allclose(other.score, pose.score[joints], atol=1e-6)
    np.testing.assert_allclose(other.xyz_in_body, pose.xyz_in_body[joints] * [-1, 1, 1], atol=1e-6)
    assert other.presence == pytest.approx(pose.presence)
    np.testing.assert_allclose(other.region.x, 319 - pose.region.x, atol=1e-4)
    assert np.sin(other.region.angle_rad + pose.region.angle_rad) == pytest.approx(0, abs=1e-4)


def test_crops_at_once_give_the_joints_of_each_alone(blazepose_pair):
    path = blazepose_pair[1].network.path
    place = blazepose.BlazePoseLandmarks(path, pairs=skeleton.mirror(JOINTS))
    image = np.random.default_rng(2).integers(0, 255, (300, 320, 3), dtype=np.uint8)
    image = cv2.GaussianBlur(image, (0, 0), 9)
    regions = [detector.Region(150, 140, 256), detector.Region(190, 160, 200, 0.4)]
    alone = [place.estimate(image, region) for region in regions]
    place.network.at_once = True  # as by an execution provider that gains by it
    for one, other in zip(place.estimate_each(image, regions), alone, strict=True):
        np.testing.assert_allclose(one.xy, other.xy, atol=0.01)
        np.testing.assert_allclose(one.score, other.score, atol=1e-4)
        np.testing.assert_allclose(one.xyz_in_body, other.xyz_in_body, atol=1e-4)
    assert set(place.network._of_count) == {4}  # two crops and their mirror images


def look(x):
    fraction = np.column_stack([np.full(39, x), np.full(39, 0.25)])
    return fraction, np.full(33, 0.8), 0.9, np.zeros((33, 3))


def test_joints_that_the_mirror_places_elsewhere_count_less():
    same = blazepose.both(look(0.5), look(0.5))
    np.testing.assert_array_equal(same[1], 0.8)
    apart = blazepose.both(look(0.5), look(0.5 + blazepose.DOUBTED))
    np.testing.assert_allclose(apart[0][:, 0], 0.5 + blazepose.DOUBTED / 2)
    np.testing.assert_allclose(apart[1], 0.4)


def test_the_mirror_of_the_mirror_is_what_was_seen():
    values = np.random.default_rng(2).uniform(size=(39, 7))
    seen = values[:, :2], values[:33, 2], 0.5, values[:33, 3:6]
    pairs = skeleton.mirror(JOINTS)
    again = blazepose.mirrored(blazepose.mirrored(seen, pairs), pairs)
    for one, other in zip(seen, again, strict=True):
        np.testing.assert_allclose(one, other)
    left, right = (JOINTS.index(f"{side}_wrist") for side in ("left", "right"))
    once = blazepose.mirrored(seen, pairs)
    assert once[0][left, 0] == pytest.approx(255 / 256 - seen[0][right, 0])
