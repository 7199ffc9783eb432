"""Keypoints moved by known shares of a torso are placed or not, where and when they were moved."""

from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from courtside.evaluation import detection
from courtside.records.devices.clocks import Clock
from courtside.study.errors import InputError
from fixtures.cameras import scene
from fixtures.people import keypoints_made

LIMBS = [
    f"{s}_{j}"
    for s in ("left", "right")
    for j in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
]
EXTRA = "rig_head"
CAMERA = scene.ring(1)[0]
HEIGHTS_M = [1.4, 1.1, 0.9, 0.9, 0.5, 0.1]
WIDTHS_M = [0.2, 0.3, 0.35, 0.12, 0.13, 0.14]


@dataclass
class Truth:
    """What `courtside.records.truth.take_truth.TakeTruth` has."""

    time_s: np.ndarray
    xyz: np.ndarray
    person_id: tuple = ("p1",)
    joints: tuple = (EXTRA, *LIMBS)
    shaken: dict = field(default_factory=dict)
    events: dict = field(default_factory=dict)


def truth(n_frames=10, n_persons=1):
    """Return upright people who stride 1.5 m/s along y, and are linear in time."""
    time_s = np.arange(n_frames) / 30
    body = np.array(
        [[0, side * w, h] for side in (1, -1) for w, h in zip(WIDTHS_M, HEIGHTS_M, strict=True)]
    )
    body = np.concatenate([[[0, 0, 1.6]], body])
    path = np.outer(time_s, [0, 1.5, 0])
    xyz = np.stack([body + path[:, None] + [0.9 * at, 0, 0] for at in range(n_persons)])
    return Truth(time_s, xyz, tuple(f"p{at + 1}" for at in range(n_persons)))


def seen(real, time_s=None, camera=CAMERA, order=None):
    """Return a perfect detection of the people, its tracklets in any order."""
    moved = (
        real.xyz
        if time_s is None
        else real.xyz[:, :1] + np.outer(time_s, [0, 1.5, 0])[None, :, None]
    )
    xy = scene.opencv_projection(camera, moved.reshape(-1, 3)).reshape(*moved.shape[:3], 2)
    xy = xy[list(order or range(len(xy))), :, 1:]
    own_s = real.time_s if time_s is None else time_s
    return keypoints_made.view(camera, LIMBS, own_s, xy)


def evaluate(view, real, clock=None, camera=CAMERA):
    return detection.evaluate(camera, view, clock or Clock(), real, LIMBS)


def test_a_perfect_detection_is_placed_everywhere():
    real = truth()
    rows = evaluate(seen(real), real)
    assert list(rows.columns) == detection.COLUMNS
    assert len(rows) == 10 * 12
    assert rows.placed.all() and rows.found.all() and rows.in_picture.all()
    assert not rows.exchanged.any()
    np.testing.assert_allclose(rows.error_px, 0, atol=1e-6)


@pytest.mark.parametrize(("share", "placed"), [(0.19, True), (0.21, False)])
def test_a_known_displacement_is_a_known_share_of_the_torso(share, placed):
    real = truth()
    view, torso = seen(real), evaluate(seen(real), real).torso_px.iloc[0]
    xy = view.xy.copy()
    xy[0, 0, LIMBS.index("left_wrist")] += [0.6 * share * torso, 0.8 * share * torso]
    rows = evaluate(replace(view, xy=xy), real)
    moved = (rows.frame_idx == 0) & (rows.joint == "left_wrist")
    np.testing.assert_allclose(rows[moved].error_torso, share, atol=1e-9)
    assert rows[moved].placed.item() == placed
    assert rows[~moved].placed.all()


def test_the_torso_is_as_long_as_it_would_be_seen_square_on():
    # 0.5 m at 8 m from a camera of 1400 px without distortion, and the same torso pointing at it.
    camera = scene.ring(1, radius_m=8.0, height_m=1.0)[0]
    joints, towards = list(detection.TRUNK), camera.cam_from_world[2, :3]
    upright = np.array([[0, 0, 1.25], [0, 0, 1.25], [0, 0, 0.75], [0, 0, 0.75]])
    pointing = np.array([0, 0, 1.0]) + np.outer([-0.25, -0.25, 0.25, 0.25], towards)
    for xyz in (upright, pointing):
        found = detection.torso_px(camera, joints, xyz)
        np.testing.assert_allclose(found, scene.FOCAL_PX * 0.5 / 8.0, rtol=1e-9)


def test_exchanged_sides_are_marked_and_not_placed():
    real = truth()
    view = seen(real)
    xy, pair = view.xy.copy(), [LIMBS.index("left_ankle"), LIMBS.index("right_ankle")]
    xy[:, 4:, pair] = xy[:, 4:, pair[::-1]]
    rows = evaluate(replace(view, xy=xy), real)
    changed = rows.joint.str.endswith("ankle") & (rows.frame_idx >= 4)
    assert (rows.placed == ~changed).all()
    assert (rows.exchanged == changed).all()


def test_nobody_found_is_not_placed():
    real = truth()
    view = seen(real)
    xy = view.xy.copy()
    xy[:, 3] = np.nan  # no tracklet
    xy[:, 5] += 500.0  # somebody else, far away
    rows = evaluate(replace(view, xy=xy), real)
    missing = rows.frame_idx.isin([3, 5])
    assert (rows.found == ~missing).all() and (rows.placed == ~missing).all()
    assert rows[missing].error_px.isna().all()


def test_tracklets_are_assigned_to_the_persons_they_show():
    real = truth(n_persons=2)
    rows = evaluate(seen(real, order=(1, 0)), real)
    assert rows.placed.all() and set(rows.person) == {"p1", "p2"}


def test_the_cameras_clock_is_used():
    real, clock = truth(n_frames=30), Clock(offset_s=0.4, drift_ppm=100)
    own = 0.4 + 0.0101 + np.arange(20) / 30
    view = replace(seen(real, time_s=clock.to_reference(own)), time_s=own)
    rows = evaluate(view, real, clock)
    np.testing.assert_allclose(rows.error_px, 0, atol=1e-3)
    np.testing.assert_allclose(rows.time_s.iloc[0], (own[0] - 0.4) / 1.0001)
    assert not evaluate(view, real).placed.any()


def test_frames_without_a_truth_are_left_out():
    real = truth(n_frames=10)
    view = seen(real, time_s=np.arange(-3, 15) / 30)
    assert set(evaluate(view, real).frame_idx) == set(range(3, 13))


def test_a_shaken_camera_is_compared_at_its_own_pose():
    real = truth()
    pose = CAMERA.cam_from_world.copy()
    pose[:, 3] += [0.05, -0.02, 0.0]
    moved = replace(CAMERA, cam_from_world=pose)
    view = seen(real, camera=moved)
    assert evaluate(view, real).error_px.max() > 5
    real.shaken = {CAMERA.name: np.repeat(pose[None], 10, axis=0)}
    np.testing.assert_allclose(evaluate(view, real).error_px, 0, atol=1e-6)


def test_joints_outside_the_picture_are_marked():
    real = truth()
    camera = replace(CAMERA, size=(CAMERA.size[0], 540))
    view = replace(seen(real), size=np.array(camera.size))
    rows = evaluate(view, real, camera=camera)
    np.testing.assert_array_equal(rows.in_picture, rows.true_y_px < 539.5)
    assert 0 < rows.in_picture.sum() < len(rows)


def test_strokes_are_between_their_events():
    real = truth()
    real.events = {"p1": {"hit": 0.1, "hit_start": 0.06, "hit_stop": 0.21, "clap_start": 0.3}}
    rows = evaluate(seen(real), real)
    assert set(rows[rows.in_stroke].frame_idx) == {2, 3, 4, 5, 6}


def test_who_stands_in_a_t_pose_or_splits_is_not_in_a_stroke():
    real = truth()
    real.events = {
        "p1": {"tpose_1_start": 0.0, "tpose_1_stop": 0.1, "clap_1": 0.2}
        | {"split_1_start": 0.0, "split_1_stop": 0.15}
        | {"hit_2": 0.27, "hit_2_start": 0.23, "hit_2_stop": 0.3}
    }
    rows = evaluate(seen(real), real)
    assert set(rows[rows.in_stroke].frame_idx) == {7, 8, 9}


def test_a_network_without_the_joints_is_refused():
    real = truth()
    view = seen(real)
    fewer = replace(view, joints=view.joints[:-1], xy=view.xy[:, :, :-1])
    with pytest.raises(InputError, match="right_ankle"):
        evaluate(fewer, real)


def reference_of(view, xy):
    return replace(keypoints_made.view(CAMERA, LIMBS, view.time_s, xy), model="hand")


def test_keypoints_are_compared_with_those_of_another_program():
    view = seen(truth())
    torso = np.linalg.norm(view.xy[0, :, [0, 6]].mean(0) - view.xy[0, :, [3, 9]].mean(0), axis=-1)
    moved = view.xy.copy()
    moved[0, 3, LIMBS.index("left_wrist")] += [0.25 * torso[3], 0]
    moved[0, 5, LIMBS.index("left_knee")] = np.nan
    sides = [LIMBS.index(name) for name in ("left_ankle", "right_ankle")]
    moved[0, 7, sides] = moved[0, 7, sides[::-1]]
    rows = detection.against(view, reference_of(view, moved), LIMBS)
    assert list(rows.columns) == detection.COLUMNS and set(rows.person) == {"hand 1"}
    np.testing.assert_allclose(rows.torso_px.to_numpy()[::12], torso)
    far = rows[(rows.error_px > 1e-6) & (rows.frame_idx != 7)]
    assert far[["frame_idx", "joint"]].values.tolist() == [[3, "left_wrist"]]
    assert far.error_torso.item() == pytest.approx(0.25) and not far.placed.item()
    assert rows[~rows.in_picture][["frame_idx", "joint"]].values.tolist() == [[5, "left_knee"]]
    assert rows[rows.exchanged][["frame_idx", "joint"]].values.tolist() == [
        [7, "left_ankle"],
        [7, "right_ankle"],
    ]


def test_only_the_persons_that_the_take_is_of_are_compared():
    both = seen(truth(n_persons=2))
    part = both.xy.copy()
    part[0, 4:] = np.nan  # seen in fewer frames than the other
    rows = detection.against(both, reference_of(both, part), LIMBS, n_persons=1)
    assert len(rows) == 10 * 12 and rows.placed.all()
    with pytest.raises(InputError, match="expected the 10 frames"):
        detection.against(both, reference_of(seen(truth(9)), part[:, :9]), LIMBS)
