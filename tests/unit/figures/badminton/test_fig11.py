"""Exactly the joints that were moved are marked, with the distance they were moved by."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.evaluation import detection
from courtside.figures.badminton import fig11
from courtside.figures.style import picture_crops
from courtside.reconstruction import camera_shake, fusion
from fixtures.cameras import scene, shaken
from fixtures.people import takes_made, walker

LIMIT = 0.1
FRAME = 9
AT = walker.SKELETON.index


def moved(*changes):
    """Return a take in which (frame, joint, camera, dx_px) were detected elsewhere."""
    record, seen = takes_made.take()
    error = record.reproj_error_px.copy()
    views = [one.view.xy.copy() for one in seen]
    for frame, joint, camera, dx_px in changes:
        views[camera][0, frame, AT(joint), 0] += dx_px
        error[0, frame, AT(joint), camera] = dx_px
    seen = [
        replace(one, tracklets=replace(one.view, xy=xy))
        for one, xy in zip(seen, views, strict=True)
    ]
    return replace(record, reproj_error_px=error), seen


def limits(record, share=LIMIT):
    return fig11.disagreements(record, takes_made.CAMERAS, takes_made.LIMBS, share)


def table(record, seen):
    mirror = walker.SKELETON.mirror()
    limit = limits(record)
    return fig11.table(record, seen, takes_made.LIMBS, mirror, FRAME, limit)


def test_the_limit_is_a_share_of_the_torso_in_each_picture():
    record, _ = takes_made.take()
    _, _, limit_px = limits(record)
    for at, camera in enumerate(takes_made.CAMERAS):
        torso = detection.torso_px(camera, record.joints, record.xyz[0])
        assert limit_px[0, at] == pytest.approx(0.1 * np.median(torso))


@pytest.mark.parametrize(("share", "marked"), [(0.99, False), (1.01, True)])
def test_a_joint_is_marked_beyond_the_limit(share, marked):
    _, _, limit_px = limits(takes_made.take()[0])
    record, _ = moved((FRAME, "left_wrist", 1, share * limit_px[0, 1]))
    disagrees, known, _ = limits(record)
    assert disagrees.sum() == marked
    assert known.all()
    if marked:
        joint = list(takes_made.LIMBS).index("left_wrist")
        assert disagrees[0, FRAME, joint, 1]


def test_the_frame_with_most_marks_is_chosen_and_only_in_the_span():
    record, _ = moved(
        (4, "left_wrist", 0, 90), (6, "left_wrist", 0, 90), (6, "left_knee", 2, 90),
        *((15, joint, 0, 90) for joint in ("left_hip", "left_knee", "left_ankle")),
    )  # fmt: skip
    disagrees, _, _ = limits(record)
    assert fig11.choose(disagrees, slice(2, 12)) == 6
    assert fig11.choose(disagrees, slice(2, 19)) == 15


def test_the_table_marks_exactly_what_was_moved():
    record, seen = moved(
        (FRAME, "left_wrist", 1, 60), (FRAME, "right_ankle", 2, 70), (3, "left_wrist", 1, 60)
    )
    rows = table(record, seen)
    marked = rows[rows.disagrees]
    assert set(zip(marked.camera, marked.joint, strict=True)) == {
        ("c1", "left_wrist"),
        ("c2", "right_ankle"),
    }
    apart = np.hypot(
        marked.detected_x_px - marked.reprojected_x_px,
        marked.detected_y_px - marked.reprojected_y_px,
    )
    np.testing.assert_allclose(apart, marked.error_px, atol=1e-6)
    assert sorted(marked.error_px) == [60, 70]
    share = rows.set_index(["camera", "joint"]).take_disagree_percent
    assert share["c1", "left_wrist"] == pytest.approx(100 * 2 / 20)
    assert share["c0", "left_wrist"] == 0


def test_a_joint_without_3d_is_not_known_and_not_marked():
    record, seen = takes_made.take()
    error, xyz = record.reproj_error_px.copy(), record.xyz.copy()
    error[:, :, AT("left_elbow")], xyz[:, :, AT("left_elbow")] = np.nan, np.nan
    rows = table(replace(record, reproj_error_px=error, xyz=xyz), seen)
    own = rows[rows.joint == "left_elbow"]
    assert not own.disagrees.any()
    assert (own.take_frames == 0).all() and own.take_disagree_percent.isna().all()


@pytest.fixture
def knees():
    """Return a take whose first camera has the knees exchanged, and the indices of these."""
    record, seen = takes_made.take()
    pair = [AT("left_knee"), AT("right_knee")]
    xy = seen[0].view.xy.copy()
    xy[:, :, pair] = xy[:, :, pair[::-1]]
    seen[0] = replace(seen[0], tracklets=replace(seen[0].view, xy=xy))
    return record, seen, pair


def test_sides_that_the_fusion_exchanged_are_taken_as_it_took_them(knees):
    record, seen, pair = knees
    record.swapped[:, FRAME, pair, 0] = True  # and its errors stay 0
    rows = table(record, seen)
    changed = rows.sides_exchanged
    assert set(zip(rows[changed].camera, rows[changed].joint, strict=True)) == {
        ("c0", "left_knee"),
        ("c0", "right_knee"),
    }
    np.testing.assert_allclose(rows.detected_x_px, rows.reprojected_x_px, atol=1e-6)


def test_a_keypoint_near_the_other_sides_joint_is_no_exchange_unless_the_fusion_says_so(knees):
    record, seen, _ = knees
    assert not table(record, seen).sides_exchanged.any()


def test_a_planted_swap_reaches_the_table_through_the_fusion():
    _, seen = takes_made.take(n_frames=40)
    legs = [AT(joint) for joint in walker.SKELETON.side_groups()[1]]
    mirror = np.array(walker.SKELETON.mirror())
    at = slice(FRAME - 3, FRAME + 4)
    seen[1].view.xy[:, at, legs] = seen[1].view.xy[:, at, mirror[legs]]
    made = fused(seen, [one.view for one in seen])
    limit = limits(made)
    tables = [
        fig11.table(made, seen, takes_made.LIMBS, mirror, frame, limit)
        for frame in (FRAME, FRAME + 8)
    ]
    changed = tables[0][tables[0].sides_exchanged]
    assert set(changed.camera) == {"c1"}
    of_legs = {j for j in takes_made.LIMBS if j.endswith(("hip", "knee", "ankle"))}
    assert set(changed.joint) == of_legs
    np.testing.assert_allclose(changed.detected_x_px, changed.reprojected_x_px, atol=0.1)
    assert not tables[1].sides_exchanged.any()


def fused(seen, views):
    options = {"min_score": 0.3, "min_views": 2, "max_error_px": 15, "fade_px": 20, **scene.SHARES}
    clocks = [one.clock for one in seen]
    return fusion.triangulate_take(
        takes_made.CAMERAS,
        views,
        walker.SKELETON,
        ["p1"],
        clocks=clocks,
        fix_sides=True,
        **options,
    )


def test_a_knock_of_14_px_is_no_swap_and_no_disagreement():
    record, seen = takes_made.take(n_frames=40)
    camera = seen[1].camera
    vectors = shaken.knock(camera, 40, 5, 14.0, tremor_px=2)
    seen[1] = replace(seen[1], tracklets=shaken.view(seen[1].view, camera, vectors))
    tables = {camera.name: shaken.table(camera, vectors, seen[1].view.time_s)}
    views = [one.view for one in seen]
    views[1] = camera_shake.steady(views[1], camera, tables[camera.name])
    made = fused(seen, views)
    assert not made.swapped.any()
    np.testing.assert_allclose(made.xyz, record.xyz, atol=1e-4)
    limit = fig11.disagreements(made, takes_made.CAMERAS, takes_made.LIMBS, LIMIT / 10)
    seen = camera_shake.put_back(seen, tables)
    rows = fig11.table(made, seen, takes_made.LIMBS, walker.SKELETON.mirror(), FRAME, limit)
    assert not rows.sides_exchanged.any() and not rows.disagrees.any()
    # In px of the shaken picture: those of the network, and a skeleton that lies on them.
    of = rows[rows.camera == "c1"]
    drawn = seen[1].view.xy[0, FRAME, [AT(joint) for joint in takes_made.LIMBS]]
    np.testing.assert_array_equal(of[["detected_x_px", "detected_y_px"]], drawn)
    np.testing.assert_allclose(of[["reprojected_x_px", "reprojected_y_px"]], drawn, atol=0.1)
    left = fig11.disagreements(
        fused(seen, [one.view for one in seen]), takes_made.CAMERAS, takes_made.LIMBS, LIMIT / 10
    )
    assert left[0].any()


def test_a_camera_that_does_not_film_then_is_not_said_to_agree():
    record, seen = takes_made.take()
    record.reproj_error_px[:, 5:, :, 1] = np.nan
    seen[1] = takes_made.stopped(seen[1], 5)
    rows = table(record, seen)
    assert rows.detected_x_px.isna().equals(rows.camera == "c1")
    images, both = takes_made.pictures(), ({}, {})
    images["c1"], *_ = picture_crops.at_frame(seen[1], record, FRAME, walker.SKELETON, hidden=True)
    for one in seen:
        for kind, xy in zip(both, picture_crops.joints_at(one, record, FRAME), strict=True):
            kind[one.camera.name] = takes_made.STICK.of(xy)
    drawing = fig11.draw(rows, images, *both, takes_made.STICK, LIMIT)
    labels = [axis.get_xlabel() for axis in drawing.axes[:3]]
    assert labels == ["none above the limit", "", "none above the limit"]
    assert [text.get_text() for text in drawing.axes[1].texts] == ["does not film then"]


def test_shares_are_of_the_frames_with_both_and_few_of_them_are_told():
    record, seen = moved((FRAME, "left_wrist", 1, 60), (3, "left_wrist", 1, 60))
    record.reproj_error_px[:, 12:, AT("left_wrist"), 1] = np.nan
    record.reproj_error_px[:, 8:, AT("right_wrist"), 1] = np.nan
    nowhere = {name: np.full((1, 14, 2), np.nan) for name in takes_made.pictures()}
    drawing = fig11.draw(
        table(record, seen), takes_made.pictures(), nowhere, nowhere, takes_made.STICK, LIMIT
    )
    axis = drawing.axes[3]
    cells = [text.get_text() for text in axis.texts[12:24]]  # of c1
    joints = list(takes_made.LIMBS)
    assert cells[joints.index("left_wrist")] == "17"  # 2 of 12, of 20 frames in the take
    assert cells[joints.index("right_wrist")] == "0 (8)"
    assert sum("(" in text.get_text() for text in axis.texts) == 1
    assert "of the frames with both" in axis.get_title()


def test_rings_are_drawn_where_the_moved_joints_were_detected():
    record, seen = moved((FRAME, "left_wrist", 1, 60), (FRAME, "right_ankle", 1, 70))
    rows = table(record, seen)
    detected = {one.camera.name: takes_made.STICK.of(one.view.xy[:, FRAME]) for one in seen}
    reprojected = {
        one.camera.name: takes_made.STICK.of(one.reprojected(record, FRAME)) for one in seen
    }
    drawing = fig11.draw(
        rows, takes_made.pictures(), detected, reprojected, takes_made.STICK, LIMIT
    )
    assert [axis.get_xlabel() for axis in drawing.axes[:3]] == [
        "none above the limit",
        "right ankle 70 px\nleft wrist 60 px",
        "none above the limit",
    ]
    for at, axis in enumerate(drawing.axes[:3]):
        rings = [
            line.get_xydata()[0]
            for line in axis.lines
            if line.get_markeredgecolor() == picture_crops.MARKED and line.get_marker() == "o"
        ]
        wanted = [seen[1].view.xy[0, FRAME, AT(j)] for j in ("left_wrist", "right_ankle")]
        np.testing.assert_allclose(rings, wanted if at == 1 else np.zeros((0, 2)).tolist())
    cells = [text.get_text() for text in drawing.axes[3].texts]
    assert len(cells) == 3 * 12
    assert sorted(set(cells)) == ["0", "5"] and cells.count("5") == 2
    drawing.draw_without_rendering()
