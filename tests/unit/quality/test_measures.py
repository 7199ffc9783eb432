"""Shares and errors of a take, against what was planted."""

import numpy as np
import pytest

from courtside.quality import measures
from fixtures.people import judged, walker


def test_a_take_without_a_fault_has_full_shares():
    seen = judged.gathered(judged.footage())
    for camera in range(4):
        found = measures.of_camera(seen, camera)
        assert found["found"] == found["followed"] == 1
        assert found["accepted"] > 0.98
        # 3 px per axis and joint, the mean of two, of about 300 px: 0.008, and the others' part
        assert 0.005 < found["reprojection"] < 0.02
    for person in range(2):
        found = measures.of_person(seen, person)
        assert found["views_2"] == 1 and found["views_3"] > 0.97
        assert found["limb_length"] < 0.06


def test_frames_without_anybody_and_without_a_track_are_told_apart():
    cameras = judged.footage(hidden={1: 0.4})
    cameras = judged.followed(cameras, {"c0": (0, -1), **dict.fromkeys(("c1", "c2", "c3"), (0, 1))})
    seen = judged.gathered(cameras)
    hidden, untracked = (measures.of_camera(seen, at) for at in (1, 0))
    assert hidden["found"] == pytest.approx(0.6, abs=0.01) == hidden["followed"]
    assert untracked["found"] == 1 and untracked["followed"] == 0.5


def test_nobody_at_all_is_known_to_be_nobody():
    seen = judged.gathered(judged.footage(hidden=dict.fromkeys(range(4), 1.0)))
    found = measures.of_camera(seen, 0)
    assert found["found"] == found["followed"] == 0 and np.isnan(found["reprojection"])
    assert measures.of_person(seen, 0)["views_2"] == 0


def test_the_length_of_limbs_varies_as_it_was_made():
    rng, body = np.random.default_rng(0), walker.body(400)
    names = list(walker.SKELETON.joints)
    assert measures.limb_variation(body, names) < 1e-9
    noisy = body + rng.normal(0, 0.002, body.shape)
    lengths = [
        np.linalg.norm(body[0, names.index(a)] - body[0, names.index(b)])
        for a, b in walker.SKELETON.segments.values()
    ]
    assert len(lengths) > 4
    made = np.median([np.sqrt(2) * 0.002 / length for length in lengths])  # noise of both ends
    assert measures.limb_variation(noisy, names) == pytest.approx(made, rel=0.05)
