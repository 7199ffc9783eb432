import time
from dataclasses import replace

import numpy as np
import pytest

from courtside.body_model import fit, pose, segments
from fixtures.people import moving_model

MODEL = segments.model()
HZ = np.full(len(MODEL.sigma), 8.0)
HOW = moving_model.RATE_HZ, 6, None  # rate, most steps, no feet held


def data(points, sigma_m=0.002):
    stated = np.broadcast_to(sigma_m**2 * np.eye(3), (*points.xyz[0].shape, 3)).copy()
    return fit.Data(points.xyz[0], np.linalg.inv(stated), stated)


def shaken(true, by=0.1):
    rng = np.random.default_rng(1)
    return pose.moved(MODEL, true, by * rng.standard_normal((len(true.root), len(MODEL.sigma))))


def test_exact_joints_are_fitted_from_a_wrong_start():
    true = moving_model.moving()
    points = moving_model.points(true)
    found = fit.fit(MODEL, moving_model.body(), data(points), shaken(true), HZ, *HOW)
    for name, within_deg in (("left_tibia", 1.0), ("right_forearm", 2.0)):
        at = moving_model.column(name)
        error = np.degrees(found.angle[:, at] - true.angle[:, at])
        assert np.sqrt(np.mean(error**2)) < within_deg


def test_the_stated_covariance_holds_the_errors_of_noise():
    true = moving_model.moving(90)
    one, body = data(moving_model.points(true, noise_m=0.02), 0.02), moving_model.body()
    found = fit.fit(MODEL, body, one, true, 4 * HZ, *HOW)
    spread = fit.spread(MODEL, body, one, found)
    at = [moving_model.column(f"{side}_tibia") for side in ("left", "right")]
    error = found.angle[:, at] - true.angle[:, at]
    sigma = np.sqrt(np.diagonal(spread.total, axis1=1, axis2=2)[:, at])
    assert np.degrees(np.median(sigma)) > 1
    assert 0.8 < np.mean(np.abs(error) < 1.645 * sigma) <= 1
    assert (spread.noise[:, at, at] <= spread.total[:, at, at] + 1e-12).all()


def test_wrong_lengths_are_mended_by_what_all_frames_say():
    true = moving_model.moving()
    one, body = data(moving_model.points(true)), moving_model.body()
    at = moving_model.NAMES.index("left_tibia")
    wrong = replace(body, offsets=body.offsets + 0.02 * body.by_length[0])  # of both thighs
    found = fit.fit(MODEL, wrong, one, true, HZ, *HOW)
    mended = fit.lengthened(MODEL, wrong, one, found, moving_model.RATE_HZ)
    assert abs(wrong.offsets[at, 1] - body.offsets[at, 1]) > 0.019
    assert abs(mended.offsets[at, 1] - body.offsets[at, 1]) < 0.004


def test_a_second_says_the_same_of_lengths_at_any_rate():
    true = moving_model.moving(30)
    one, body = data(moving_model.points(true), 0.05), moving_model.body()
    twice = fit.Data(*(np.repeat(part, 2, 0) for part in (one.xyz, one.information, one.noise)))
    slow = pose.Pose(
        np.repeat(true.root, 2, 0), np.repeat(true.local, 2, 1), np.repeat(true.angle, 2, 0)
    )
    wrong = replace(body, offsets=body.offsets + 0.02 * body.by_length[0])
    found = [
        fit.lengthened(MODEL, wrong, *how).offsets
        for how in ((one, true, moving_model.RATE_HZ), (twice, slow, 2 * moving_model.RATE_HZ))
    ]
    np.testing.assert_allclose(found[1], found[0], atol=1e-9)
    assert np.abs(found[0] - wrong.offsets).max() > 0.001


def test_the_weight_of_second_differences_passes_half_the_power_at_the_cut_off():
    rate_hz, n_frames = 50.0, 400
    normal = np.tile(4.0 * np.eye(1), (n_frames, 1, 1))
    weight = fit.stiffness(normal, np.array([6.0]), rate_hz, np.array([np.inf]))
    second = np.diff(np.eye(n_frames), 2, axis=0)
    wave = np.sin(2 * np.pi * 6 * np.arange(n_frames) / rate_hz)
    passed = np.linalg.solve(4 * np.eye(n_frames) + weight * second.T @ second, 4 * wave)
    assert np.std(passed[100:300]) / np.std(wave[100:300]) == pytest.approx(2**-0.5, abs=0.01)


def test_who_is_away_for_most_of_a_take_is_smoothed_as_ever():
    true, body = moving_model.moving(120), moving_model.body()
    one = data(moving_model.points(true, noise_m=0.015), 0.015)
    information = one.information.copy()
    information[35:105] = 0.0  # 58 % of the frames
    shaken = []
    for said in (one.information, information):
        found = fit.fit(MODEL, body, replace(one, information=said), true, HZ, *HOW)
        error = np.c_[found.root, found.angle[:, 3:]] - np.c_[true.root, true.angle[:, 3:]]
        shaken.append(np.std(np.diff(error[:30], 2, axis=0), axis=0))
    knee = moving_model.column("left_tibia")
    np.testing.assert_allclose(shaken[1][[0, 1, 2, knee]], shaken[0][[0, 1, 2, knee]], rtol=0.15)


def test_a_knee_does_not_bend_backwards_and_a_lost_limb_is_uncertain():
    true = moving_model.moving()
    body, points = moving_model.body(), moving_model.points(true)
    one = data(points)
    lost = [moving_model.JOINTS.index(f"left_{part}") for part in ("elbow", "wrist")]
    information = one.information.copy()
    information[20:40, lost] = 0.0
    one = replace(one, information=information)
    found = fit.fit(MODEL, body, one, true, HZ, *HOW)
    spread = fit.spread(MODEL, body, one, found)
    elbow = moving_model.column("left_forearm")
    sigma = np.degrees(np.sqrt(spread.total[:, elbow, elbow]))
    assert sigma[30] > 60 > 5 > sigma[10]
    assert np.isfinite(found.angle).all()


def test_clavicles_that_nothing_shows_rise_with_the_arms():
    """Unseen arms are held out by their prior, at 90 degrees and what the clavicles add to them."""
    true, body = moving_model.moving(3), moving_model.body()
    none = data(moving_model.points(true))
    none = replace(none, information=np.zeros_like(none.information))
    found = fit.fit(MODEL, body, none, true, HZ, moving_model.RATE_HZ, 20, None)
    for side, sign in (("left", 1), ("right", -1)):
        lift = np.degrees(found.angle[:, moving_model.column(f"{side}_clavicle")])
        np.testing.assert_allclose(lift, sign * (90 + 18) / 6, atol=0.5)


def test_clavicles_of_raised_arms_keep_the_range_of_the_joint():
    """Arms overhead let clavicles rise by about 27 degrees: at 0 they are still in their range."""
    true, raise_ = moving_model.moving(3), np.zeros((3, len(MODEL.sigma)))
    at = [moving_model.column(f"{side}_clavicle") for side in ("left", "right")]
    for sign, side in ((1, "left"), (-1, "right")):
        raise_[:, moving_model.column(f"{side}_humerus")] = sign * (0.8 + 1.3)
    up, one = pose.moved(MODEL, true, raise_), data(moving_model.points(true))
    none = replace(one, information=np.zeros_like(one.information))
    spread = fit.spread(MODEL, moving_model.body(), none, up)
    sigma = np.degrees(np.sqrt(np.diagonal(spread.total, axis1=1, axis2=2)[:, at]))
    np.testing.assert_allclose(sigma, segments.LIMBS["clavicle"].coordinates[0].sigma_deg)


def test_time_grows_linearly_with_frames():
    def seconds(n_frames):
        true = moving_model.moving(n_frames)
        points, before = moving_model.points(true), time.process_time()
        fit.fit(MODEL, moving_model.body(), data(points), true, HZ, *HOW)
        return time.process_time() - before

    seconds(30)
    assert seconds(600) < 4 * 3 * seconds(150)
