"""The height of a person in a picture: by depth, not by posture, and not by a view that errs."""

import numpy as np
import pytest

from courtside.reconstruction import person_height
from courtside.records.keypoints import skeleton as limbs
from fixtures.cameras import scene
from fixtures.people import walker

CAMERAS = scene.ring(4)


def seen(n_frames=30):
    record = walker.points(n_frames)
    views = walker.views(record, CAMERAS)
    return np.stack([v.xy for v in views]), np.stack([v.score for v in views])


def true_px(n_frames=30):
    """Return (C, T): focal length over the depth of the trunk, times the stature."""
    trunk = [walker.SKELETON.index(j) for j in limbs.TRUNK]
    middle = np.median(walker.body(n_frames)[:, trunk], axis=1)
    depth = [middle @ c.cam_from_world[2, :3] + c.cam_from_world[2, 3] for c in CAMERAS]
    return 1.7 * scene.FOCAL_PX / np.array(depth)


def test_the_height_follows_the_depth():
    found = person_height.in_pictures(CAMERAS, *seen(), walker.SKELETON.joints)
    np.testing.assert_allclose(found[:, 0], true_px(), rtol=1e-3)


def test_a_view_of_somebody_else_and_a_gap_change_nothing():
    xy, score = seen()
    xy[1] = xy[1, :, ::-1] * 0.3 + 50
    xy[:, :, 10:14] = np.nan
    found = person_height.in_pictures(CAMERAS, xy, score, walker.SKELETON.joints)
    np.testing.assert_allclose(found[[0, 2, 3], 0], true_px()[[0, 2, 3]], rtol=0.02)


def test_views_that_never_agree_leave_the_extent_of_the_keypoints():
    xy, score = seen()
    xy[1:] = np.nan
    found = person_height.in_pictures(CAMERAS, xy, score, walker.SKELETON.joints)
    tall = np.median(np.ptp(xy[0, 0, :, :, 1], axis=1))
    assert found[0] == pytest.approx(np.full((1, 30), tall), rel=1e-6)
    assert (found[1:] == person_height.LEAST_PX).all()
