"""Joint offsets: known shares of known vectors are found, and removed from other bodies."""

import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.geometry import triangulation
from courtside.kinematics import skeleton_filter
from courtside.reconstruction import joint_correction, offset_vectors
from courtside.reconstruction.joint_correction import Clip
from courtside.records.keypoints import keypoints, skeleton
from courtside.study.errors import InputError
from fixtures.cameras import scene
from fixtures.people import footwork, view_offsets, walker

CONFIG = Path(__file__).parents[3] / "config"
JOINTS = list(skeleton.JOINTS)
SHARES = {"up": 0.05, "out": -0.03, "forward": 0.02}
ALONG_THIGH = 0.1


def bodies(n, seed, size=1.0, turned=True):
    """Return (n, 12, 3): a standing body, by default turned, with random limb directions."""
    rng = np.random.default_rng(seed)
    found = np.zeros((n, 12, 3))
    for at, sign in ((0, 1.0), (6, -1.0)):
        found[:, at] = [0, 0.2 * sign, 1.4]
        found[:, at + 3] = [0, 0.12 * sign, 0.9]
        for start, stop, length in ((0, 1, 0.3), (1, 2, 0.25), (3, 4, 0.42), (4, 5, 0.4)):
            way = rng.normal([0, 0, -1.0], 1.0, (n, 3))
            way /= np.linalg.norm(way, axis=1, keepdims=True)
            found[:, at + stop] = found[:, at + start] + length * way
    turn = (
        Rotation.random(n, rng=rng).as_matrix() if turned else np.broadcast_to(np.eye(3), (n, 3, 3))
    )
    return size * np.einsum("nij,nkj->nki", turn, found)


def displaced(true):
    """Return the bodies with every hip moved by SHARES of the trunk and along its thigh."""
    moved = true.copy()
    trunk = (true[:, 0] + true[:, 6] - true[:, 3] - true[:, 9]) / 2
    size = np.linalg.norm(trunk, axis=1, keepdims=True)
    up = trunk / size
    left = true[:, 0] - true[:, 6]
    left = left - (left * up).sum(axis=1, keepdims=True) * up
    left /= np.linalg.norm(left, axis=1, keepdims=True)
    forward = np.cross(left, up)
    for at, sign in ((3, 1), (9, -1)):
        moved[:, at] += size * (
            SHARES["up"] * up + SHARES["out"] * sign * left + SHARES["forward"] * forward
        )
        moved[:, at] += ALONG_THIGH * (true[:, at + 1] - true[:, at])
    return moved


def record(xyz):
    """Return a Keypoints3D that holds the bodies as one person."""
    points = walker.points(len(xyz), n_cameras=2)
    full = np.full((1, len(xyz), walker.N_JOINTS, 3), 7.0)
    full[0][:, [list(points.joints).index(name) for name in JOINTS]] = xyz
    return replace(points, xyz=full, covariance_2d=np.zeros((*full.shape, 3)))


def test_forward_is_where_toes_point_and_out_is_the_joints_own_side():
    """A body that stands upright with its left side at +y looks along -x: left cross up."""
    standing = bodies(1, seed=0)
    standing[0, :, :] = 0
    standing[0, [0, 6, 3, 9]] = [[0, 0.2, 1.4], [0, -0.2, 1.4], [0, 0.12, 0.9], [0, -0.12, 0.9]]
    left = offset_vectors.of_body(standing, JOINTS, "left", "hip")
    right = offset_vectors.of_body(standing, JOINTS, "right", "hip")
    np.testing.assert_allclose(left["up"][0], [0, 0, 0.5], atol=1e-12)
    np.testing.assert_allclose(left["forward"][0], [0.5, 0, 0], atol=1e-12)
    np.testing.assert_allclose(left["out"][0], [0, 0.5, 0], atol=1e-12)
    np.testing.assert_allclose(right["out"][0], [0, -0.5, 0], atol=1e-12)


def test_shares_are_found_and_hold_for_bodies_of_another_size():
    """The trunk is that of the displaced body: the result is not SHARES but removes them."""
    true = bodies(400, seed=1)
    table = joint_correction.estimate([Clip(displaced(true), true)], JOINTS, JOINTS)
    hips = table[table["joint"] == "hip"]
    assert (hips["n"] == 800).all()
    elsewhere = bodies(50, seed=2, size=0.8)
    corrected = joint_correction.correct(record(displaced(elsewhere)), table)
    at = [list(corrected.joints).index(name) for name in JOINTS]
    before = np.linalg.norm(displaced(elsewhere) - elsewhere, axis=-1)
    after = np.linalg.norm(corrected.xyz[0][:, at] - elsewhere, axis=-1)
    assert before[:, [3, 9]].mean() > 0.03
    assert after[:, [3, 9]].mean() < 0.05 * before[:, [3, 9]].mean()
    assert after[:, [0, 1, 2, 6, 7, 8]].max() < 2e-3
    others = [k for k in range(walker.N_JOINTS) if k not in at]
    assert (corrected.xyz[0][:, others] == 7).all()


def test_keypoints_lose_what_each_camera_sees_a_joint_off():
    """Truth: the true joints, projected. What cannot be known without a trunk stays."""
    cameras, true = scene.ring(4), bodies(30, seed=5)
    xy, exact = view_offsets.seen(cameras, true), np.stack([
        scene.opencv_projection(camera, true.reshape(-1, 3)).reshape(30, 12, 2)
        for camera in cameras
    ])  # fmt: skip
    xyz = triangulation.triangulate_all(cameras, xy)
    found = joint_correction.in_pictures(cameras, xy, xyz, JOINTS, view_offsets.table())
    before, after = (np.linalg.norm(one - exact, axis=-1) for one in (xy, found))
    assert before.max() > 4 and np.median(before[:, :, 1]) > 2
    assert after.max() < 0.12 * before.max()  # the axes of the trunk are off, too
    assert np.median(after) < 0.03 * np.median(before)
    xyz[7, JOINTS.index("left_hip")] = np.nan
    again = joint_correction.in_pictures(cameras, xy, xyz, JOINTS, view_offsets.table())
    np.testing.assert_array_equal(again[:, 7], xy[:, 7])
    others = np.delete(again, 7, axis=1), np.delete(found, 7, axis=1)
    np.testing.assert_allclose(*others, atol=1e-3)  # the trunk's length is of a frame less


def test_what_remains_is_its_standard_deviation_and_joins_the_covariance():
    rng = np.random.default_rng(3)
    sizes = rng.uniform(0.7, 1.3, (2000, 1, 1))  # else the lengths of limbs would show the noise
    true = sizes * bodies(2000, seed=4)
    noisy = true.copy()
    noisy[:, [2, 8]] += rng.normal(0, 0.01, (2000, 2, 3))
    table = joint_correction.estimate([Clip(noisy, true)], JOINTS, JOINTS)
    sigma_m = table.groupby("joint")["sigma_m"].first()
    assert sigma_m["wrist"] == pytest.approx(0.01, rel=0.05)
    assert sigma_m["hip"] < 1e-3
    for size, own in ((1.0, 1.0), (0.714, 0.7)):  # an adult, and a child with a trunk of 0.357 m
        upright = record(bodies(8, seed=5, size=size, turned=False))
        corrected = joint_correction.correct(upright, table)
        at, own_m = list(corrected.joints).index("left_wrist"), own * sigma_m["wrist"]
        np.testing.assert_allclose(
            corrected.covariance_2d[0, 0, at], own_m**2 * np.eye(3), atol=1e-12
        )


@pytest.mark.parametrize(("tilt_deg", "more_m"), [(25, 0), (45, 0.01), (90, 0.02), (180, 0.02)])
def test_joints_of_who_leans_further_than_the_fit_are_less_certain(tilt_deg, more_m):
    table = joint_correction.read(CONFIG / "joint_offsets" / "blazepose-heavy-flip.csv")
    table = table[~table["vector"].str.startswith("seen ")]
    sigma_m = table.loc[table["joint"] == "hip", "sigma_m"].iloc[0]
    turn = Rotation.from_euler("y", tilt_deg, degrees=True).as_matrix()
    points = record(bodies(8, seed=5, turned=False) @ turn.T)
    corrected = joint_correction.correct(points, table)
    at = list(corrected.joints).index("left_hip")
    np.testing.assert_allclose(
        corrected.covariance_2d[0, :, at] - points.covariance_2d[0, :, at],
        np.broadcast_to((sigma_m**2 + more_m**2) * np.eye(3), (8, 3, 3)),
        atol=1e-9,
    )


def test_the_direction_of_an_arm_counts_whatever_its_length():
    """Elbows that a network puts 2 cm along the forearm, for forearms of any length."""
    true = bodies(300, seed=11) * np.random.default_rng(12).uniform(0.8, 1.2, (300, 1, 1))
    found = true.copy()
    for elbow in (1, 7):
        way = true[:, elbow + 1] - true[:, elbow]
        found[:, elbow] += 0.02 * way / np.linalg.norm(way, axis=-1, keepdims=True)
    table = joint_correction.estimate([Clip(found, true)], JOINTS, JOINTS)
    corrected = joint_correction.correct(record(found), table)
    at = [list(corrected.joints).index(name) for name in ("left_elbow", "right_elbow")]
    assert np.linalg.norm(corrected.xyz[0][:, at] - true[:, [1, 7]], axis=-1).mean() < 1e-3


def test_hips_of_men_and_women_may_be_off_in_opposite_directions():
    """Men's hips too high, women's as much too low: who is neither keeps the place."""
    men, women, others = (bodies(400, seed) for seed in (8, 9, 10))

    def moved(true, sign):
        found = true.copy()
        trunk = (true[:, 0] + true[:, 6] - true[:, 3] - true[:, 9]) / 2
        found[:, [3, 9]] += sign * SHARES["up"] * trunk[:, np.newaxis]
        return found

    clips = [Clip(moved(men, 1), men, "m"), Clip(moved(women, -1), women, "f")]
    table = joint_correction.estimate(clips, JOINTS, JOINTS)
    for sex, sign in (("m", 1), ("f", -1), (None, 0)):
        corrected = joint_correction.correct(record(moved(others, sign)), table, {"p1": sex})
        at = [list(corrected.joints).index(name) for name in ("left_hip", "right_hip")]
        assert np.abs(corrected.xyz[0][:, at] - others[:, [3, 9]]).max() < 3e-3
    wrong = joint_correction.correct(record(moved(others, 1)), table, {"p1": "f"})
    assert np.linalg.norm(wrong.xyz[0][:, at] - others[:, [3, 9]], axis=-1).mean() > 0.04


def scaled_cameras(cameras, size):
    """Return the cameras of a scene that is `size` times as large: they see the same pictures."""
    matrices = [one.cam_from_world * [1.0, 1.0, 1.0, size] for one in cameras]
    return [
        replace(one, cam_from_world=matrix) for one, matrix in zip(cameras, matrices, strict=True)
    ]


@pytest.mark.parametrize("size", [0.65, 1.4])
@pytest.mark.parametrize("model", ["blazepose-full", "blazepose-heavy-flip"])
def test_in_a_scene_of_another_size_all_lengths_are_as_many_times_as_long(model, size):
    """A child before near cameras gives the pictures of an adult before far ones."""
    raw, filtered, _, sex_of, cutoff_hz, order, seen_by = player(3)
    rows = joint_correction.read(CONFIG / "joint_offsets" / f"{model}.csv")

    def corrected(scale):
        own = [
            replace(
                one,
                xyz=scale * one.xyz,
                **{
                    name: scale**2 * getattr(one, name)
                    for name in ("covariance_2d", "covariance_camera")
                },
            )
            for one in (raw, filtered)
        ]
        given = sex_of, cutoff_hz, order, scaled_cameras(seen_by, scale)
        return joint_correction.correct_then_filter(*own, rows, *given)

    one, other = corrected(size), corrected(1.05 * size)
    at = [list(raw.joints).index(name) for name in JOINTS]
    assert np.linalg.norm(one.xyz - size * filtered.xyz, axis=-1)[:, :, at].mean() > 0.01 * size
    np.testing.assert_allclose(other.xyz, 1.05 * one.xyz, atol=1e-9)
    np.testing.assert_allclose(other.covariance_2d, 1.05**2 * one.covariance_2d, atol=1e-12)


def test_a_body_seen_in_one_frame_only_has_offsets_of_its_own_size():
    rows = joint_correction.read(CONFIG / "joint_offsets" / "blazepose-full.csv")
    points, cameras = walker.points(8, n_cameras=4), scene.ring(4)
    points.xyz[:, 1:] = np.nan

    def moved(size):
        own = replace(points, xyz=size * points.xyz)
        return joint_correction.offsets(own, rows, None, scaled_cameras(cameras, size))

    assert np.nanmax(np.abs(moved(0.5))) > 0.01
    np.testing.assert_allclose(moved(0.6), 1.2 * moved(0.5), atol=1e-12)


def test_all_adults_have_the_offsets_of_the_table():
    """Children and giants have those of their own size; between them nothing jumps."""
    adult = bodies(5, seed=1)
    adult *= 1.02  # a trunk of 0.51 m
    sizes = [0.4, 0.76, 0.82, 0.88, 0.95, 1.0, 1.12, 1.2, 1.28, 1.5]
    found = [offset_vectors.size_of(size * adult, JOINTS) for size in sizes]
    np.testing.assert_allclose(found, [0.4, 0.76, 0.88, 1, 1, 1, 1, 1.14, 1.28, 1.5])


def seen_at(true, cameras):
    """Return bodies (n, 12, 3) as cameras triangulate them whose network errs by the view.

    In each view knees are 5 cm too far forward, times the component along the body's own side of
    the direction of view: in front and behind nothing, from the side all of it.
    """
    found, scores = true.copy(), np.ones((len(cameras), len(true)))
    trunk = true[:, 0] + true[:, 6] - true[:, 3] - true[:, 9]
    for at, sign in ((4, 1), (10, -1)):
        out = sign * (true[:, 0] - true[:, 6] + true[:, 3] - true[:, 9])
        out, forward = (v / np.linalg.norm(v, axis=1, keepdims=True) for v in (
            out, np.cross(sign * out, trunk)))  # fmt: skip
        pictures = []
        for camera in cameras:
            way = true[:, at] - camera.centre_in_world
            way /= np.linalg.norm(way, axis=1, keepdims=True)
            place = true[:, at] + 0.05 * (way * out).sum(axis=1, keepdims=True) * forward
            pictures.append(scene.opencv_projection(camera, place))
        limits = {"max_error_px": 60.0, "fade_px": 1e6}
        seen = triangulation.triangulate_robust(cameras, np.stack(pictures), scores, **limits)
        found[:, at] = seen.xyz
    return found


def test_offsets_that_depend_on_the_view_hold_for_cameras_elsewhere():
    """Fitted with three cameras on one side, used with two of another height and distance."""
    around = scene.ring(7, radius_m=7.0, height_m=1.0)[:3]
    elsewhere = [*scene.ring(5, radius_m=12.0, height_m=5.0)[1:3]]
    upright = Rotation.from_rotvec(np.linspace(0, 6, 300)[:, None] * [0, 0, 1]).as_matrix()
    true = np.einsum("nij,nkj->nki", upright, bodies(300, seed=21, turned=False))
    other = np.einsum("nij,nkj->nki", upright[::-1], bodies(300, seed=22, turned=False))
    accepted = np.ones((300, len(JOINTS), 3), dtype=bool)
    clip = Clip(seen_at(true, around), true, None, around, accepted)
    by_view = joint_correction.estimate([clip], JOINTS, JOINTS)
    alone = joint_correction.estimate([replace(clip, cameras=(), accepted=None)], JOINTS, JOINTS)
    points = record(seen_at(other, elsewhere))
    points = replace(points, cameras=np.array([camera.name for camera in elsewhere]))
    at, error = [list(points.joints).index(f"{side}_knee") for side in ("left", "right")], {}
    for name, found in (
        ("raw", points),
        ("alone", joint_correction.correct(points, alone)),
        ("by view", joint_correction.correct(points, by_view, cameras=elsewhere[::-1])),
    ):
        error[name] = np.linalg.norm(found.xyz[0][:, at] - other[:, [4, 10]], axis=-1).mean()
    assert error["raw"] > 0.01
    assert error["by view"] < 0.2 * error["raw"] and error["alone"] > 0.7 * error["raw"]
    with pytest.raises(ValueError, match="expected the cameras of the skeletons, missing"):
        joint_correction.correct(points, by_view)


def test_a_joint_whose_trunk_is_missing_keeps_its_place():
    true = bodies(20, seed=5)
    table = joint_correction.estimate([Clip(displaced(true), true)], JOINTS, JOINTS)
    points = record(displaced(bodies(20, seed=5, turned=False)))
    points.xyz[0, 3, list(points.joints).index("left_shoulder")] = np.nan
    corrected = joint_correction.correct(points, table)
    at = list(points.joints).index("right_hip")
    np.testing.assert_array_equal(corrected.xyz[0, 3, at], points.xyz[0, 3, at])
    assert not np.array_equal(corrected.xyz[0, 4, at], points.xyz[0, 4, at])
    np.testing.assert_array_equal(corrected.offset[0, 3, at], points.offset[0, 3, at])
    grown = corrected.covariance_2d[0, :, at] - points.covariance_2d[0, :, at]
    np.testing.assert_allclose(grown[3], grown[4])  # none is surer for not being corrected
    assert np.trace(grown[3]) > 0


def test_a_joint_seen_in_no_clip_is_a_fault():
    true = bodies(3, seed=6)
    blind = true.copy()
    blind[:, [5, 11]] = np.nan
    with pytest.raises(ValueError, match="expected hip in a clip"):
        joint_correction.estimate([Clip(blind, true)], JOINTS, JOINTS)


def test_a_table_is_read_back_and_other_files_are_refused(tmp_path):
    table = joint_correction.estimate(
        [Clip(displaced(bodies(50, 7)), bodies(50, 7))], JOINTS, JOINTS
    )
    path = tmp_path / "offsets.csv"
    path.write_text("# made by a rule\n" + table.to_csv(index=False))
    assert joint_correction.read(path)["share"].to_numpy() == pytest.approx(table["share"])
    path.write_text("joint,vector\nnose,up\n")
    with pytest.raises(InputError, match=r"expected columns .* found columns"):
        joint_correction.read(path)
    with pytest.raises(InputError, match="expected a table of joint offsets"):
        joint_correction.read(tmp_path / "none.csv")


ARM = ("left_shoulder", "left_elbow", "left_wrist")
UPPER_M, FOREARM_M = 0.30, 0.26


def arms(n_frames, seed, sigma_m=(0.01, 0.05, 0.01)):
    """Return true places (T, 3, 3) of an arm that swings about, and the same with noise."""
    rng = np.random.default_rng(seed)
    way = rng.normal(size=(2, n_frames, 3))
    way /= np.linalg.norm(way, axis=-1, keepdims=True)
    shoulder = rng.normal(size=(n_frames, 3))
    elbow = shoulder + UPPER_M * way[0]
    true = np.stack([shoulder, elbow, elbow + FOREARM_M * way[1]], axis=1)
    noise = rng.normal(size=true.shape) * np.array(sigma_m)[:, None]
    return true, true + noise


def record_limb_lengths(xyz, sigma_m=(0.01, 0.05, 0.01)):
    n_frames = len(xyz)
    covariance = np.array(sigma_m)[:, None, None] ** 2 * np.eye(3)
    shape = (1, n_frames, 3)
    return keypoints.Keypoints3D(
        cameras=np.array(["a", "b"]),
        model="net",
        joints=np.array(ARM),
        person_id=np.array(["p1"]),
        time_s=np.arange(n_frames) / 30,
        xyz=xyz[None],
        covariance_2d=np.broadcast_to(covariance, (*shape, 3, 3)).copy(),
        covariance_camera=np.full((*shape, 3, 3), np.nan),
        covariance_network=np.full((*shape, 3, 3), np.nan),
        offset=np.full((*shape, 3), np.nan),
        outlier=np.full(shape, np.nan),
        n_views=np.full(shape, 2),
        reproj_error_px=np.zeros((*shape, 2)),
        accepted=np.ones((*shape, 2), dtype=bool),
        swapped=np.zeros((*shape, 2), dtype=bool),
        reason=np.zeros(shape, dtype=np.uint8),
    )


def test_lengths_are_those_of_the_body_in_spite_of_noise_and_gaps():
    _, noisy = arms(2000, seed=1, sigma_m=(0.01, 0.01, 0.01))
    noisy[::3, 1] = np.nan
    found = joint_correction.lengths(noisy, ARM)
    assert found["shoulder", "elbow"] == pytest.approx(UPPER_M, rel=0.01)
    assert found["elbow", "wrist"] == pytest.approx(FOREARM_M, rel=0.01)
    assert set(found) == {("shoulder", "elbow"), ("elbow", "wrist")}
    assert joint_correction.lengths(noisy[:4], ARM) == {}


def with_own_lengths(points):
    """Keep the limbs' lengths, which are those of the same points."""
    limbs_m = [joint_correction.lengths(one, points.joints.tolist()) for one in points.xyz]
    return joint_correction.keep(points, limbs_m)


def test_an_uncertain_elbow_comes_nearer_to_the_truth_and_certain_joints_stay():
    true, noisy = arms(800, seed=2)
    kept = with_own_lengths(record_limb_lengths(noisy)).xyz[0]
    before, after = (np.linalg.norm(xyz - true, axis=2) for xyz in (noisy, kept))
    assert np.median(after[:, 1]) < 0.85 * np.median(before[:, 1])
    assert np.percentile(after[:, 1], 95) < 0.85 * np.percentile(before[:, 1], 95)
    assert np.median(after[:, [0, 2]]) < 1.05 * np.median(before[:, [0, 2]])


def test_only_the_joint_that_is_uncertain_moves_and_only_along_the_limb():
    true, _ = arms(200, seed=3)
    moved = true.copy()
    stretch = np.where(np.arange(200) % 10 == 0, 1.3, 1.0)  # every tenth forearm is too long
    moved[:, 2] = true[:, 1] + stretch[:, None] * (true[:, 2] - true[:, 1])
    sigma_m = (1e-4, 1e-4, 0.5)
    kept = with_own_lengths(record_limb_lengths(moved, sigma_m)).xyz[0]
    np.testing.assert_allclose(kept[:, :2], true[:, :2], atol=1e-5)
    np.testing.assert_allclose(kept[:, 2], true[:, 2], atol=1e-4)


def test_a_skeleton_that_is_right_stays_as_it_is():
    true, _ = arms(50, seed=4)
    np.testing.assert_allclose(with_own_lengths(record_limb_lengths(true)).xyz[0], true, atol=1e-9)


def test_what_is_missing_stays_missing_and_holds_nothing_else_up():
    _, noisy = arms(400, seed=5)
    noisy[::2, 2] = np.nan
    points = record_limb_lengths(noisy)
    points.covariance_2d[:, 100:] = np.nan
    kept = with_own_lengths(points)
    np.testing.assert_array_equal(np.isnan(kept.xyz), np.isnan(points.xyz))
    np.testing.assert_array_equal(kept.covariance_2d, points.covariance_2d)
    length = np.linalg.norm(kept.xyz[0, ::2, 1] - kept.xyz[0, ::2, 0], axis=1)
    assert np.std(length) < 0.5 * np.std(np.linalg.norm(noisy[::2, 1] - noisy[::2, 0], axis=1))


def test_limbs_that_nobody_knows_and_other_joints_stay():
    _, noisy = arms(5, seed=6)  # too few frames for a length
    np.testing.assert_array_equal(with_own_lengths(record_limb_lengths(noisy)).xyz[0], noisy)
    few = replace(record_limb_lengths(arms(50, seed=7)[1]), joints=np.array(["nose", *ARM[1:]]))
    kept = with_own_lengths(few)
    np.testing.assert_array_equal(kept.xyz, few.xyz)


def test_the_turn_of_the_world_does_not_matter():
    _, noisy = arms(60, seed=8)
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    straight = with_own_lengths(record_limb_lengths(noisy)).xyz @ turn.T
    np.testing.assert_allclose(
        with_own_lengths(record_limb_lengths(noisy @ turn.T)).xyz, straight, atol=1e-9
    )


def player(seconds):
    """Return the arguments of `correct_then_filter` for a player of virtual truth."""
    rate_hz, cutoff_hz = 30.0, np.full(33, 6.0)
    offsets = joint_correction.read(CONFIG / "joint_offsets" / "blazepose-full.csv")
    time_s, neck = footwork.neck(rate_hz, seconds, seed=3)
    xyz, _ = footwork.body(neck, time_s)
    raw = footwork.record(xyz, time_s, 0.02, 0.0, np.random.default_rng(0))
    filtered = skeleton_filter.smooth(raw, cutoff_hz, 4)
    return raw, filtered, offsets, {"p1": "m"}, cutoff_hz, 4, footwork.cameras(90)[0]


def test_blocks_of_frames_have_no_borders(monkeypatch):
    whole = joint_correction.correct_then_filter(*player(3))
    monkeypatch.setattr(keypoints, "BLOCK", 7)
    parts = joint_correction.correct_then_filter(*player(3))
    for name, values in vars(whole).items():
        np.testing.assert_array_equal(getattr(parts, name), values)


def test_the_correction_of_a_long_take_needs_little_memory():
    """Of all frames at once, vectors and corrected copies are half as large again as the record."""
    given = player(600)
    record = sum(values.nbytes for values in vars(given[1]).values() if np.ndim(values) > 2)
    tracemalloc.start()
    joint_correction.correct_then_filter(*given)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 1.2 * record


def test_corrected_skeletons_are_filtered_last():
    raw, filtered, offsets, sex_of, cutoff_hz, order, seen_by = player(10)
    done = joint_correction.correct_then_filter(
        raw, filtered, offsets, sex_of, cutoff_hz, order, cameras=seen_by
    )
    before = with_own_lengths(joint_correction.correct(filtered, offsets, sex_of, seen_by))

    def fast(points):  # power above twice the cut-off, of the limbs' joints
        limbs = [list(points.joints).index(name) for name in JOINTS]
        change = np.diff(points.xyz[0][:, limbs], n=2, axis=0)[30:-30]
        spectrum = np.fft.rfft(change * np.hanning(len(change))[:, None, None], axis=0)
        hz = np.fft.rfftfreq(len(change), 1 / raw.rate_hz)
        return np.mean(np.abs(spectrum[hz > 12]) ** 2)

    assert fast(done) < 0.2 * fast(before)
    np.testing.assert_allclose(done.xyz, before.xyz, atol=0.04)  # and otherwise the same
    np.testing.assert_array_equal(done.covariance_2d, before.covariance_2d)


@pytest.mark.parametrize("sigma_m", [0.05, 0.002], ids=["above_the_scatter", "below_it"])
def test_a_correction_takes_the_offset_and_its_scatter_out_of_what_is_unknown(sigma_m):
    rows = joint_correction.read(CONFIG / "joint_offsets" / "blazepose-full.csv")
    time_s, neck = footwork.neck(30.0, 2, seed=3)
    raw = footwork.record(footwork.body(neck, time_s)[0], time_s, 0.0, 0.0, np.random.default_rng())
    cameras, _ = footwork.cameras(90)
    offset = joint_correction.offsets(raw, rows, {"p1": "m"}, cameras)
    network = np.full((*raw.xyz.shape, 3), np.nan)
    network[..., :, :] = sigma_m**2 * np.eye(3)
    raw = replace(raw, covariance_network=network, offset=offset)
    done = joint_correction.correct(raw, rows, {"p1": "m"}, cameras)
    at = [list(raw.joints).index(name) for name in JOINTS]
    np.testing.assert_allclose(done.xyz[:, :, at], (raw.xyz - offset)[:, :, at])
    assert (done.offset[:, :, at] == 0).all()
    beside = raw.covariance - offset[..., :, None] * offset[..., None, :]
    np.testing.assert_allclose(done.covariance[:, :, at], beside[:, :, at], atol=1e-12)
