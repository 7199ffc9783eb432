"""Distances between bodies of two views, against OpenCV's epipolar lines and exact scenes."""

import cv2
import numpy as np
import pytest

from courtside.geometry import camera as camera_models
from courtside.reconstruction.association import candidates
from fixtures.cameras import scene
from fixtures.people import stick_figures

MIRROR = [1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10]


def test_epipolar_distance_is_opencvs():
    one, other = scene.ring(2)
    rng = np.random.default_rng(1)
    first, second = rng.uniform(300, 900, (1, 1, 7, 2)), rng.uniform(300, 900, (1, 1, 7, 2))
    rotation = other.cam_from_world[:, :3] @ one.cam_from_world[:, :3].T
    x, y, z = other.cam_from_world[:, 3] - rotation @ one.cam_from_world[:, 3]
    inverse = np.linalg.inv(one.K)
    fundamental = inverse.T @ np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ rotation @ inverse
    distances = []
    for which, here, there in ((1, first, second), (2, second, first)):
        lines = cv2.computeCorrespondEpilines(here.reshape(-1, 1, 2), which, fundamental)[:, 0]
        distances.append(np.abs((lines[:, :2] * there[0, 0]).sum(axis=1) + lines[:, 2]))
    plane = [(xy - [959.5, 539.5]) / scene.FOCAL_PX for xy in (first, second)]
    found = candidates.epipolar_distance(one, other, *plane)
    assert found.shape == (1, 1, 1)
    assert found[0, 0, 0] == pytest.approx(np.median(np.mean(distances, axis=0)), rel=1e-6)


def test_two_joints_in_common_say_nothing():
    one, other = scene.ring(2)
    xy = np.full((1, 1, 5, 2), np.nan)
    xy[..., :2, :] = 0.1
    assert np.isinf(candidates.epipolar_distance(one, other, xy, xy)).all()


def planes(cameras):
    """Return what cameras see of two people, on the normalised plane."""
    time_s = np.arange(5) / 30
    people = np.stack(
        [
            stick_figures.body(np.outer(time_s, [1.0, 0.3]) + start, time_s)
            for start in ([0.5, 0.5], [-1, 0])
        ]
    )
    flat = [scene.opencv_projection(camera, people.reshape(-1, 3)) for camera in cameras]
    return [
        camera_models.undistort(camera, xy.reshape(2, 5, 12, 2))
        for camera, xy in zip(cameras, flat, strict=True)
    ]


def test_rows_of_one_body_agree_and_others_do_not():
    cameras = scene.ring(3)
    pairs = candidates.of_pairs(cameras, planes(cameras), [np.full(2, 4.0)] * 3)
    assert sorted(pairs) == [(0, 1), (0, 2), (1, 2)]
    for distance in pairs.values():
        assert distance.shape == (2, 2, 5)
        assert distance[[0, 1], [0, 1]].max() < 1e-6
        assert distance[[0, 1], [1, 0]].min() > 1
    row = np.array([[0, 0, 0], [0, 0, 1], [1, -1, 1]])
    off = candidates.of_views(pairs, np.zeros(3, int), row, 8.0)
    assert off[0].max() < 1e-6
    assert off[1, 2] > off[1, 0] > 0.5
    assert off[2].tolist() == pytest.approx([0, 0, 0], abs=1e-6)
    assert off[1, 2] <= 8


def test_a_view_that_takes_left_for_right_still_agrees():
    cameras = scene.ring(2, radius_m=5)
    one, other = planes(cameras)
    sigma = [np.full(2, 4.0)] * 2
    turned = [one, other[:, :, MIRROR]]
    plain = candidates.of_pairs(cameras, turned, sigma)[0, 1]
    either = candidates.of_pairs(cameras, turned, sigma, MIRROR)[0, 1]
    assert plain[[0, 1], [0, 1]].min() > 0.5
    assert either[[0, 1], [0, 1]].max() < 1e-6
