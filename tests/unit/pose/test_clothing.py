"""Colours of clothes in painted pictures."""

import cv2
import numpy as np
import pytest

from courtside.pose.clothing import Clothing

JOINTS = ["nose", "left_shoulder", "right_shoulder", "left_hip", "right_hip", "left_knee"]
JOINTS += ["right_knee"]
XY = np.array([[100, 20], [130, 50], [70, 50], [120, 130], [80, 130], [125, 200], [75, 200]], float)
SHIRT, TROUSERS = (30, 60, 200), (120, 40, 20)  # BGR


def painted():
    image = np.full((240, 200, 3), 90, np.uint8)
    cv2.fillConvexPoly(image, XY[[1, 2, 4, 3]].astype(np.int32), SHIRT)
    for hip, knee in ((3, 5), (4, 6)):
        cv2.line(image, XY[hip].astype(int).tolist(), XY[knee].astype(int).tolist(), TROUSERS, 15)
    return image


def lab(bgr):
    return cv2.cvtColor(np.array([[bgr]], np.float32) / 255, cv2.COLOR_BGR2LAB)[0, 0]


@pytest.mark.parametrize("off_px", [(0, 0), (5, -4)])
def test_shirt_and_trousers_have_their_colours(off_px):
    found = Clothing(JOINTS).colours(painted(), XY + off_px)
    np.testing.assert_allclose(found, [lab(SHIRT), lab(TROUSERS)], atol=0.5)


def test_an_arm_before_the_shirt_changes_little():
    image = painted()
    cv2.line(image, (70, 90), (130, 90), (140, 170, 220), 20)
    np.testing.assert_allclose(Clothing(JOINTS).colours(image, XY)[0], lab(SHIRT), atol=0.5)


def test_what_is_outside_the_picture_has_no_colour():
    found = Clothing(JOINTS).colours(painted()[:132], XY)
    np.testing.assert_allclose(found[0], lab(SHIRT), atol=0.5)
    assert np.isnan(found[1]).all()
    assert np.isnan(Clothing(JOINTS).colours(painted(), np.full_like(XY, np.nan))).all()


def test_a_network_without_these_joints_gives_no_colours():
    assert np.isnan(Clothing(["head", "neck"]).colours(painted(), XY[:2])).all()
