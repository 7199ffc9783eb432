"""Triangulation against exact truth, OpenCV, NumPy, statistics, and a board of known size."""

import tracemalloc
from dataclasses import replace

import cv2
import numpy as np
import pandas as pd
import pytest
from scipy.optimize import least_squares

from courtside.calibration import file_formats
from courtside.geometry import camera, triangulation
from fixtures.cameras import scene
from fixtures.recordings.real_data import REAL, needs_real

LENS = (-0.25, 0.08, 1e-3, -5e-4, -0.01)
LIMITS = {"max_error_px": 15, "min_views": 2}


@pytest.mark.parametrize("n_cameras", [2, 3, 4, 12])
@pytest.mark.parametrize("dist", [(0, 0, 0, 0, 0), LENS])
def test_exact_keypoints_give_exact_points(n_cameras, dist):
    views = scene.ring(n_cameras, dist=dist)
    xyz = scene.points(200)
    xy = scene.views(views, xyz)
    found = triangulation.triangulate_robust(views, xy, np.ones(xy.shape[:2]), **LIMITS)
    np.testing.assert_allclose(found.xyz, xyz, atol=1e-8)
    assert found.accepted.all()
    assert found.error_px.max() < 1e-5


def test_all_views_give_the_least_squares_of_their_pixels():
    views, xyz = scene.ring(3, dist=LENS), scene.points(8)
    xy = scene.views(views, xyz) + np.random.default_rng(4).normal(0, 3, (3, 8, 2))
    found = triangulation.triangulate_all(views, xy)
    for point, seen in zip(found, xy.swapaxes(0, 1), strict=True):

        def off(x, seen=seen):
            placed = [camera.project(view, x) for view in views]
            return (np.array(placed) - seen).ravel()

        best = least_squares(off, point + 0.1, xtol=1e-12, ftol=1e-12)
        np.testing.assert_allclose(point, best.x, atol=1e-4)  # the lens bends little in 3 px


def test_a_point_needs_two_views_and_to_be_before_those_that_show_it():
    views, xyz = scene.ring(3), scene.points(4)
    xy = scene.views(views, xyz)
    xy[1:, 0] = np.nan
    behind = views[0].centre_in_world * 1.5 - 0.5 * xyz[1]  # behind the first camera only
    others = scene.views(views[1:], behind[None])[:, 0]
    xy[:, 1], xy[1:, 2] = [[np.nan, np.nan], *others], others
    xy[0, 2] = scene.opencv_projection(views[0], behind[None])[0]
    found = triangulation.triangulate_all(views, xy)
    assert np.isnan(found).any(axis=1).tolist() == [True, False, True, False]
    np.testing.assert_allclose(found[[1, 3]], [behind, xyz[3]], atol=1e-8)


def test_points_stand_as_their_views_do():
    """Two rows of four points: each is where it was put."""
    views, xyz = scene.ring(3), scene.points(8)
    xy = scene.views(views, xyz).reshape(3, 2, 4, 2)
    found = triangulation.triangulate_all(views, xy)
    np.testing.assert_allclose(found, xyz.reshape(2, 4, 3), atol=1e-8)


def test_dlt_equals_the_null_vector_of_hartley_and_zisserman():
    views, xyz = scene.ring(4), scene.points(20)
    rng = np.random.default_rng(1)
    xy = scene.views(views, xyz) + rng.normal(0, 0.01, (4, 20, 2))
    plane = np.stack([camera.undistort(c, p) for c, p in zip(views, xy, strict=True)])
    matrices = np.stack([c.cam_from_world for c in views])
    found = triangulation.triangulate(plane, np.ones((4, 20)), matrices)
    for at in range(20):
        rows = [plane[c, at, k] * matrices[c, 2] - matrices[c, k] for c in range(4) for k in (0, 1)]
        null = np.linalg.svd(np.array(rows))[2][-1]
        np.testing.assert_allclose(found[at], null[:3] / null[3], atol=2e-5)


@pytest.mark.parametrize("n_cameras", [3, 4, 6, 12])
def test_one_wrong_view_is_left_out(n_cameras):
    views, xyz = scene.ring(n_cameras), scene.points(500)
    rng = np.random.default_rng(2)
    xy = scene.views(views, xyz) + rng.normal(0, 1, (n_cameras, 500, 2))
    wrong = rng.integers(0, n_cameras, 500)
    xy[wrong, np.arange(500)] += rng.uniform(80, 400, (500, 1)) * rng.choice([-1, 1], (500, 2))
    found = triangulation.triangulate_robust(views, xy, np.ones(xy.shape[:2]), **LIMITS)
    error_m = np.linalg.norm(found.xyz - xyz, axis=1)
    kept = found.accepted[wrong, np.arange(500)]
    limit = 0.2 if n_cameras == 3 else 0.02  # two views cannot always tell which of three is wrong
    assert kept.mean() <= limit
    assert np.nanmedian(error_m) < 0.01
    assert np.mean(error_m > 0.05) <= limit


def test_covariance_holds_the_errors_it_promises():
    views, xyz = scene.ring(4, dist=LENS), scene.points(4000)
    xy = scene.views(views, xyz) + np.random.default_rng(3).normal(0, 2, (4, 4000, 2))
    found = triangulation.triangulate_robust(views, xy, np.ones((4, 4000)), **LIMITS)
    error = found.xyz - xyz
    covariance = (2 / LIMITS["max_error_px"]) ** 2 * found.covariance
    squared = np.einsum("ni,nij,nj->n", error, np.linalg.inv(covariance), error)
    # 90 % of a chi-squared variable with 3 degrees of freedom lie below 6.251.
    assert 0.87 <= np.mean(squared < 6.251) <= 0.92


def test_covariance_and_limit_are_of_the_picture_whatever_the_lens():
    """An action camera shows what is far from the centre at 0.6 of the size."""
    wide = np.array([[960.0, 0, 959.5], [0, 960, 539.5], [0, 0, 1]])
    views = [replace(v, K=wide) for v in scene.ring(3, dist=(-0.25, 0.07, 0, 0, -0.007))]
    xyz = scene.points(4000) + np.array([3.0, 0.0, 0.0])
    exact = scene.views(views, xyz)
    xy = exact + np.random.default_rng(3).normal(0, 2, exact.shape)
    found = triangulation.triangulate_robust(views, xy, np.ones((3, 4000)), **LIMITS)
    error = found.xyz - xyz
    ok = np.isfinite(error).all(axis=1)
    covariance = (2 / LIMITS["max_error_px"]) ** 2 * found.covariance[ok]
    squared = np.einsum("ni,nij,nj->n", error[ok], np.linalg.inv(covariance), error[ok])
    assert ok.mean() > 0.99
    assert 0.87 <= np.mean(squared < 6.251) <= 0.92
    inside = found.error_px[:, ok] <= 0.95 * LIMITS["max_error_px"]
    assert found.accepted[:, ok][inside].all()


def test_covariance_holds_larger_errors_of_near_views():
    views, xyz = scene.ring(4), scene.points(4000)
    limit_px = np.broadcast_to(np.array([[120.0], [30], [30], [60]]), (4, 4000))
    noise_px = np.random.default_rng(5).normal(0, 0.1, (4, 4000, 2)) * limit_px[..., None]
    xy, limits = scene.views(views, xyz) + noise_px, {"max_error_px": limit_px, "fade_px": 1e4}
    found = triangulation.triangulate_robust(views, xy, np.ones((4, 4000)), **limits)
    error = found.xyz - xyz
    squared = np.einsum("ni,nij,nj->n", error, np.linalg.inv(0.1**2 * found.covariance), error)
    assert 0.88 <= np.mean(squared < 6.251) <= 0.92


def test_a_camera_that_never_sees_a_person_takes_no_part_in_the_covariance():
    """The limit in such a camera is unknown where it is a share of the person's height."""
    views, xyz = scene.ring(3), scene.points(5)
    xy, limit_px = scene.views(views, xyz), np.full((3, 5), 20.0)
    two = triangulation.triangulate_robust(views[:2], xy[:2], np.ones((2, 5)), max_error_px=20.0)
    xy[2], limit_px[2] = np.nan, np.nan
    found = triangulation.triangulate_robust(views, xy, np.ones((3, 5)), max_error_px=limit_px)
    np.testing.assert_allclose(found.covariance, two.covariance, rtol=1e-9)
    assert np.isfinite(found.covariance).all()


def test_missing_and_low_scores_are_not_used():
    views, xyz = scene.ring(3), scene.points(3)
    xy = scene.views(views, xyz)
    score = np.ones((3, 3))
    xy[1:, 0] = np.nan
    score[0, 1], xy[0, 1] = 0.1, xy[0, 1] + 300
    found = triangulation.triangulate_robust(views, xy, score, min_score=0.3, **LIMITS)
    assert np.isnan(found.xyz[0]).all()
    np.testing.assert_allclose(found.xyz[1:], xyz[1:], atol=1e-8)
    assert not found.accepted[0, 1]
    assert found.error_px[0, 1] == pytest.approx(300 * np.sqrt(2))


def weak_views(n=200, low=0.02, seed=5):
    """Return cameras, points, keypoints and scores: two cameras face each other, two see little.

    The points are near the line between the first and the third camera. All keypoints have noise,
    those of the second and fourth camera 2.5 times as much, and scores `low`.
    """
    views, rng = scene.ring(4, radius_m=10.0, height_m=1.0), np.random.default_rng(seed)
    along = views[2].centre_in_world - views[0].centre_in_world
    xyz = [0, 0, 1.0] + rng.uniform(-0.1, 0.1, (n, 1)) * along + rng.normal(0, 0.1, (n, 3))
    score = np.tile([[1.0], [low], [1.0], [low]], n)
    noise_px = np.where(score < 1, 5.0, 2.0)[..., None] * rng.normal(size=(4, n, 2))
    return views, xyz, scene.views(views, xyz) + noise_px, score


WEAK = {"max_error_px": 7.0, "min_score": 0.05}


def test_low_scores_are_used_where_the_other_views_leave_a_direction_open():
    views, xyz, xy, score = weak_views()
    alone = triangulation.triangulate_robust(views, xy, score, **WEAK)
    found = triangulation.triangulate_robust(views, xy, score, **WEAK, weak_m=0.12)
    before, after = (np.linalg.norm(each.xyz - xyz, axis=1) for each in (alone, found))
    assert np.nanmedian(before) > 0.2
    assert np.nanmedian(after) < 0.06 and np.nanquantile(after, 0.95) < 0.12
    assert found.accepted[[1, 3]].any(axis=0)[np.isfinite(after)].mean() > 0.95
    np.testing.assert_allclose(found.weight[1, found.accepted[1]], np.sqrt(0.02))
    assert not alone.accepted[[1, 3]].any()


def test_low_scores_change_nothing_where_the_other_views_determine_the_point():
    views, _xyz, xy, score = weak_views()
    score[1] = 0.5  # three views
    alone = triangulation.triangulate_robust(views, xy, score, **WEAK)
    found = triangulation.triangulate_robust(views, xy, score, **WEAK, weak_m=0.12)
    seen = alone.accepted[1]
    assert seen.sum() > 50
    np.testing.assert_array_equal(found.xyz[seen], alone.xyz[seen])
    assert not found.accepted[3, seen].any()


def test_two_views_alone_are_not_weighted_anew():
    views, _, xy, score = weak_views(low=0.1)
    xy[1:3] = np.nan  # a right angle, but one view of a low score
    alone = triangulation.triangulate_robust(views, xy, score, **WEAK)
    found = triangulation.triangulate_robust(views, xy, score, **WEAK, weak_m=0.01)
    assert np.isfinite(alone.xyz).all(axis=1).mean() > 0.9
    np.testing.assert_array_equal(found.xyz, alone.xyz)
    np.testing.assert_array_equal(found.weight, alone.weight)


def test_wrong_keypoints_of_low_scores_are_left_out():
    views, _xyz, xy, score = weak_views()
    xy[[1, 3]] += [0.0, 150.0]
    alone = triangulation.triangulate_robust(views, xy, score, **WEAK)
    found = triangulation.triangulate_robust(views, xy, score, **WEAK, weak_m=0.12)
    assert not found.accepted[[1, 3]].any()
    np.testing.assert_array_equal(found.xyz, alone.xyz)


def test_views_that_contradict_give_nothing():
    views, xyz = scene.ring(2), scene.points(1)
    xy = scene.views(views, xyz)
    xy[0] += [0, 400]
    found = triangulation.triangulate_robust(views, xy, np.ones((2, 1)), **LIMITS)
    assert np.isnan(found.xyz).all()
    assert not found.accepted.any()


def test_points_behind_the_cameras_are_refused():
    matrix = scene.ring(1)[0].K
    poses = [scene.look_at((0, -6, 2), (0, 0, 1.9)), scene.look_at((0.5, -6, 2), (0.5, 0, 1.9))]
    pair = [
        camera.Camera(n, scene.SIZE, matrix, np.zeros(5), p)
        for n, p in zip("ab", poses, strict=True)
    ]
    # The rays cross behind the cameras: the left camera sees the point further left than the right
    # one.
    xy = np.array([[[900.0, 500.0]], [[1300.0, 500.0]]])
    found = triangulation.triangulate_robust(pair, xy, np.ones((2, 1)), **LIMITS)
    assert np.isnan(found.xyz).all()


@pytest.mark.parametrize("batch", [1, 7, 1000])
@pytest.mark.parametrize(
    ("solve", "options"),
    [(triangulation.triangulate_robust, LIMITS), (triangulation.triangulate_plain, {})],
)
def test_batches_do_not_change_the_result(batch, solve, options, monkeypatch):
    views, xyz = scene.ring(4), scene.points(50)
    xy = scene.views(views, xyz) + np.random.default_rng(4).normal(0, 8, (4, 50, 2))
    whole = solve(views, xy, np.ones((4, 50)), **options)
    monkeypatch.setattr(triangulation, "BATCH", batch)
    parts = solve(views, xy, np.ones((4, 50)), **options)
    np.testing.assert_allclose(parts.xyz, whole.xyz, atol=1e-9)


def test_views_without_weights_need_little_memory(monkeypatch):
    """The equations of all points at once are ten times as large as their keypoints."""
    monkeypatch.setattr(triangulation, "BATCH", 2000)
    views, xyz = scene.ring(4), scene.points(50_000)
    xy, score = scene.views(views, xyz), np.ones((4, 50_000))
    tracemalloc.start()
    found = triangulation.triangulate_plain(views, xy, score)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    results = sum(values.nbytes for values in vars(found).values())
    assert peak < results + 5 * xy.nbytes


@pytest.mark.parametrize("batch", [7, 1000])
def test_limits_broadcast_over_joints_are_those_of_each_joint(batch, monkeypatch):
    monkeypatch.setattr(triangulation, "BATCH", batch)
    views, xyz, rng = scene.ring(4), scene.points(60), np.random.default_rng(4)
    xy = scene.views(views, xyz) + rng.normal(0, 8, (4, 60, 2))
    limit_px = rng.uniform(5, 30, (4, 15))  # of each frame; 4 joints
    for_joints = np.broadcast_to(limit_px[..., None], (4, 15, 4))
    repeated = np.repeat(limit_px, 4, axis=1)
    found, expected = (
        triangulation.triangulate_robust(
            views, xy, np.ones((4, 60)), max_error_px=limit, fade_px=1.2 * limit
        )
        for limit in (for_joints, repeated)
    )
    for name, values in vars(expected).items():
        np.testing.assert_array_equal(getattr(found, name), values)
    assert not expected.accepted.all() and expected.accepted.any()


def test_contradicting_shapes_and_too_few_views_are_refused():
    for n_views, n_scores in ((3, 3), (2, 1)):
        xy, score = np.zeros((n_views, 1, 2)), np.ones((n_scores, 1))
        with pytest.raises(ValueError, match="C = 2 cameras"):
            triangulation.triangulate_robust(scene.ring(2), xy, score, **LIMITS)
    with pytest.raises(ValueError, match="min_views"):
        triangulation.triangulate_robust(
            scene.ring(2),
            np.zeros((2, 1, 2)),
            np.ones((2, 1)),
            max_error_px=9,
            min_views=1,
        )


@needs_real
def test_a_board_of_known_size_keeps_its_squares():
    folder = REAL / "charuco-4cams"
    views = file_formats.read(folder / "camera_array.toml")
    seen = pd.read_csv(folder / "calibration" / "extrinsic" / "CHARUCO" / "xy_CHARUCO.csv")
    keys = sorted(set(zip(seen.sync_index, seen.keypoint_id, strict=True)))
    at = {key: n for n, key in enumerate(keys)}
    xy = np.full((4, len(keys), 2), np.nan)
    for row in seen.itertuples():
        xy[row.cam_id, at[row.sync_index, row.keypoint_id]] = row.img_loc_x, row.img_loc_y
    score = np.where(np.isfinite(xy[..., 0]), 1.0, np.nan)
    found = triangulation.triangulate_robust(views, xy, score, **LIMITS)
    places = seen.groupby("keypoint_id")[["obj_loc_x", "obj_loc_y"]].first()
    lengths_mm = []
    for (frame, corner), n in at.items():
        for other, place in places.iterrows():
            step = place - places.loc[corner]
            m = at.get((frame, other))
            if m is not None and (step >= -1e-6).all() and abs(np.hypot(*step) - 0.054) < 1e-6:
                lengths_mm.append(1e3 * np.linalg.norm(found.xyz[n] - found.xyz[m]))
    error_mm = np.array(lengths_mm) - 54.0
    error_mm = error_mm[np.isfinite(error_mm)]
    assert len(error_mm) > 900
    assert abs(error_mm.mean()) <= 0.3
    assert error_mm.std() <= 0.9


# Plain DLT: exact on exact views, equal to OpenCV's, and helpless against a wrong view.
PLAIN_XYZ = scene.points(50)


def test_exact_views_give_the_points_whatever_the_lens():
    cameras = scene.ring(3, dist=(-0.1, 0.02, 1e-3, -1e-3, 0))
    found = triangulation.triangulate_plain(
        cameras, scene.views(cameras, PLAIN_XYZ), np.ones((3, 50))
    )
    np.testing.assert_allclose(found.xyz, PLAIN_XYZ, atol=1e-7)
    assert found.accepted.all() and found.error_px.max() < 1e-5


def test_two_noisy_views_give_nearly_what_opencv_does():
    cameras = scene.ring(5)[:2]
    xy = scene.views(cameras, PLAIN_XYZ) + np.random.default_rng(0).normal(0, 3, (2, 50, 2))
    found = triangulation.triangulate_plain(cameras, xy, np.ones((2, 50)))
    matrices = [camera.K @ camera.cam_from_world for camera in cameras]
    other = cv2.triangulatePoints(*matrices, xy[0].T.copy(), xy[1].T.copy())
    apart = np.linalg.norm(found.xyz - (other[:3] / other[3]).T, axis=1)
    error = np.linalg.norm(found.xyz - PLAIN_XYZ, axis=1)
    assert np.median(apart) < 0.1 * np.median(error)
    sigma = 3 * np.sqrt(np.trace(found.covariance, axis1=1, axis2=2))
    assert np.sqrt(np.mean(error**2)) == pytest.approx(np.sqrt(np.mean(sigma**2)), rel=0.25)


def test_a_wrong_view_is_used_and_a_doubtful_one_is_not():
    cameras = scene.ring(4)
    xy, score = scene.views(cameras, PLAIN_XYZ), np.ones((4, 50))
    xy[0] += 200
    found = triangulation.triangulate_plain(cameras, xy, score)
    assert np.linalg.norm(found.xyz - PLAIN_XYZ, axis=1).min() > 0.02
    score[0] = 0.1
    found = triangulation.triangulate_plain(cameras, xy, score, min_score=0.5)
    np.testing.assert_allclose(found.xyz, PLAIN_XYZ, atol=1e-7)
    assert not found.accepted[0].any()


def test_a_view_beyond_the_fold_of_its_lens_is_not_accepted():
    cameras = [replace(one, dist=np.array([-0.3, 0, 0, 0, 0])) for one in scene.ring(3)]
    xy = scene.views(cameras, PLAIN_XYZ)
    xy[0, 3] = [-9000.0, -9000.0]
    found = triangulation.triangulate_plain(cameras, xy, np.ones((3, 50)))
    assert found.accepted[:, 3].tolist() == [False, True, True]
    np.testing.assert_allclose(found.xyz, PLAIN_XYZ, atol=1e-6)


def test_points_of_too_few_views_are_missing():
    cameras = scene.ring(3)
    xy = scene.views(cameras, PLAIN_XYZ)
    xy[:2, 3] = np.nan
    xy[0, 4] = np.nan
    found = triangulation.triangulate_plain(cameras, xy, np.ones((3, 50)), min_views=2)
    assert np.isnan(found.xyz[3]).all() and not found.accepted[:, 3].any()
    assert found.accepted[:, 4].tolist() == [False, True, True]
    with pytest.raises(ValueError, match="min_views"):
        triangulation.triangulate_plain(cameras, xy, np.ones((3, 50)), min_views=1)


def systems(count, seed=0):
    root = np.random.default_rng(seed).normal(size=(count, 3, 3))
    return root @ root.transpose(0, 2, 1)


def test_inverses_and_solutions_are_those_of_numpy():
    matrix, right = systems(200), np.random.default_rng(1).normal(size=(200, 3))
    expected = np.linalg.solve(matrix, right[..., None])[..., 0]
    scale = np.abs(expected).max(axis=1, keepdims=True)
    assert (np.abs(triangulation.solve_3x3(matrix, right) - expected) / scale).max() < 1e-6
    product = triangulation.inverse_3x3(matrix) @ matrix
    assert np.median(np.abs(product - np.eye(3))) < 1e-12


def test_a_singular_system_has_no_solution_and_spoils_no_other():
    matrix = systems(3)
    matrix[1] = np.outer([1, 2, 3], [1, 2, 3])
    found = triangulation.solve_3x3(matrix, np.ones((3, 3)))
    assert np.isnan(found[1]).all() and np.isfinite(found[[0, 2]]).all()


# Views: residuals against OpenCV, derivatives against differences.
VIEWED_BY = scene.ring(3)  # without distortion, pixels are the plane
VIEWED = scene.points(20)
SEEN = triangulation.Views(VIEWED_BY, scene.views(VIEWED_BY, VIEWED), np.ones((3, 20)))
NEAR = VIEWED + np.random.default_rng(1).normal(0, 0.05, VIEWED.shape)


def test_residuals_are_those_of_opencv():
    found = SEEN.residuals(NEAR)
    expected = scene.views(VIEWED_BY, NEAR) - scene.views(VIEWED_BY, VIEWED)
    np.testing.assert_allclose(found.px.mT, expected, atol=1e-6)
    np.testing.assert_allclose(found.distance, np.linalg.norm(expected, axis=-1), atol=1e-6)
    depth = np.einsum("cj,nj->cn", [c.cam_from_world[2, :3] for c in VIEWED_BY], NEAR)
    np.testing.assert_allclose(found.in_cam[:, 2], depth + SEEN.matrix[:, 2, 3:], atol=1e-12)


def test_normal_equations_are_those_of_differences():
    weight = np.random.default_rng(2).uniform(0.2, 1, (3, 20))
    rows, depth = SEEN.jacobians(SEEN.residuals(NEAR).in_cam)
    steps = 1e-6 * np.eye(3)
    slope = [(SEEN.residuals(NEAR + d).px - SEEN.residuals(NEAR - d).px) / 2e-6 for d in steps]
    slope = np.moveaxis(slope, 0, 2)
    np.testing.assert_allclose(rows / depth[:, None, None], slope, rtol=1e-6, atol=1e-6)
    expected = np.einsum("crin,cn,crjn->nij", slope, weight, slope)
    np.testing.assert_allclose(triangulation._normal(slope, weight), expected, rtol=1e-12)
    np.testing.assert_allclose(triangulation._normal(rows, weight / depth**2), expected, rtol=1e-6)


def test_a_step_solves_the_weighted_normal_equations():
    weight, there = np.random.default_rng(2).uniform(0.2, 1, (3, 20)), SEEN.residuals(NEAR)
    rows, depth = SEEN.jacobians(there.in_cam)
    slope = (rows / depth[:, None, None]) * np.sqrt(weight)[:, None, None]
    step = [
        np.linalg.lstsq(slope[..., at].reshape(-1, 3), residual.ravel())[0]
        for at, residual in enumerate(np.moveaxis(there.px * np.sqrt(weight)[:, None], -1, 0))
    ]
    np.testing.assert_allclose(SEEN.stepped(NEAR, weight), NEAR - step, atol=1e-9)
    np.testing.assert_allclose(SEEN.stepped(NEAR, weight, there), NEAR - step, atol=1e-9)


def test_steps_end_at_the_points_that_the_views_show():
    xyz = NEAR
    for _ in range(4):
        xyz = SEEN.stepped(xyz, SEEN.weight)
    np.testing.assert_allclose(xyz, VIEWED, atol=1e-9)
    part = SEEN.of(np.array([3, 5]))
    np.testing.assert_allclose(part.stepped(VIEWED[[3, 5]], part.weight), VIEWED[[3, 5]], atol=1e-9)


def test_a_step_without_weight_leaves_a_point_where_it_is():
    weight = SEEN.weight.copy()
    weight[:, 4] = 0
    moved = SEEN.stepped(NEAR, weight) != NEAR
    assert moved.any(axis=1).tolist() == [True] * 4 + [False] + [True] * 15


def test_points_are_in_front_of_the_cameras_named():
    behind = 2 * VIEWED_BY[0].centre_in_world - VIEWED
    nobody, first = np.zeros((3, 20), bool), np.zeros((3, 20), bool)
    first[0] = True
    before, after = SEEN.residuals(VIEWED), SEEN.residuals(behind)
    assert before.in_front(~nobody).all() and after.in_front(nobody).all()
    assert not after.in_front(first).any()


@pytest.mark.filterwarnings("error")
def test_cameras_in_one_place_leave_a_point_open_without_a_word():
    views = [replace(view, cam_from_world=np.eye(3, 4)) for view in scene.ring(2)]
    noise_px = np.random.default_rng(2).normal(0, 3, (2, 20, 2))
    xy = scene.views(views, scene.points(20) + np.array([0, 0, 5])) + noise_px
    xyz = triangulation.triangulate_all(views, xy)
    assert xyz.shape == (20, 3)
    found = triangulation.triangulate_robust(views, xy, np.ones(xy.shape[:2]), **LIMITS)
    assert not np.isfinite(found.covariance).all(axis=(1, 2)).all()
