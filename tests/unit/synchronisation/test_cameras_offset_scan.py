"""Placing cameras by loss curves: the lowest, the doubtful, the one that nobody sees."""

import numpy as np

from courtside.synchronisation import cameras

STEP_S = 0.1


def curves(true_s, depth, rng, count=100, also_s=()):
    """Return a function that makes the loss of a camera at each offset, lowest at its true one."""

    def scan(a, b, lags_s):
        loss = 1 + 0.3 * rng.normal(0, 1, (count, len(lags_s)))
        for at in (true_s[b] - true_s[a], *(np.add(also_s, true_s[b] - true_s[a]))):
            loss -= depth[b] * np.exp(-0.5 * ((lags_s - at) / 0.1) ** 2)
        return loss

    return scan


def test_all_cameras_are_placed_surest_first():
    true_s, depth = [0.0, 1.3, -2.4, 0.8], [0, 0.3, 0.9, 0.6]
    placed = cameras.place(curves(true_s, depth, np.random.default_rng(0)), 4, 4.0, STEP_S)
    assert list(placed)[:3] == [0, 2, 3]
    for camera, at in placed.items():
        assert abs(at.offset_s - true_s[camera]) <= STEP_S
        assert at.candidates_s == ()
    assert placed[1].through == (0, 2, 3)


def test_two_equal_minima_are_both_told():
    scan = curves([0.0, 0.5], [0, 0.9], np.random.default_rng(1), also_s=(2.0,))
    at = cameras.place(scan, 2, 4.0, STEP_S)[1]
    found = sorted([at.offset_s, *at.candidates_s])
    np.testing.assert_allclose(found, [0.5, 2.5], atol=STEP_S)


def test_a_doubtful_camera_places_no_other():
    true_s, depth = [0.0, 1.0, 2.0], [0, 0.0, 0.8]
    placed = cameras.place(curves(true_s, depth, np.random.default_rng(2)), 3, 4.0, STEP_S)
    assert len(placed[1].candidates_s) == cameras.MOST_CANDIDATES
    assert placed[2].through == (0,)


def test_what_does_not_overlap_is_not_placed():
    def scan(a, b, lags_s):
        return np.full((50, len(lags_s)), np.nan)

    assert list(cameras.place(scan, 2, 1.0, STEP_S)) == [0]


def test_a_little_overlap_does_not_win_by_chance():
    rng = np.random.default_rng(3)
    loss = 1 + 0.3 * rng.normal(0, 1, (100, 81))
    loss[:, 40] -= 0.5
    loss[20:, 0] = np.nan
    loss[:20, 0] = 0.45  # lower than the mean at 40, over a fifth of the times
    found = cameras.choose(np.arange(-40, 41) * STEP_S, {0: loss})
    assert found.offset_s == 0.0


def test_minima_keep_their_distance():
    curve = np.array([3, 1, 2, 0, 4, 5, 2, 6.0])
    assert cameras.minima(curve, 1) == [3, 1, 6]
    assert cameras.minima(curve, 2) == [3, 6]
