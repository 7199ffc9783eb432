from dataclasses import replace

import numpy as np

from courtside.depth import single_view
from courtside.records.keypoints import missing_reason
from courtside.records.keypoints.keypoints import Keypoints2D


def view(xy, in_body=None):
    """Return keypoints (P, T, J, 2); missing where NaN."""
    xy = np.asarray(xy, dtype=float)
    seen = np.isfinite(xy).all(axis=-1)
    empty = np.full((*xy.shape[:3], 3), np.nan)
    return Keypoints2D(
        camera="c",
        model="m",
        joints=np.array(["left_hip", "right_hip"]),
        size=np.array([640, 480]),
        time_s=np.arange(xy.shape[1]) / 30,
        xy=xy,
        score=np.where(seen, 0.9, np.nan),
        reason=np.where(seen, missing_reason.OK, missing_reason.UNSEEN).astype(np.uint8),
        xyz_in_body=empty if in_body is None else in_body,
        clothing=np.full((*xy.shape[:2], 2, 3), np.nan),
    )


NONE = [np.nan, np.nan]
NEAR, FAR = [[100, 100], [100, 300]], [[500, 100], [500, 150]]


def test_the_largest_in_the_picture_is_taken_in_each_frame():
    found = single_view.main_person(
        view([[FAR, FAR, [NONE, NONE]], [NEAR, [NONE, NONE], [NONE, NONE]]])
    )
    assert found.xy.shape == (1, 3, 2, 2)
    assert found.xy[0, 0].tolist() == NEAR
    assert found.xy[0, 1].tolist() == FAR
    assert (found.reason[0, 2] == missing_reason.UNSEEN).all()


def test_nobody_is_unseen():
    found = single_view.main_person(view(np.zeros((0, 4, 2, 2))))
    assert found.xy.shape == (1, 4, 2, 2)
    assert (found.reason == missing_reason.UNSEEN).all()


def test_a_thing_that_is_taken_for_a_person_is_doubted():
    seen = single_view.main_person(view([[NEAR, NEAR, [NONE, NONE]]]))
    assert single_view.doubt("cam-rgb", seen) is None
    unsure = replace(seen, score=np.where(np.isfinite(seen.score), 0.13, np.nan))
    assert "cam-rgb: expected joints with a median" in single_view.doubt("cam-rgb", unsure)
    assert "found 0.13" in single_view.doubt("cam-rgb", unsure)
    nobody = single_view.main_person(view(np.zeros((0, 4, 2, 2))))
    assert single_view.doubt("cam-rgb", nobody) is None


def test_a_person_who_changes_with_somebody_beside_is_told():
    squat = [[100, 100], [100, 140]]
    beside = [[300, 100], [300, 200]]
    both = view([[NEAR] * 40 + [squat] * 10, [beside] * 50])
    said = single_view.doubt_of_one("cam-rgb", both)
    assert said.startswith("cam-rgb: expected one person nearest")
    assert "in 10 of 50 frames, the first at 1.3 s" in said
    assert single_view.doubt_of_one("cam-rgb", view([[NEAR] * 50, [beside] * 50])) is None
    one_after_another = view([[NEAR] * 25 + [[NONE, NONE]] * 25, [[NONE, NONE]] * 25 + [FAR] * 25])
    assert single_view.doubt_of_one("cam-rgb", one_after_another) is None
    assert single_view.doubt_of_one("cam-rgb", view(np.zeros((0, 4, 2, 2)))) is None


def test_one_row_that_goes_over_to_somebody_of_another_size_is_told():
    nobody = [NONE, NONE]
    said = single_view.doubt_of_one("cam-rgb", view([[NEAR] * 35 + [nobody] * 3 + [FAR] * 15]))
    assert said.startswith(
        "cam-rgb: expected one person throughout, found one of 200 px and within"
    )
    assert "one of 50 px, at 1.3 s" in said
    later = view([[NEAR] * 35 + [nobody] * 35 + [FAR] * 15])
    assert single_view.doubt_of_one("cam-rgb", later) is None
    squats = [[[100, 300 - height], [100, 300]] for height in np.linspace(200, 80, 15)]
    alone = view([[NEAR] * 20 + squats + squats[::-1] + [NEAR] * 20])
    assert single_view.doubt_of_one("cam-rgb", alone) is None
    wrong_once = view([[NEAR] * 20 + [FAR] * 2 + [NEAR] * 20])
    assert single_view.doubt_of_one("cam-rgb", wrong_once) is None


def test_who_is_partly_outside_the_picture_is_of_no_known_size():
    """The feet are below the picture, and the arms that were the widest part are lowered."""
    wide = view([[NEAR] * 20 + [FAR] * 20])
    assert single_view.doubt_of_one("cam-rgb", wide)
    cut = np.zeros_like(wide.reason)
    cut[..., 0] = missing_reason.OUT_OF_IMAGE
    assert single_view.doubt_of_one("cam-rgb", replace(wide, reason=cut)) is None


def test_landmarks_become_a_motion():
    in_body = np.random.default_rng(0).normal(size=(1, 2, 2, 3))
    in_body[0, 1, 1] = np.nan
    seen = replace(view([[NEAR, NEAR]], in_body), time_s=np.array([7.0, 7.1]))
    motion = single_view.landmarks("cam-rgb", single_view.main_person(seen))
    assert (motion.source, motion.kind) == ("cam-rgb", "rgb")
    assert np.array_equal(motion.xyz, in_body[0], equal_nan=True)
    assert motion.reason.tolist() == [[0, 0], [0, missing_reason.UNSEEN]]
    assert motion.time_s.tolist() == [7.0, 7.1]
    assert motion.performed.all()
