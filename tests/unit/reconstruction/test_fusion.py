"""From keypoints of several clocks to skeletons: exact scenes, reasons, and real footage."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.calibration.bundle import conversion
from courtside.calibration.records import covariance as camera_covariance
from courtside.reconstruction import fusion, resampling
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import missing_reason, skeleton
from fixtures.cameras import scene
from fixtures.people import keypoints_made, walker

SKELETON = skeleton.read(Path(__file__).parents[3] / "config" / "skeletons" / "cpm14.yaml")
OPTIONS = {
    "min_score": 0.3,
    "min_views": 2,
    "max_error_px": 15,
    "fade_px": 20,
    "fix_sides": True,
    **scene.SHARES,
}


def body(time_s):
    """Return (T, 14, 3): joints on a line that sways, metres."""
    at = np.arange(14)
    sway = 0.2 * np.sin(2 * np.pi * time_s)[:, None]
    return np.stack(
        [sway + 0 * at, 0.05 * at * np.cos(0 * sway) + 0 * sway, 0.1 * at + 0 * sway], axis=-1
    )


def view(camera, time_s, own_time_s=None):
    xyz = body(time_s)
    xy = scene.opencv_projection(camera, xyz.reshape(-1, 3)).reshape(1, len(time_s), 14, 2)
    own = time_s if own_time_s is None else own_time_s
    return keypoints_made.view(camera, SKELETON.joints, own, xy)


def test_cameras_of_other_rates_meet_on_common_times():
    cameras = scene.ring(3)
    times = [np.arange(120) / 60, np.arange(100) / 50, np.arange(60) / 30 + 0.004]
    views = [view(c, t) for c, t in zip(cameras, times, strict=True)]
    points = fusion.triangulate_take(cameras, views, SKELETON, ["p1"], **OPTIONS)
    assert points.rate_hz == pytest.approx(60)
    seen = np.isfinite(points.xyz[0, :, 0, 0])
    assert seen.mean() > 0.95
    np.testing.assert_allclose(points.xyz[0, seen], body(points.time_s[seen]), atol=2e-3)


def test_equal_clocks_pass_through_unchanged():
    cameras = scene.ring(2)
    time_s = np.arange(30) / 60
    views = [view(camera, time_s) for camera in cameras]
    common_s = resampling.common_times(views, [Clock(), Clock()])
    xy, _ = resampling.resample(views[0], common_s, Clock())
    np.testing.assert_array_equal(xy, views[0].xy)


def test_clocks_of_their_own_are_brought_together():
    cameras = scene.ring(3)
    clocks = [Clock(), Clock(0.7, 150.0), Clock(-0.3, -90.0)]
    own = np.arange(300) / 60
    views = [
        view(c, clock.to_reference(own), own) for c, clock in zip(cameras, clocks, strict=True)
    ]
    points = fusion.triangulate_take(cameras, views, SKELETON, ["p1"], **OPTIONS, clocks=clocks)
    seen = np.isfinite(points.xyz[0, :, 0, 0])
    assert seen.mean() > 0.95
    np.testing.assert_allclose(points.xyz[0, seen], body(points.time_s[seen]), atol=2e-3)


def test_sides_swapped_in_one_camera_are_recorded_there_and_nowhere_else():
    cameras, made = scene.ring(4), walker.points(n_frames=40)
    views, n_persons = walker.views(replace(made, xyz=walker.body(40)[None]), cameras), 1
    legs = [walker.SKELETON.index(joint) for joint in walker.SKELETON.side_groups()[1]]
    mirror = np.array(walker.SKELETON.mirror())
    planted = np.zeros((n_persons, 40, walker.N_JOINTS, 4), bool)
    planted[:, 12:25, legs, 2] = True
    views[2].xy[:, 12:25] = np.where(
        planted[:, 12:25, :, 2, None], views[2].xy[:, 12:25][:, :, mirror], views[2].xy[:, 12:25]
    )
    found = fusion.triangulate_take(cameras, views, walker.SKELETON, ["p1"], **OPTIONS)
    np.testing.assert_array_equal(found.swapped, planted)
    assert np.nanmax(found.reproj_error_px) < 0.1  # the fusion took each joint's own keypoint
    for change in ({"fix_sides": False}, {"rule": "dlt"}):
        left = fusion.triangulate_take(
            cameras, views, walker.SKELETON, ["p1"], **(OPTIONS | change)
        )
        assert not left.swapped.any()


@pytest.mark.parametrize("rule", ["robust", "dlt"])
def test_all_of_fewer_cameras_than_views_asked_for_are_enough(rule):
    cameras, time_s = scene.ring(3)[:2], np.arange(30) / 60
    views = [view(camera, time_s) for camera in cameras]
    strict = OPTIONS | {"min_views": 3}
    points = fusion.triangulate_take(cameras, views, SKELETON, ["p1"], rule=rule, **strict)
    np.testing.assert_allclose(points.xyz[0], body(points.time_s), atol=1e-3)
    views[1].score[0, 5:20, 0] = np.nan
    points = fusion.triangulate_take(cameras, views, SKELETON, ["p1"], rule=rule, **strict)
    assert points.reason[0, 12, 0] == missing_reason.ONE_VIEW


def test_every_missing_point_says_why():
    nan = np.nan
    score = np.array([[nan, 0.1, 0.9, 0.9, 0.9], [nan, 0.9, nan, 0.9, 0.9]])
    xyz = np.full((5, 3), nan)
    xyz[4] = 1.0
    codes = fusion.why_missing(score, xyz, 0.3, 2).tolist()
    assert codes == [
        missing_reason.UNSEEN,
        missing_reason.LOW_SCORE,
        missing_reason.ONE_VIEW,
        missing_reason.REJECTED,
        missing_reason.OK,
    ]


def test_a_joint_of_nearly_parallel_rays_is_nowhere():
    time_s = np.arange(90) / 30
    places = [(0.0, -6.0, 1.0), (0.4, -6.0, 1.0)]
    cameras = [
        replace(one, cam_from_world=scene.look_at(place, (place[0], 0.0, 1.0)))
        for one, place in zip(scene.ring(2), places, strict=True)
    ]
    views = [view(camera, time_s) for camera in cameras]
    rng = np.random.default_rng(0)
    for seen in views:
        seen.xy[...] += rng.normal(0, 1, seen.xy.shape)
    for camera, seen in zip(cameras, views, strict=True):
        seen.xy[0, 40, 3] = scene.opencv_projection(camera, np.array([[1.0, 300.0, 2.0]]))[0]
    points = fusion.triangulate_take(cameras, views, SKELETON, ["p1"], **OPTIONS)
    assert np.isnan(points.xyz[0, 40, 3]).all()
    assert points.reason[0, 40, 3] == missing_reason.UNCERTAIN
    assert points.n_views[0, 40, 3] == 0 and not points.accepted[0, 40, 3].any()
    assert np.isfinite(points.xyz[0, :, 2]).all() and np.isfinite(points.xyz[0, 39, 3]).all()


def test_the_measured_noise_gives_honest_ellipsoids():
    cameras = scene.ring(4)
    time_s = np.arange(600) / 60
    views = [view(c, time_s) for c in cameras]
    rng = np.random.default_rng(0)
    sigma_px = np.linspace(1, 4, 14)  # each joint has its own noise, unknown to the method
    for keypoints in views:
        keypoints.xy[...] += rng.normal(0, 1, keypoints.xy.shape) * sigma_px[:, None]
    points = fusion.triangulate_take(
        cameras, views, SKELETON, ["p1"], **{**OPTIONS, "max_error_px": 30, "fade_px": 40}
    )
    error = points.xyz[0] - body(points.time_s)
    squared = np.einsum("tji,tjik,tjk->tj", error, np.linalg.inv(points.covariance_2d[0]), error)
    # 90 % of a chi-squared variable with 3 degrees of freedom lie below 6.251.
    inside = np.mean(squared < 6.251, axis=0)
    assert (inside > 0.85).all()
    assert (inside < 0.95).all()


def test_noise_that_grows_with_the_person_in_the_picture_gives_honest_ellipsoids():
    time_s = np.arange(900) / 60
    made = np.stack([walker.body(900) * [0, 1, 1] + [x, 0, 0] for x in (-2.0, 0.5, 3.0)])
    near, *far = scene.ring(4, radius_m=12)
    cameras = [replace(near, cam_from_world=scene.look_at((-6, 0.5, 2), (0, 0, 1))), *far]
    rng, views = np.random.default_rng(1), []
    for camera in cameras:
        xy = scene.opencv_projection(camera, made.reshape(-1, 3)).reshape(3, 900, -1, 2)
        trunk = made.mean(axis=2) @ camera.cam_from_world[2, :3] + camera.cam_from_world[2, 3]
        sigma_px = 0.012 * 1.7 * scene.FOCAL_PX / trunk  # 12 per mille of a height
        xy += rng.normal(0, 1, xy.shape) * sigma_px[..., None, None]
        views.append(keypoints_made.view(camera, walker.SKELETON.joints, time_s, xy))
    options = OPTIONS | {"max_error_px": None, "fade_px": None, "fix_sides": False}
    points = fusion.triangulate_take(cameras, views, walker.SKELETON, ["a", "b", "c"], **options)
    error = points.xyz - made
    squared = np.einsum("ptji,ptjik,ptjk->ptj", error, np.linalg.inv(points.covariance_2d), error)
    inside = np.mean(squared < 6.251, axis=(1, 2))  # of each person, near the first camera or far
    assert (inside > 0.88).all() and (inside < 0.95).all()


CAMERAS = scene.ring(2, radius_m=8)
N = len(camera_covariance.PARAMETERS)
SIGMA = np.array([1e-3, 2e-3, 1e-3, 0.01, 0.02, 0.01, 4, 1e-4, 2, 2, 1e-4, 1e-4, 1e-5, 1e-5])


def covariance():
    return camera_covariance.CameraCovariance(["c0", "c1"], np.diag(np.tile(SIGMA, 2) ** 2))


def triangulated(poses, xy):
    matrices = [camera.K @ pose for camera, pose in zip(CAMERAS, poses, strict=True)]
    found = cv2.triangulatePoints(*matrices, xy[0].T.copy(), xy[1].T.copy())
    return (found[:3] / found[3]).T


def test_spread_is_that_of_points_triangulated_with_cameras_moved_at_random():
    points = walker.points(6, n_cameras=2)
    places = np.array([[[0.5, 0.2, 1.0]] * walker.N_JOINTS] * 6)[None]
    points = walker_at(points, places)
    pose_only = covariance()
    keep = np.tile(np.arange(N) < 6, 2)
    pose_only.covariance[~np.ix_(keep, keep)[0][:, 0]] = 0
    found = fusion.with_cameras(points, CAMERAS, pose_only.of_columns())
    rng = np.random.default_rng(0)
    xy = scene.views(CAMERAS, places[0, 0, :1])
    moved = []
    for _ in range(4000):
        poses = []
        for camera in CAMERAS:
            turn = Rotation.from_rotvec(rng.normal(0, SIGMA[:3])).as_matrix()
            pose = turn @ camera.cam_from_world
            pose[:, 3] += rng.normal(0, SIGMA[3:6])
            poses.append(pose)
        moved.append(triangulated(poses, xy)[0])
    expected = np.cov(np.array(moved).T)
    np.testing.assert_allclose(
        found.covariance_camera[0, 0, 5], expected, atol=0.08 * np.trace(expected)
    )


def test_a_camera_that_does_not_see_the_person_does_not_make_the_spread_smaller():
    """A third camera nearby, turned away, counts for nothing."""
    points, names = walker.points(6, n_cameras=2), ["c0", "c1", "c2"]
    wide = scene.ring(3, radius_m=8)[2]
    spread = camera_covariance.CameraCovariance(names, np.diag(np.tile(SIGMA, 3) ** 2))
    nobody = np.zeros((*points.accepted.shape[:-1], 1), dtype=bool)
    three = replace(
        points,
        cameras=np.array(names),
        accepted=np.concatenate([points.accepted, nobody], axis=-1),
        swapped=np.concatenate([points.swapped, nobody], axis=-1),
        reproj_error_px=np.concatenate([points.reproj_error_px, np.full(nobody.shape, np.nan)], -1),
    )
    found = fusion.with_cameras(three, [*CAMERAS, wide], spread.of_columns())
    expected = fusion.with_cameras(points, CAMERAS, covariance().of_columns())
    np.testing.assert_allclose(found.covariance_camera, expected.covariance_camera, rtol=1e-9)


def walker_at(points, xyz):
    return type(points)(**{**vars(points), "xyz": xyz})


def test_a_person_who_is_missing_has_none_and_joints_share_the_persons():
    points = walker.points(6, n_cameras=2)
    points.xyz[0, 2] = np.nan
    found = fusion.with_cameras(points, CAMERAS, covariance().of_columns())
    assert np.isnan(found.covariance_camera[0, 2]).all()
    assert np.isnan(found.covariance_camera[0, 3, 4]).all()
    np.testing.assert_array_equal(
        found.covariance_camera[0, 4, 0], found.covariance_camera[0, 4, 20]
    )
    np.testing.assert_array_equal(found.covariance_2d, points.covariance_2d)


def test_some_of_the_cameras_have_their_own_part():
    three = camera_covariance.CameraCovariance(
        ["a", "b", "c"], np.diag(np.arange(3 * N, dtype=float))
    )
    part = three.of(["c", "a"])
    assert part.cameras == ["c", "a"]
    assert np.diag(part.covariance).tolist() == [*range(2 * N, 3 * N), *range(N)]
    with pytest.raises(ValueError, match="expected a camera of"):
        three.of(["d"])
    assert conversion.network_of(CAMERAS).n_columns == len(part.of_columns())


CAMERAS_HALFBODY = ["centre", "left", "right"]
UP = np.array([0, 0, 1.0])


def halves():
    points = walker.points(20, n_cameras=2)
    left = replace(points, cameras=np.array(["centre", "left"]))
    right = replace(
        points,
        cameras=np.array(["centre", "right"]),
        xyz=points.xyz + UP,
        reason=points.reason.copy(),
    )
    return left, right


def test_each_side_is_that_of_its_record_and_the_middle_the_mean():
    left, right = halves()
    merged = fusion.merge(left, right, CAMERAS_HALFBODY)
    at = {name: list(merged.joints).index(name) for name in ("left_hip", "right_hip", "nose")}
    assert merged.cameras.tolist() == CAMERAS_HALFBODY
    np.testing.assert_array_equal(merged.xyz[:, :, at["left_hip"]], left.xyz[:, :, at["left_hip"]])
    np.testing.assert_array_equal(
        merged.xyz[:, :, at["right_hip"]], right.xyz[:, :, at["right_hip"]]
    )
    lifted = merged.xyz[:, :, at["nose"]] - left.xyz[:, :, at["nose"]]
    np.testing.assert_allclose(lifted, np.broadcast_to([0, 0, 0.5], lifted.shape), atol=1e-12)


def test_views_are_those_of_the_half():
    left, right = halves()
    merged = fusion.merge(left, right, CAMERAS_HALFBODY)
    at = {name: list(merged.joints).index(name) for name in ("left_knee", "right_knee", "nose")}
    assert merged.accepted[0, 0, at["left_knee"]].tolist() == [True, True, False]
    assert merged.accepted[0, 0, at["right_knee"]].tolist() == [True, False, True]
    assert merged.accepted[0, 0, at["nose"]].tolist() == [True, True, True]
    assert merged.n_views[0, 0, [at["left_knee"], at["nose"]]].tolist() == [2, 3]
    error = merged.reproj_error_px[0, 0, at["left_knee"]]
    np.testing.assert_array_equal(error[:2], left.reproj_error_px[0, 0, at["left_knee"]])
    assert np.isnan(error[2]) and np.isfinite(merged.reproj_error_px[0, 0, at["nose"]]).all()


def test_swaps_are_those_of_the_half():
    left, right = halves()
    knees = [list(left.joints).index(name) for name in ("left_knee", "right_knee")]
    swapped = left.swapped.copy()
    swapped[0, 2, knees] = [False, True]  # in the half's second camera
    left, right = (replace(half, swapped=swapped) for half in (left, right))
    merged = fusion.merge(left, right, CAMERAS_HALFBODY)
    assert np.argwhere(merged.swapped).tolist() == [[0, 2, knees[0], 1], [0, 2, knees[1], 2]]


def test_a_joint_of_the_middle_that_one_half_lacks_is_that_of_the_other():
    left, right = halves()
    nose = list(left.joints).index("nose")
    left.xyz[0, 2, nose], left.reason[0, 2, nose] = np.nan, missing_reason.REJECTED
    left.accepted[0, 2, nose] = False
    merged = fusion.merge(left, right, CAMERAS_HALFBODY)
    np.testing.assert_array_equal(merged.xyz[0, 2, nose], right.xyz[0, 2, nose])
    assert merged.reason[0, 2, nose] == missing_reason.OK
    assert (merged.reason[:, 3, 4], merged.n_views[0, 3, 4]) == (missing_reason.REJECTED, 0)
    assert np.isnan(merged.xyz[0, 3, 4]).all()


def test_halves_of_different_takes_are_a_fault():
    left, right = halves()
    with pytest.raises(ValueError, match="expected halves of the same time_s"):
        fusion.merge(left, replace(right, time_s=right.time_s + 1), CAMERAS_HALFBODY)


@pytest.mark.parametrize("scale", [0.4, 3.0])
def test_limits_in_shares_need_no_scaling(scale):
    """The same scene in pictures of another size accepts the same views of the same points."""
    record, rng = walker.points(n_frames=20), np.random.default_rng(2)
    shares = {"min_score": 0.3, "min_views": 2, "fix_sides": True, **scene.SHARES}
    noise = rng.normal(0, 5, (4, 1, 20, walker.N_JOINTS, 2))
    noise[2, :, 5:9] += 60
    found = []
    for times in (1.0, scale):
        cameras = [
            replace(c, K=np.diag([times, times, 1]) @ c.K, size=(9999, 9999)) for c in scene.ring(4)
        ]
        views = walker.views(record, cameras)
        for view_of, of_camera in zip(views, noise, strict=True):
            view_of.xy[...] += times * of_camera
        found.append(fusion.triangulate_take(cameras, views, walker.SKELETON, ["p1"], **shares))
    np.testing.assert_array_equal(found[0].accepted, found[1].accepted)
    assert found[0].accepted[0, 6, :, 2].mean() < 0.2 < 0.95 < found[0].accepted[..., 0].mean()
    np.testing.assert_allclose(found[0].xyz, found[1].xyz, atol=1e-4)


def test_pixels_replace_shares():
    cameras, views = scene.ring(4), walker.views(walker.points(20), scene.ring(4))
    views[2].xy[...] += 12
    common = {"min_score": 0.3, "min_views": 2, "fix_sides": False, **scene.SHARES}

    def accepted(**limits):
        found = fusion.triangulate_take(cameras, views, walker.SKELETON, ["p1"], **common, **limits)
        return found.accepted[..., 2].mean()

    assert accepted() > 0.99 > 0.01 > accepted(max_error_px=5)
    assert accepted(max_error_px=5, fade_px=7) < 0.01
