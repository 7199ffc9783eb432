"""Lenses of OpenCV's longer models and fisheye lenses as five coefficients, or refused."""

import cv2
import numpy as np
import pytest

from courtside.geometry import camera as cameras
from courtside.geometry import lens_fit
from courtside.study.errors import InputError

SIZE, K = (1088, 1920), np.array([[1681.0, 0, 551], [0, 1684, 962], [0, 0, 1]])
RATIONAL = np.array([-0.20, 0.09, 0.001, -0.0007, -0.02, 0.05, 0.01, -0.003])
WIDE = np.array([0.5, -2.8, 8e-4, -3e-4, 1.63, 0.38, -2.62, 1.55])
PRISM = np.array([*RATIONAL, 1e-5, 0, -1e-5, 0])
TILTED = np.array([*RATIONAL, 0, 0, 0, 0, 1e-5, 1e-5])
LONG = np.array([[3400.0, 0, 551], [0, 3404, 962], [0, 0, 1]])
FISHEYE = np.array([-0.03, 0.01, -0.004, 0.0008])


def shown(xy, dist, matrix, fisheye=False):
    """Return px by OpenCV of directions that the grid's pixels would have without distortion."""
    ideal = ((xy - matrix[:2, 2]) / np.diag(matrix)[:2])[:, None]
    if fisheye:
        return cv2.fisheye.distortPoints(ideal, matrix, dist)[:, 0]
    places = cv2.convertPointsToHomogeneous(ideal)
    return cv2.projectPoints(places, np.zeros(3), np.zeros(3), matrix, dist)[0][:, 0]


@pytest.mark.parametrize(
    ("dist", "fisheye"),
    [(RATIONAL, False), (PRISM, False), (TILTED, False), (FISHEYE, True), (np.zeros(4), True)],
)
def test_five_coefficients_follow_a_moderate_lens(dist, fisheye):
    matrix = LONG if fisheye else K
    found = lens_fit.five("a", SIZE, matrix, dist, fisheye=fisheye)
    rng = np.random.default_rng(1)
    xy = rng.uniform([0, 0], np.array(SIZE) - 1, (500, 2))
    there = shown(xy, dist, matrix, fisheye)
    inside = ((there >= 0) & (there <= np.array(SIZE) - 1)).all(axis=1)
    assert inside.sum() > 400
    off = np.abs(shown(xy, found, matrix) - there)[inside]
    assert off.max() < lens_fit.MOST_OFF_PX


def test_an_own_lens_of_five_coefficients_is_found_again():
    dist = np.array([-0.2, 0.1, 0.001, -0.001, 0.02])
    found = lens_fit.five("a", SIZE, K, np.pad(dist, (0, 3)), fisheye=False)
    np.testing.assert_allclose(found, dist, atol=1e-8)


@pytest.mark.parametrize(
    ("dist", "fisheye", "found"),
    [
        (WIDE, False, r"\d.* px \(8 coefficients\)"),
        (np.array([0, 0, 0, 0, 0, 40.0, 0, 0]), False, r"one that cannot be .* \(8 coefficients\)"),
        (np.array([0.02, -0.01, 0.004, -0.001]), True, r"\d.* px \(fisheye = true\)"),
    ],
)
def test_another_lens_is_refused_with_the_deviation(dist, fisheye, found):
    wide = K * [[0.45], [0.45], [1]] + [[0, 0, 303], [0, 0, 529], [0, 0, 0]]
    with pytest.raises(InputError, match=rf"^a: .* 0.01 px over the picture, found {found}; calib"):
        lens_fit.five("a", SIZE, wide, dist, fisheye=fisheye)


@pytest.mark.parametrize(
    ("fisheye", "distortions", "agrees"),
    [(True, FISHEYE, True), (True, [*FISHEYE, 0.0], True), (True, [*FISHEYE, 0.1], False),
     (True, [0.1], False), (False, RATIONAL.tolist(), True), (False, [*RATIONAL, 0, 0], False)],
)  # fmt: skip
def test_files_of_cameras_have_such_lenses(fisheye, distortions, agrees):
    matrix = LONG if fisheye else K
    table = {"size": SIZE, "matrix": matrix.tolist(), "distortions": list(distortions)}
    table |= {"fisheye": fisheye, "rotation": [0, 0, 0.1], "translation": [0, 0, 1.0]}
    if agrees:
        found = cameras.build("a", "left", table, 1.0).dist
        many = np.asarray(distortions)[: 4 if fisheye else None]
        expected = lens_fit.five("a", SIZE, matrix, many, fisheye=fisheye)
        np.testing.assert_array_equal(found, expected)
    else:
        with pytest.raises(InputError, match=r"^a: expected distortions"):
            cameras.build("a", "left", table, 1.0)
