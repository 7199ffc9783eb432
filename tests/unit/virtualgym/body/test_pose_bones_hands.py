"""Fingers close round a grip, and only fingers move."""

import numpy as np
import pytest

from fixtures.people import mannequin
from virtualgym.body import pose_bones, racket
from virtualgym.body.stance import SIDES

FINGERTIPS = [f"finger{n}-3" for n in pose_bones.FINGERS]


@pytest.fixture(scope="module")
def figure():
    return mannequin.figure("m3")


@pytest.fixture(scope="module")
def skeleton(figure):
    return pose_bones.Skeleton.of(figure)


def from_axis(skeleton, side, point, grip):
    """Return how far a point is from the grip's axis, m."""
    away = point - grip
    return np.linalg.norm(away - (away @ skeleton.across[side]) * skeleton.across[side])


@pytest.mark.parametrize("side", SIDES)
def test_closed_fingers_lie_round_the_grip(figure, skeleton, side):
    grip = pose_bones.grip(figure, skeleton, side)
    closed = pose_bones.bent(figure, skeleton, side, closed=True)
    for finger in FINGERTIPS:
        before, after = (each.tail(finger + pose_bones.SUFFIX[side]) for each in (figure, closed))
        assert from_axis(skeleton, side, before, grip) > 0.05
        assert from_axis(skeleton, side, after, grip) < 0.04


@pytest.mark.parametrize("side", SIDES)
def test_loose_fingers_bend_towards_the_palm(figure, skeleton, side):
    loose = pose_bones.bent(figure, skeleton, side, closed=False)
    for finger in FINGERTIPS:
        moved = loose.tail(finger + pose_bones.SUFFIX[side]) - figure.tail(
            finger + pose_bones.SUFFIX[side]
        )
        assert 0.005 < moved @ skeleton.palms[side] < 0.06


@pytest.mark.parametrize("side", SIDES)
def test_nothing_but_fingers_moves(figure, skeleton, side):
    closed = pose_bones.bent(figure, skeleton, side, closed=True)
    moved = np.linalg.norm(closed.vertices - figure.vertices, axis=1) > 1e-6
    wrist = skeleton.heads["wrist" + pose_bones.SUFFIX[side]]
    assert np.linalg.norm(figure.vertices[moved] - wrist, axis=1).max() < 0.25
    for bone in pose_bones.BONES:
        np.testing.assert_allclose(closed.head(bone), figure.head(bone), atol=1e-12)


@pytest.mark.parametrize("side", SIDES)
def test_the_grip_lies_on_the_palm_not_in_it(figure, skeleton, side):
    wrist = skeleton.heads["wrist" + pose_bones.SUFFIX[side]]
    out = (pose_bones.grip(figure, skeleton, side) - wrist) @ skeleton.palms[side]
    knuckle = (skeleton.knuckles[side] - wrist) @ skeleton.palms[side]
    assert out - knuckle > max(racket.GRIP_RADII_M)
    assert out - knuckle < 0.05
