"""Speeds, accelerations and distances of formula-made movements, and their sigmas."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from courtside.kinematics import filtering, measures, shared_errors, skeleton_filter
from courtside.reconstruction import joint_correction
from courtside.records.keypoints import derived_joints, keypoints, missing_reason, skeleton
from fixtures.people import footwork, walker

CONFIG = Path(__file__).parents[3] / "config"
TABLE = derived_joints.read(CONFIG / "derived_joints.yaml")
CUTOFFS_HZ = np.array(walker.SKELETON.by_group({"head": 6, "trunk": 6, "arms": 10, "legs": 8}))
TINY_M = 1e-7
NETWORKS_WITH_OFFSETS = sorted(path.stem for path in (CONFIG / "joint_offsets").glob("*.csv"))


def circling(rate_hz=60.0, seconds=12.0, radius_m=2.0, turn_s=4.0):
    """Return times and a player (T, 33, 3) whose body is carried round a circle without turning."""
    time_s = np.arange(round(seconds * rate_hz) + 1) / rate_hz
    angle = 2 * np.pi * time_s / turn_s
    round_trip = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1) * radius_m
    body, _ = footwork.body(np.array([[3.0, 3.0, 1.45]]), np.zeros(1))
    return time_s, body + round_trip[:, None]


def of_raw(record, how, sexes):
    """Measure raw skeletons after the one filter, all persons."""
    smooth = skeleton_filter.smooth(record, how.cutoff_hz, how.order)
    return measures.measure(smooth, record, TABLE, "blazepose33", how, sexes)


def measured(record, how=None, sex="m"):
    return of_raw(record, how or measures.Filter(CUTOFFS_HZ), {"p1": sex})[0]


def test_a_circle_has_its_speed_acceleration_and_length():
    time_s, xyz = circling()
    record = footwork.record(xyz, time_s, TINY_M, 0.0, np.random.default_rng(0))
    person = measured(record)
    speed = 2 * np.pi * 2.0 / 4.0
    middle = slice(60, -60)
    assert set(person.points) == {"neck", "centre", "mass"}
    for point in person.points.values():
        found, _ = measures.size(point.velocity, point.covariance[1])
        np.testing.assert_allclose(found[middle], speed, rtol=2e-3)
        found, _ = measures.size(point.acceleration, point.covariance[2])
        np.testing.assert_allclose(found[middle], speed**2 / 2.0, rtol=1e-2)
        assert point.distance.corrected_m == pytest.approx(speed * 12, rel=2e-3)
        assert point.ground_distance.corrected_m == pytest.approx(speed * 12, rel=2e-3)


def test_one_frame_has_places_and_neither_speeds_nor_distances():
    person = measured(walker.points().frames(slice(10, 11)))
    for point in person.points.values():
        assert np.isfinite(point.position).all()
        assert np.isfinite(point.covariance[0]).all()
        assert np.isnan(point.velocity).all() and np.isnan(point.covariance[1]).all()
        assert np.isnan(point.distance.corrected_m)
        assert point.distance.seconds == 0


def test_points_are_where_they_are_defined():
    time_s, xyz = circling(seconds=2)
    record = footwork.record(xyz, time_s, TINY_M, 0.0, np.random.default_rng(0))
    points = measured(record).points
    neck = (
        xyz[:, walker.SKELETON.index("left_shoulder")]
        + xyz[:, walker.SKELETON.index("right_shoulder")]
    ) / 2
    eyes = (
        xyz[:, walker.SKELETON.index("left_eye")] + xyz[:, walker.SKELETON.index("right_eye")]
    ) / 2
    limbs = [xyz[:, walker.SKELETON.index(joint)] for joint in walker.SKELETON.groups["limbs"]]
    np.testing.assert_allclose(points["neck"].position[30:-30], neck[30:-30], atol=2e-3)
    centre = (neck + eyes + np.sum(limbs, axis=0)) / 14
    np.testing.assert_allclose(points["centre"].position[30:-30], centre[30:-30], atol=2e-3)
    assert points["mass"].definition == "de Leva 1996, men, head (mid-ears)"
    assert measured(record, sex=None).points["mass"].definition.startswith("de Leva 1996, mean of")


@pytest.mark.parametrize("memory_s", [0.0, 0.08])
def test_sigmas_hold_ninety_percent(memory_s):
    time_s, xyz = circling(rate_hz=30.0, seconds=20.0)
    clean = measured(footwork.record(xyz, time_s, TINY_M, 0.0, np.random.default_rng(9)))
    inside = {"speed": [], "acceleration": [], "position": [], "angle": []}
    for seed in range(4):
        rng = np.random.default_rng(seed)
        record = footwork.record(xyz, time_s, [0.012, 0.02, 0.015], memory_s, rng)
        person = measured(record)
        for name, point in person.points.items():
            truth = clean.points[name]
            speed, sigma = measures.size(point.velocity, point.covariance[1])
            ideal, _ = measures.size(truth.velocity, truth.covariance[1])
            inside["speed"].append(np.abs(speed - ideal) < 1.645 * sigma)
            sigma = np.sqrt(point.covariance[2][:, 0, 0])
            off = point.acceleration[:, 0] - truth.acceleration[:, 0]
            inside["acceleration"].append(np.abs(off) < 1.645 * sigma)
            sigma = np.sqrt(point.covariance[0][:, 2, 2])
            off = point.position[:, 2] - truth.position[:, 2]
            inside["position"].append(np.abs(off) < 1.645 * sigma)
        for name, angle in person.angles.items():
            off = angle.degrees - clean.angles[name].degrees
            inside["angle"].append(np.abs(off) < 1.645 * angle.sigma_deg)
    shares = {name: np.mean(values) for name, values in inside.items()}
    assert all(0.85 < share < 0.95 for share in shares.values()), shares


def test_the_speed_of_a_player_is_right_to_a_stated_error():
    rate_hz = 30.0
    time_s, neck = footwork.neck(rate_hz, 24, seed=21)
    fine_s, fine = footwork.neck(1500, 24, seed=21)
    truth = np.linalg.norm(np.gradient(fine, fine_s, axis=0), axis=1)[::50]
    xyz, _ = footwork.body(neck, time_s)
    # 20 mm per shoulder: 14 mm for the neck between them.
    record = footwork.record(xyz, time_s, 0.020, 0.08, np.random.default_rng(1))
    errors = {}
    for cutoff_hz in (4.0, 6.0):
        how = measures.Filter(np.full(33, cutoff_hz))
        point = measured(record, how).points["neck"]
        speed, _ = measures.size(point.velocity, point.covariance[1])
        errors[cutoff_hz] = np.sqrt(np.mean((speed - truth) ** 2))
    assert errors[4.0] < 0.17
    assert errors[6.0] < 0.24
    true_m = np.linalg.norm(np.diff(fine, axis=0), axis=1).sum()
    distance, share = point.distance, measures.MODEL_BIAS[0]
    # This noise is steady: all of the expected bias is there, not a network's share of it.
    assert distance.measured_m - distance.bias_m / share == pytest.approx(true_m, rel=0.01)
    assert abs(distance.corrected_m - true_m) < 1.645 * distance.sigma_m


def test_the_share_of_the_bias_that_is_subtracted_is_the_documented_one():
    share, sigma = measures.MODEL_BIAS
    caption = CONFIG.parent / "workflow" / "report" / "draw_kinematics.rst"
    for document in (CONFIG / "README.md", caption):
        words = " ".join(document.read_text().split())
        assert f"{share} (+- {sigma}) of the bias that the noise" in words


def test_gaps_are_missing_with_their_reason_and_not_differentiated_across():
    time_s, xyz = circling(seconds=4)
    record = footwork.record(xyz, time_s, 0.01, 0.0, np.random.default_rng(0))
    at = walker.SKELETON.index("left_shoulder")
    for frames, reason in (
        (slice(100, 130), missing_reason.ONE_VIEW),
        (slice(200, 203), missing_reason.UNSEEN),
    ):
        record.xyz[0, frames, at], record.reason[0, frames, at] = np.nan, reason
        record.covariance_2d[0, frames, at] = np.nan
    person = measured(filtering.fill_gaps(record, 0.1))
    neck = person.points["neck"]
    assert np.isnan(neck.position[100:130]).all()
    assert (neck.reason[100:130] == missing_reason.ONE_VIEW).all()
    assert (neck.reason[200:203] == missing_reason.INTERPOLATED).all()
    others = np.delete(np.arange(len(time_s)), np.arange(100, 130))
    for values in (neck.position, neck.velocity, neck.acceleration, *neck.covariance[1:]):
        assert np.isfinite(values[others]).all()
    stated = np.isfinite(neck.covariance[0]).all(axis=(1, 2))
    assert not stated[200:203].any()  # how far a filled-in place is off is not known
    assert stated[np.setdiff1d(others, np.arange(200, 203))].all()
    assert np.linalg.norm(neck.velocity[others], axis=1).max() < 4.5
    assert np.isfinite(person.angles["left_knee_flexion"].degrees).all()
    assert np.isnan(person.angles["left_elbow_flexion"].degrees[100:130]).all()


def shift(xyz):
    """Return a field that moves all places alike, by 20 mm along x."""
    return np.broadcast_to(np.array([[0.02], [0], [0]]), (len(xyz), 3, 1))


def stretch(xyz):
    """Return a field that stretches space by 1 % about its origin."""
    return 0.01 * xyz[:, :, None]


def with_field(record, field, **options):
    how = measures.Filter(CUTOFFS_HZ)
    smooth = skeleton_filter.smooth(record, how.cutoff_hz, how.order)
    return measures.measure(smooth, record, TABLE, "blazepose33", how, None, field, **options)[0]


def test_cameras_that_shift_all_places_alike_err_in_no_speed_distance_or_angle():
    time_s, xyz = circling(seconds=2)
    record = footwork.record(xyz, time_s, 0.01, 0.0, np.random.default_rng(0))
    person, without = with_field(record, shift), with_field(record, None)
    for name, point in person.points.items():
        position, velocity, acceleration = point.camera_covariance
        np.testing.assert_allclose(position[:, 0, 0], 0.02**2, rtol=1e-9)
        np.testing.assert_allclose(velocity, 0, atol=1e-12)
        np.testing.assert_allclose(acceleration, 0, atol=1e-9)
        assert point.distance.camera_sigma_m == pytest.approx(0, abs=1e-9)
        assert np.isnan(without.points[name].distance.camera_sigma_m)
    for name, angle in person.angles.items():
        np.testing.assert_allclose(angle.sigma_deg, without.angles[name].sigma_deg)


def test_cameras_that_stretch_space_err_by_the_same_share_in_speed_and_distance():
    time_s, xyz = circling(seconds=4)
    record = footwork.record(xyz, time_s, TINY_M, 0.0, np.random.default_rng(0))
    person = with_field(record, stretch)
    for point in person.points.values():
        speed, sigma = measures.size(point.velocity, point.camera_covariance[1])
        np.testing.assert_allclose(sigma, 0.01 * speed, rtol=1e-6)
        for distance in (point.distance, point.ground_distance):
            assert distance.camera_sigma_m == pytest.approx(0.01 * distance.measured_m, rel=1e-6)
    for angle in person.angles.values():
        assert angle.sigma_deg.max() < 0.01


def test_blocks_of_frames_have_no_borders(monkeypatch):
    time_s, xyz = circling(seconds=1)
    xyz[20:30] = np.nan  # a whole block without anybody
    record = footwork.record(xyz, time_s, 0.01, 0.0, np.random.default_rng(0))
    whole = with_field(record, stretch).angles
    monkeypatch.setattr(keypoints, "BLOCK", 5)
    for name, angle in with_field(record, stretch).angles.items():
        np.testing.assert_array_equal(angle.degrees, whole[name].degrees)
        np.testing.assert_array_equal(angle.sigma_deg, whole[name].sigma_deg)


def slow(rng, n_frames, rate_hz, sigma_m, memory_s):
    """Return errors (T, J, 3) as the network's: slow, and alike along arms and legs."""
    root = np.linalg.cholesky(shared_errors.alike(walker.SKELETON.joints))
    fresh = rng.normal(size=(n_frames, 3, walker.N_JOINTS)) @ root.T
    stay = np.exp(-1 / (rate_hz * memory_s))
    made = fresh.copy()
    for frame in range(1, n_frames):
        made[frame] = stay * made[frame - 1] + np.sqrt(1 - stay**2) * fresh[frame]
    return sigma_m * made.swapaxes(1, 2)


def test_errors_of_the_network_are_held_in_speeds_distances_and_angles():
    rate_hz, sigma_m, keypoints_m = 30.0, 0.02, 0.001
    time_s, xyz = circling(rate_hz=rate_hz, seconds=20.0)
    base = footwork.record(xyz, time_s, keypoints_m, 0.0, np.random.default_rng(9))
    stated = sigma_m**2 / shared_errors.NETWORK_SHARE * np.eye(3)
    base = replace(base, covariance_network=np.broadcast_to(stated, (*base.xyz.shape, 3)).copy())
    clean = with_field(replace(base, xyz=xyz[None]), None)
    inside = {"speed": [], "angle": []}
    lengths, sigmas = [], []
    for seed in range(6):
        rng = np.random.default_rng(seed)
        error = slow(rng, len(time_s), rate_hz, sigma_m, shared_errors.NETWORK.memory_s)
        person = with_field(replace(base, xyz=(xyz + error)[None]), None)
        for name, point in person.points.items():
            speed, sigma = measures.size(point.velocity, point.covariance[1])
            ideal, _ = measures.size(clean.points[name].velocity, point.covariance[1])
            inside["speed"].append(np.abs(speed - ideal) < 1.645 * sigma)
        lengths.append([point.distance.measured_m for point in person.points.values()])
        sigmas.append([point.distance.sigma_m for point in person.points.values()])
        for name, angle in person.angles.items():
            error_deg = angle.degrees - clean.angles[name].degrees
            inside["angle"].append(np.abs(error_deg) < 1.645 * angle.sigma_deg)
    shares = {name: np.mean(values) for name, values in inside.items()}
    assert all(0.85 < share < 0.96 for share in shares.values()), shares
    scatter = np.sqrt(np.mean(np.var(lengths, axis=0, ddof=1))) / np.sqrt(
        np.mean(np.square(sigmas))
    )
    assert 0.4 < scatter < 1.5, scatter


def test_a_recorded_person_s_constant_error_is_held_in_angles_and_positions_and_not_in_speeds():
    """Each joint's centre is elsewhere than the truth's, by as much in all frames."""
    time_s, xyz = circling(rate_hz=30.0, seconds=0.5)
    base = footwork.record(xyz, time_s, 0.001, 0.0, np.random.default_rng(9))
    sigma_m, rng = np.zeros(walker.N_JOINTS), np.random.default_rng(1)
    for joint in skeleton.JOINTS:
        distance_m = 0.036 if "hip" in joint else 0.025
        sigma_m[walker.SKELETON.index(joint)] = distance_m / np.sqrt(3)
    stated = np.square(sigma_m)[:, None, None] * np.eye(3)
    base = replace(base, covariance_network=np.broadcast_to(stated, (*base.xyz.shape, 3)).copy())
    clean, inside = measures.angles(base, 0), {False: [], True: []}
    root = np.linalg.cholesky(shared_errors.alike(walker.SKELETON.joints))
    for _ in range(40):
        error = sigma_m[:, None] * (root @ rng.normal(size=(walker.N_JOINTS, 3)))
        for recorded, held in inside.items():
            found = measures.angles(replace(base, xyz=base.xyz + error), 0, recorded=recorded)
            for name, one in found.items():
                held.append(np.abs(one.degrees - clean[name].degrees) < 1.645 * one.sigma_deg)
    assert np.mean(inside[False]) < 0.6
    assert 0.85 < np.mean(inside[True]) < 0.95
    points, real = (with_field(base, None, recorded=recorded).points for recorded in inside)
    neck = real["neck"].covariance[0] - points["neck"].covariance[0]
    np.testing.assert_allclose(neck[:, 0, 0], 0.9 * 0.025**2 / 3 / 2)  # the mean of two shoulders
    np.testing.assert_array_equal(real["neck"].covariance[1], points["neck"].covariance[1])


def test_a_known_offset_counts_where_it_was_not_taken_away():
    time_s, xyz = circling(seconds=2)
    record = footwork.record(xyz, time_s, TINY_M, 0.0, np.random.default_rng(0))
    offset = np.zeros_like(record.xyz)
    knee = walker.SKELETON.index("left_knee")
    offset[:, :, knee] = [0.0, 0.0, 0.03]
    stated = with_field(replace(record, offset=offset), None).angles["left_knee_flexion"]
    moved = with_field(replace(record, xyz=record.xyz + offset), None).angles["left_knee_flexion"]
    none = with_field(record, None).angles["left_knee_flexion"]
    np.testing.assert_allclose(stated.sigma_deg, abs(moved.degrees - none.degrees), atol=0.5)


def test_the_cameras_field_is_looked_up_once_per_point_and_limb_joint():
    time_s, xyz = circling(seconds=2)
    record = footwork.record(xyz, time_s, TINY_M, 0.0, np.random.default_rng(0))
    places = []

    def counted(xyz):
        places.append(len(xyz))
        return stretch(xyz)

    with_field(record, counted)
    assert sum(places) == (3 + 12) * len(time_s)


def test_a_known_offset_of_frames_that_are_left_out_does_not_count_beside_them():
    time_s, xyz = circling(seconds=2)
    xyz[50:70] = np.nan
    record = footwork.record(xyz, time_s, 0.01, 0.0, np.random.default_rng(0))
    offset = np.zeros_like(record.xyz)
    offset[:, 50:70] = [0.0, 0.0, 0.05]  # of the raw joints, which were not corrected there
    stated, none = (measured(one).points for one in (replace(record, offset=offset), record))
    for name, point in stated.items():
        np.testing.assert_array_equal(point.covariance[1], none[name].covariance[1])


def test_a_take_of_a_few_frames_and_one_without_anybody():
    time_s, xyz = circling(seconds=0.15)
    record = footwork.record(xyz, time_s, 0.01, 0.0, np.random.default_rng(0))
    neck = measured(record).points["neck"]
    assert np.isfinite(neck.velocity).all()
    assert neck.distance.seconds == pytest.approx(0.15)
    empty = replace(
        record,
        xyz=np.full_like(record.xyz, np.nan),
        covariance_2d=np.full_like(record.covariance_2d, np.nan),
        reason=np.full_like(record.reason, missing_reason.UNSEEN),
    )
    person = measured(empty)
    assert np.isnan(person.points["mass"].velocity).all()
    assert (person.points["mass"].reason == missing_reason.UNSEEN).all()
    assert person.points["mass"].distance.seconds == 0


def test_two_people_are_measured_as_each_alone():
    time_s, xyz = circling(seconds=3)
    one = footwork.record(xyz, time_s, 0.01, 0.0, np.random.default_rng(0))
    other = footwork.record(xyz + 1.0, time_s, 0.01, 0.05, np.random.default_rng(1))
    names = [f for f in vars(one) if f not in ("cameras", "model", "joints", "person_id", "time_s")]
    both = replace(
        one,
        person_id=np.array(["p1", "p2"]),
        **{name: np.concatenate([getattr(one, name), getattr(other, name)]) for name in names},
    )
    how = measures.Filter(CUTOFFS_HZ)
    people = of_raw(both, how, {"p1": "m", "p2": "m"})
    assert [person.person for person in people] == ["p1", "p2"]
    np.testing.assert_allclose(
        people[1].points["mass"].velocity, measured(other).points["mass"].velocity, atol=1e-9
    )


@cache
def smoothed(apart_deg, memory_s, seed):
    """Return a record of footwork and its smooth skeletons; without a seed, of exact places."""
    time_s, neck = footwork.neck(30.0, 20, seed=21)
    xyz, _ = footwork.body(neck, time_s)
    sigma_m = footwork.cameras(apart_deg)[1]
    record = footwork.record(xyz, time_s, sigma_m, memory_s, np.random.default_rng(seed or 0))
    if seed is None:
        record = replace(record, xyz=xyz[None].copy())
    return record, skeleton_filter.smooth(record, CUTOFFS_HZ, measures.Filter(CUTOFFS_HZ).order)


@pytest.mark.parametrize(
    ("model", "apart_deg", "memory_s", "most"),
    [
        *((model, 90, 0.0, 1.05) for model in NETWORKS_WITH_OFFSETS),
        *((model, 150, 0.0, 1.1) for model in NETWORKS_WITH_OFFSETS),
        (NETWORKS_WITH_OFFSETS[0], 90, 0.08, 1.05),  # errors that last are no matter of the table
    ],
)
def test_noise_of_corrected_skeletons_is_at_most_what_is_stated(model, apart_deg, memory_s, most):
    offsets = joint_correction.read(CONFIG / "joint_offsets" / f"{model}.csv")
    how, cameras = measures.Filter(CUTOFFS_HZ), footwork.cameras(apart_deg)[0]

    def corrected(seed):
        record, smooth = smoothed(apart_deg, memory_s, seed)
        last = joint_correction.correct_then_filter(
            record, smooth, offsets, {"p1": "m"}, how.cutoff_hz, how.order, cameras
        )
        return measures.measure(last, record, TABLE, "blazepose33", how, {"p1": "m"})[0].points

    clean = corrected(None)
    ratios = {}
    for seed in range(4):
        for name, point in corrected(seed).items():
            for at, key in ((1, "velocity"), (2, "acceleration")):
                off = np.var(getattr(point, key) - getattr(clean[name], key), axis=0).sum()
                stated = np.trace(point.covariance[at], axis1=1, axis2=2).mean()
                ratios.setdefault((name, key), []).append(off / stated)
    # Limbs of constant length and offsets along the trunk take a little of the noise away.
    found = {key: np.sqrt(np.mean(values)) for key, values in ratios.items()}
    assert all(0.8 < ratio < most for ratio in found.values()), found


def test_nothing_is_filtered_again():
    time_s, xyz = circling(rate_hz=30.0)
    record = footwork.record(xyz, time_s, 0.015, 0.05, np.random.default_rng(0))
    smooth = skeleton_filter.smooth(record, CUTOFFS_HZ, 4)
    point = measured(record).points["neck"]
    shoulders = [walker.SKELETON.index(f"{side}_shoulder") for side in ("left", "right")]
    np.testing.assert_allclose(point.position, smooth.xyz[0][:, shoulders].mean(axis=1))
    speed = np.linalg.norm(point.velocity, axis=1)
    integral = np.sum((speed[1:] + speed[:-1]) / 2) / 30.0
    assert point.distance.measured_m == pytest.approx(integral)
