from dataclasses import replace

import numpy as np
import pytest

from courtside.body_model import fit, held, pose, segments
from fixtures.people import moving_model

MODEL, BODY = segments.model(), moving_model.body()
HZ = np.full(len(MODEL.sigma), 8.0)
FEET = [
    moving_model.JOINTS.index(f"{s}_{p}") for s in ("left", "right") for p in ("heel", "foot_index")
]


def standing(n_frames):
    """Return poses that stand still on the floor, and the heights (2, 2) m of heels and toes."""
    one = moving_model.moving(1)
    still = pose.Pose(
        np.repeat(one.root, n_frames, 0),
        np.repeat(one.local, n_frames, 1),
        np.repeat(one.angle, n_frames, 0),
    )
    return still, moving_model.points(still).xyz[0, 0, FEET, 2].reshape(2, 2)


def of_noise(points):
    stated = points.covariance_2d[0]
    return fit.Data(points.xyz[0], np.linalg.inv(stated), stated)


def test_a_foot_that_stands_keeps_its_place_and_one_that_swings_does_not():
    true, floor = standing(40)
    data = of_noise(moving_model.points(true, noise_m=0.015))
    stands = np.zeros((40, 2, 2))
    stands[:, 0] = 1.0  # the left foot
    tie = held.of_contacts(moving_model.JOINTS, stands, floor, moving_model.RATE_HZ)
    assert tie is not None and tie.points.tolist() == FEET
    spread = []
    for one in (None, tie):
        found = fit.fit(MODEL, BODY, data, true, HZ, moving_model.RATE_HZ, 6, one)
        xyz, _ = fit.derivatives(MODEL, BODY, found)
        spread.append(xyz[:, FEET].std(axis=0).max(axis=1))
        error = np.linalg.norm(
            xyz[:, FEET[:2]].mean(axis=0) - moving_model.points(true).xyz[0, 0, FEET[:2]], axis=1
        )
    assert spread[1][:2].max() < 0.4 * spread[0][:2].min()
    assert spread[1][2:].min() > 0.8 * spread[0][2:].min()
    assert error.max() < 0.006


def test_a_foot_may_turn_about_the_toe_that_stands():
    """Heels rise by 0.4 rad about toes that stay: the fit follows the heel, not the held toe."""
    true, floor = standing(30)
    toe = BODY.places[FEET[1]]
    turn = np.linspace(0, 0.4, 30)
    angle, root = true.angle.copy(), true.root.copy()
    at = moving_model.column("left_foot")
    angle[:, at] -= turn
    raised = pose.Pose(root, pose.hinged(MODEL, angle, true.local), angle)
    moved = moving_model.points(raised).xyz[0][:, FEET[1]]
    raised = replace(raised, root=root + moved[0] - moved)
    stands = np.zeros((30, 2, 2))
    stands[:, 0, 1] = 1.0
    tie = held.of_contacts(moving_model.JOINTS, stands, floor, moving_model.RATE_HZ)
    points = moving_model.points(raised)
    found = fit.fit(MODEL, BODY, of_noise(points), true, HZ, moving_model.RATE_HZ, 6, tie)
    xyz, _ = fit.derivatives(MODEL, BODY, found)
    assert np.ptp(xyz[:, FEET[1]], axis=0).max() < 0.002
    rise = np.ptp(points.xyz[0][:, FEET[0], 2])
    assert rise > 0.05 and toe[0] > 0
    assert np.ptp(xyz[:, FEET[0], 2]) == pytest.approx(rise, abs=0.005)


def test_the_normal_equations_are_those_of_all_frames_together():
    true, floor = standing(4)
    rng = np.random.default_rng(3)
    moved = pose.moved(MODEL, true, 0.1 * rng.standard_normal((4, len(MODEL.sigma))))
    stands = rng.uniform(0.2, 1, (4, 2, 2))
    tie = held.of_contacts(moving_model.JOINTS, stands, floor, moving_model.RATE_HZ)
    normal, right, below = held.linearised(MODEL, BODY, tie, *held.placed(MODEL, BODY, tie, moved))
    xyz, by = fit.derivatives(MODEL, BODY, moved)
    size, n_free = len(MODEL.sigma), 4 * len(MODEL.sigma)
    whole, pull = np.zeros((n_free, n_free)), np.zeros(n_free)
    for t, h, axis in np.ndindex(3, 4, 3):
        row = np.zeros((4, size))
        row[t + 1], row[t] = by[t + 1, FEET[h], axis], -by[t, FEET[h], axis]
        whole += tie.between[t, h] * np.outer(row.ravel(), row.ravel())
        pull -= tie.between[t, h] * (xyz[t + 1] - xyz[t])[FEET[h], axis] * row.ravel()
    for t, h in np.ndindex(4, 4):
        row = np.zeros((4, size))
        row[t] = by[t, FEET[h], 2]
        whole += tie.floor[t, h] * np.outer(row.ravel(), row.ravel())
        pull += tie.floor[t, h] * (tie.height[h] - xyz[t, FEET[h], 2]) * row.ravel()
    blocks = whole.reshape(4, size, 4, size)
    for t in range(4):
        np.testing.assert_allclose(normal[t], blocks[t, :, t], atol=1e-6)
    for t in range(3):
        np.testing.assert_allclose(below[t], blocks[t + 1, :, t], atol=1e-6)
    np.testing.assert_allclose(right.ravel(), pull, atol=1e-6)


def test_without_heels_or_contacts_nothing_is_held():
    floor, stands = np.zeros((2, 2)), np.full((5, 2, 2), np.nan)
    assert held.of_contacts(("left_ankle", "right_ankle"), stands, floor, 30.0) is None
    tie = held.of_contacts(moving_model.JOINTS, stands, floor, 30.0)
    assert tie is not None and not tie.between.any() and not tie.floor.any()


def test_a_foot_that_runs_is_not_held_though_contacts_say_so_and_one_that_trembles_is():
    true, floor = standing(40)
    run = np.zeros((40, 3))
    run[20:, 0] = 4.0 * np.arange(20) / moving_model.RATE_HZ  # m: stands, then runs at 4 m/s
    path = replace(true, root=true.root + run)
    stands = np.full((40, 2, 2), 0.95)
    tie = held.of_contacts(moving_model.JOINTS, stands, floor, moving_model.RATE_HZ)
    shaken = replace(path, root=path.root + np.random.default_rng(0).normal(0, 0.003, (40, 3)))
    less = held.doubted(tie, held.placed(MODEL, BODY, tie, shaken)[2])
    assert (less.between[:20] > 0.9 * tie.between[:20]).all()
    assert (less.between[20:] < 0.01 * tie.between[20:]).all()
    assert (less.floor[21:] < 0.01 * tie.floor[21:]).all()
    assert (less.between <= tie.between).all() and (less.floor <= tie.floor).all()
    data = of_noise(moving_model.points(path, noise_m=0.005))
    moves = []
    for one in (None, tie):
        found = fit.fit(MODEL, BODY, data, path, HZ, moving_model.RATE_HZ, 6, one)
        xyz, _ = fit.derivatives(MODEL, BODY, found)
        moves.append(xyz[2:16, FEET].std(axis=0).mean())
    error = (xyz - moving_model.points(path).xyz[0])[:, FEET]
    assert np.linalg.norm(error[24:-4], axis=2).mean() < 0.01
    assert moves[1] < 0.7 * moves[0]
