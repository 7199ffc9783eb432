"""The mixture of good places and outliers: its fit, what it states, its file."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import scipy

from courtside.reconstruction import error_signs, joint_errors
from courtside.records.keypoints import keypoints
from courtside.records.keypoints.skeleton import JOINTS
from courtside.study.errors import InputError
from fixtures.people import walker

COUNT = len(joint_errors.SIGNS)
KEYPOINTS = np.diag([1e-4, 4e-4, 2e-4])


def drawn(n, seed):
    """Return columns, errors, covariance and whether each is an outlier, of a known mixture."""
    rng = np.random.default_rng(seed)
    columns = np.column_stack([np.ones(n), np.zeros((n, 5)), rng.normal(size=(n, COUNT - 6))])
    share = 1 / (1 + np.exp(3 - 2 * columns[:, 8]))
    wrong = rng.random(n) < share
    sigma_m = np.where(wrong, 0.15, 0.02 * np.exp(0.5 * columns[:, 10]))
    error = rng.multivariate_normal(np.zeros(3), KEYPOINTS, n)
    error += sigma_m[:, None] * rng.normal(size=(n, 3))
    return columns, error, np.broadcast_to(KEYPOINTS, (n, 3, 3)), wrong


def fitted(n=20000):
    columns, error, covariance, _ = drawn(n, seed=0)
    return joint_errors.fit(columns, error, covariance, np.ones(n))


def test_the_fit_finds_the_mixture_that_errors_were_drawn_from():
    model = fitted()
    assert model.sigma_m == pytest.approx(0.15, rel=0.05)
    columns, _, _, wrong = drawn(5000, seed=1)
    good, share = model.of(columns)
    np.testing.assert_allclose(np.sqrt(good[:20]), 0.02 * np.exp(0.5 * columns[:20, 10]), rtol=0.1)
    assert share.mean() == pytest.approx(wrong.mean(), abs=0.01)
    sure = share > 0.5
    assert wrong[sure].mean() == pytest.approx(share[sure].mean(), abs=0.05)


def test_the_gradient_of_the_loss_is_its_slope():
    columns, error, covariance, _ = drawn(300, seed=2)
    own, axes = np.linalg.eigh(covariance)
    squares = np.einsum("nij,ni->nj", axes, error) ** 2
    given = columns, own, squares, np.full(300, 1 / 300)
    at = np.random.default_rng(3).normal(0, 0.1, 2 * COUNT + 1)
    at[[0, COUNT, -1]] = np.log(0.03), -2, np.log(0.1)
    _, gradient = joint_errors._loss(at, *given)
    steps = 1e-6 * np.eye(len(at))
    slopes = [
        (joint_errors._loss(at + step, *given)[0] - joint_errors._loss(at - step, *given)[0]) / 2e-6
        for step in steps
    ]
    np.testing.assert_allclose(gradient, slopes, atol=1e-6)


def test_limbs_joints_are_stated_and_others_stay_unknown(monkeypatch):
    monkeypatch.setattr(keypoints, "BLOCK", 3)
    record, model = walker.points(n_frames=8), fitted(4000)
    rng = np.random.default_rng(4)
    shape = record.xyz.shape[:-1]
    signs = {name: rng.normal(size=shape) for name in error_signs.NAMES}
    found = joint_errors.state(record, model, signs)
    at = [list(record.joints).index(joint) for joint in JOINTS]
    rest = np.delete(np.arange(walker.N_JOINTS), at)
    assert np.isnan(found.outlier[:, :, rest]).all()
    stated = np.isfinite(record.covariance_2d[:, :, at]).all(axis=(-2, -1))
    np.testing.assert_array_equal(np.isfinite(found.outlier[:, :, at]), stated)
    good, share = model.of(joint_errors.design(signs, list(record.joints)))
    variance = joint_errors.stated_variance(good, share, model.sigma_m**2)
    expected = np.where(stated, variance, np.nan)[..., None, None] * np.eye(3)
    np.testing.assert_allclose(found.covariance_network[:, :, at], expected)
    np.testing.assert_array_equal(found.xyz, record.xyz)


def test_beyond_the_stated_distance_are_few_errors_of_the_mixture():
    good = np.array([1e-6, 2e-5, 4e-4, 1e-2])[:, None]
    share, outlier = np.array([0.0, 1e-3, 0.01, 0.02, 0.1, 0.5, 0.9, 1.0]), 0.08
    variance = joint_errors.stated_variance(good, share, outlier)
    rest = 1 - joint_errors.SHARE_HELD
    beyond = scipy.stats.chi2(3).ppf(joint_errors.SHARE_HELD) * variance
    tails = (scipy.stats.chi2(3).sf(beyond / v) for v in (good, outlier))
    tail = (1 - share) * next(tails) + share * next(tails)
    assert (tail >= 0.999 * rest).all() and (tail <= 2 * rest).all()
    np.testing.assert_allclose(variance[:, [0, -1]], np.hstack([good, np.full((4, 1), outlier)]))


def test_recorded_people_have_the_published_difference_of_two_systems_on_top():
    record, model = walker.points(n_frames=8), fitted(4000)
    signs = {name: np.zeros(record.xyz.shape[:-1]) for name in error_signs.NAMES}
    virtual = joint_errors.state(record, model, signs)
    real = joint_errors.state(record, model, signs, recorded=True)
    more = real.covariance_network - virtual.covariance_network
    for joint in JOINTS:
        of_joint = more[:, :, list(record.joints).index(joint)]
        distance_m = np.sqrt(np.trace(of_joint, axis1=-2, axis2=-1))
        np.testing.assert_allclose(
            distance_m[np.isfinite(distance_m)], 0.036 if "hip" in joint else 0.025
        )
    stated = np.isfinite(virtual.outlier)
    assert stated.any() and (real.outlier[stated] > virtual.outlier[stated]).all()


def test_the_probability_of_an_outlier_is_the_share_of_large_errors():
    n, model = 3000, fitted()
    columns, error, _, _ = drawn(12 * n, seed=5)
    record = walker.points(n_frames=n)
    at = [list(record.joints).index(joint) for joint in JOINTS]
    signs = {name: np.zeros(record.xyz.shape[:-1]) for name in error_signs.NAMES}
    for name, column in zip(error_signs.NAMES, columns[:, 6:].T, strict=True):
        signs[name][0][:, at] = column.reshape(12, n).T
    record.covariance_2d[:] = KEYPOINTS
    model.good[1:6], model.outlier[1:6] = 0, 0  # the same for all joints, as drawn
    found = joint_errors.state(record, model, signs).outlier[0][:, at].T.ravel()
    large = np.linalg.norm(error, axis=1) > joint_errors.OUTLIER_M
    for low, high in ((0.0, 0.1), (0.1, 0.4), (0.4, 0.8)):
        these = (found >= low) & (found < high)
        assert large[these].mean() == pytest.approx(found[these].mean(), abs=0.04)


def test_a_model_is_read_as_it_was_written(tmp_path):
    model = fitted(2000)
    joint_errors.table(model).to_csv(tmp_path / "m.csv", index=False)
    again = joint_errors.read(tmp_path / "m.csv")
    for name in ("mean", "spread", "good", "outlier", "sigma_m"):
        np.testing.assert_allclose(getattr(again, name), getattr(model, name))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda rows: rows.drop(columns="good"), "expected columns"),
        (lambda rows: rows.iloc[::-1], "expected columns .* for the signs"),
        (lambda rows: rows.assign(outlier=np.nan), "with numbers"),
        (lambda rows: rows.assign(spread=0.0), "spreads and sigma_m above 0"),
    ],
)
def test_another_table_is_refused_in_one_line(tmp_path, change, words):
    change(joint_errors.table(fitted(1000))).to_csv(tmp_path / "m.csv", index=False)
    with pytest.raises(InputError, match=words) as caught:
        joint_errors.read(tmp_path / "m.csv")
    assert "\n" not in str(caught.value) and "evaluate_joint_errors" in str(caught.value)


def test_too_few_joints_are_refused():
    columns, error, covariance, _ = drawn(2 * COUNT - 1, seed=6)
    with pytest.raises(ValueError, match=f"at least {2 * COUNT} joints, found {2 * COUNT - 1}"):
        joint_errors.fit(columns, error, covariance, np.ones(len(columns)))


def test_the_table_of_the_configuration_is_one():
    path = Path(__file__).parents[3] / "config" / "joint_errors" / "blazepose-full.csv"
    model = joint_errors.read(path)
    assert 0.1 < model.sigma_m < 0.4
    assert pd.read_csv(path, comment="#")["spread"].gt(0).all()
