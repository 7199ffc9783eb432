"""Signs of a wrong joint: each planted fault raises its own sign, at its joint and time."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from courtside.geometry import triangulation
from courtside.reconstruction import error_signs, fusion
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import keypoints
from fixtures.cameras import scene
from fixtures.people import walker

OPTIONS = {**scene.NEAR, "fix_sides": False}
WRIST = walker.SKELETON.index("left_wrist")
FRAMES = slice(20, 24)


def signs(change=lambda views: None, n_cameras=4):
    """Return the signs of a person of constant limbs, after a change of what cameras saw."""
    cameras = scene.ring(n_cameras)
    record = walker.points(n_frames=50)
    xyz = walker.body(50)
    xyz[..., 0] = xyz[:, :1, 0]  # nothing swings: limbs keep their lengths
    views = walker.views(replace(record, xyz=xyz[None]), cameras)
    change(views)
    clocks = [Clock()] * n_cameras
    points = fusion.triangulate_take(cameras, views, walker.SKELETON, ["p1"], **OPTIONS)
    xy, score = error_signs.keypoints_used(views, clocks, points, walker.SKELETON)
    return error_signs.of_points(cameras, points, xy, score, walker.SKELETON)


def moved(views, which, px):
    for at in which:
        views[at].xy[:, FRAMES, WRIST] += px


def test_every_sign_is_finite_and_of_every_joint():
    found = signs()
    assert list(found) == error_signs.NAMES
    assert all(sign.shape == (1, 50, walker.N_JOINTS) for sign in found.values())
    assert all(np.isfinite(sign).all() for sign in found.values())


def test_a_view_that_shows_another_place_is_rejected_and_says_so():
    plain, found = signs(), signs(lambda views: moved(views, [0], 60.0))
    for name, least in (("rejected", 0.5), ("rejected_mean", 0.45)):
        rise = found[name] - plain[name]
        assert rise[0, FRAMES, WRIST].min() > least
        assert np.abs(np.delete(rise[0], WRIST, axis=1)).max() < 1e-6
    assert found["rejected_mean"][0, 26, WRIST] > 0 == found["rejected"][0, 26, WRIST]


def test_a_view_within_the_limit_shows_in_residuals_and_without_it():
    plain, found = signs(), signs(lambda views: moved(views, [0], 5.0))
    for name in ("residual", "left_out"):
        rise = (found[name] - plain[name])[0]
        assert rise[FRAMES, WRIST].min() > 0.1
        assert np.abs(np.delete(rise, np.arange(50)[FRAMES], axis=0)).max() < 0.01


def test_points_and_frames_in_batches_have_the_signs_of_all_at_once(monkeypatch):
    whole = signs(lambda views: moved(views, [0], 5.0))
    monkeypatch.setattr(triangulation, "BATCH", 7)
    monkeypatch.setattr(keypoints, "BLOCK", 8)
    parts = signs(lambda views: moved(views, [0], 5.0))
    for name, sign in whole.items():
        np.testing.assert_array_equal(parts[name], sign)


def test_a_joint_that_jumps_off_changes_its_limb_and_its_path():
    def jump(views):
        record = walker.points(n_frames=50)
        xyz = walker.body(50)
        xyz[..., 0] = xyz[:, :1, 0]
        xyz[FRAMES, WRIST, 2] += 0.3
        for view, other in zip(
            views, walker.views(replace(record, xyz=xyz[None]), scene.ring(4)), strict=True
        ):
            view.xy[...] = other.xy

    plain, found = signs(), signs(jump)
    for name in ("length", "jump"):
        rise = (found[name] - plain[name])[0]
        assert rise[FRAMES, WRIST].min() > 1.0
        assert np.abs(rise[:15]).max() < 0.05
    elbow = walker.SKELETON.index("left_elbow")
    assert (found["length"] - plain["length"])[0, FRAMES, elbow].min() > 0.5


def test_jumps_of_a_long_take_need_little_memory():
    """The windows of all joints at once are 31 times as large as the record."""
    record = walker.points(n_frames=3000)
    tracemalloc.start()
    found = error_signs._jumps(record)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 5 * record.xyz.nbytes
    windows = record.xyz[0, 1000 - 15 : 1000 + 16, WRIST]
    away = np.linalg.norm(record.xyz[0, 1000, WRIST] - np.median(windows, axis=0))
    assert found[0, 1000, WRIST] == pytest.approx(away, abs=1e-12)


def test_low_scores_and_few_views_count():
    def doubtful(views):
        for view in views:
            view.score[:, FRAMES, WRIST] = 0.3
        views[0].score[:, FRAMES, WRIST] = views[1].score[:, FRAMES, WRIST] = np.nan
        views[0].xy[:, FRAMES, WRIST] = views[1].xy[:, FRAMES, WRIST] = np.nan

    plain, found = signs(), signs(doubtful)
    assert found["two"][0, FRAMES, WRIST].all() and not plain["two"].any()
    assert found["doubt"][0, 21, WRIST] == pytest.approx(0.7, abs=0.01)
    assert plain["doubt"][0, 21, WRIST] == pytest.approx(0.25, abs=0.01)
    assert (found["left_out"][0, FRAMES, WRIST] == 0).all()  # two views: none can be left out


def test_joints_of_both_sides_in_one_place_are_a_sign():
    def close(views):
        for view in views:
            view.xy[:, FRAMES, WRIST] = view.xy[:, FRAMES, walker.SKELETON.index("right_wrist")]

    found = signs(close)["sides"]
    assert found[0, FRAMES, WRIST].min() > 0.9 > 0.2 > found[0, 0, WRIST]
    assert (found[..., walker.SKELETON.index("nose")] == 0).all()  # it has no other side


def test_a_trunk_before_a_joint_hides_it():
    cameras, record = scene.ring(2), walker.points(n_frames=6, n_cameras=2)
    xyz = np.full((1, 6, walker.N_JOINTS, 3), np.nan)
    centre = -cameras[0].cam_from_world[:, :3].T @ cameras[0].cam_from_world[:, 3]
    toward = np.array([*centre[:2], 0.0]) / np.linalg.norm(centre[:2])
    for part, height in (("shoulder", 1.5), ("hip", 0.9)):
        for side in ("left", "right"):
            xyz[:, :, walker.SKELETON.index(f"{side}_{part}")] = [0, 0, height]
    xyz[:, :, WRIST] = -0.5 * toward + [0, 0, 1.1]
    xyz[:, :, walker.SKELETON.index("right_wrist")] = 0.5 * toward + [0, 0, 1.1]
    seen = np.zeros_like(record.accepted)
    seen[..., 0] = True  # the other camera sees them from the other side
    points = replace(record, xyz=xyz, accepted=seen)
    clear = error_signs._clear_views(cameras, points)
    before, behind = clear[0, 0, walker.SKELETON.index("right_wrist")], clear[0, 0, WRIST]
    assert before > behind + 0.5
