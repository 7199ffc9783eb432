"""Bridging images: blur and standing still are seen, the chosen are even, sharp, and enough."""

from itertools import combinations

import cv2
import numpy as np
import pandas as pd
import pytest

from courtside.sfm import bridging
from courtside.study.errors import InputError

G = 150


def scene(seed=0, size=(400, 260), sigma=3):
    noise = np.random.default_rng(seed).normal(0, 1, size[::-1])
    smooth = cv2.GaussianBlur(noise, (0, 0), sigma)
    return 120 + 40 * smooth / smooth.std()


def walk(shifts_px, blurs_px=None, noise=1.0, seed=0):
    """Return the table and small pictures of a camera that sees the scene pass by."""
    images, rng = [], np.random.default_rng(seed)
    for shift_px, blur_px in zip(shifts_px, blurs_px or [0] * len(shifts_px), strict=True):
        matrix = np.array([[1, 0, -shift_px - 20], [0, 1, -20.0]])
        image = cv2.warpAffine(scene(), matrix, (320, 180), flags=cv2.INTER_CUBIC)
        if blur_px:
            image = cv2.GaussianBlur(image, (0, 0), blur_px)
        images.append(np.clip(image + rng.normal(0, noise, image.shape), 0, 255).astype(np.uint8))
    sharpness = [cv2.Laplacian(image, cv2.CV_64F).var() for image in images]
    return pd.DataFrame({"sharpness": sharpness}), images


def test_blurred_frames_are_found():
    blurs = [0] * 20
    blurs[5] = blurs[12] = blurs[13] = 4
    table, images = walk(np.arange(20) * 2.0, blurs, noise=0.3)
    kept, why = bridging.judge(table, images)
    assert [at for at in range(20) if why[at] == "blurred"] == [5, 12, 13]
    np.testing.assert_array_equal(kept, why == "")


def test_sharpness_is_compared_with_neighbours_not_with_the_whole_walk():
    table, images = walk(np.arange(60) * 1.0)
    falling = table.assign(sharpness=np.geomspace(1000, 20, 60))
    assert bridging.judge(falling, images)[0].all()
    falling.loc[30, "sharpness"] *= 0.5
    kept, why = bridging.judge(falling, images)
    assert np.flatnonzero(~kept).tolist() == [30] and why[30] == "blurred"


@pytest.mark.parametrize("noise", [0.5, 3.0])
def test_of_a_walker_who_stands_still_one_frame_is_kept(noise):
    shifts = [0, 2, 4, 4, 4.02, 3.98, 4, 6, 8, 8, 10]
    kept, why = bridging.judge(*walk(shifts, noise=noise))
    assert np.flatnonzero(why == "duplicate").tolist() == [3, 4, 5, 6, 9]
    np.testing.assert_array_equal(kept, why == "")


def test_slow_walking_adds_up():
    """Each step is below the limit of 0.16 px, but frames are compared with the last kept one."""
    kept, _ = bridging.judge(*walk(np.arange(13) * 0.08, noise=0.5))
    assert kept[0] and 3 <= kept.sum() <= 6


def test_dark_frames_are_found_before_anything_else():
    table, images = walk(np.arange(10) * 2.0)
    for at in (3, 4):
        images[at] = np.full_like(images[at], 6)
        table.loc[at, "sharpness"] = 0.0
    kept, why = bridging.judge(table, images)
    assert why.tolist() == ["", "", "", "dark", "dark", "", "", "", "", ""]
    assert kept.sum() == 8


def test_pictures_without_texture_are_no_duplicates():
    rng = np.random.default_rng(0)
    flat = [np.clip(90 + rng.normal(0, 0.5, (180, 320)), 0, 255).astype(np.uint8) for _ in range(3)]
    assert bridging.motion_px(flat[0], flat[1]) == np.inf
    assert bridging.judge(pd.DataFrame({"sharpness": [1.0] * 3}), flat)[0].all()


@pytest.mark.parametrize("noise", [0.3, 2.0])
@pytest.mark.parametrize("shift_px", [0.1, 0.3, 0.6, 1.0])
def test_small_motions_are_measured(shift_px, noise):
    """The scene has equal slopes along both axes, as the estimate assumes."""
    _, (image, other) = walk([0.0, shift_px], noise=noise)
    assert 0.75 * shift_px - 0.05 < bridging.motion_px(image, other) < 1.25 * shift_px + 0.05


def test_people_do_not_count_as_motion():
    _, (image, other) = walk([0.0, 0.0])
    other[60:180, 40:120] = scene(7)[60:180, 40:120]
    assert bridging.motion_px(image, other) < 0.1


def test_judge_wants_one_picture_per_row_and_one_size():
    table, images = walk([0.0, 1.0])
    with pytest.raises(ValueError, match="3 rows, 2 images"):
        bridging.judge(pd.DataFrame({"sharpness": [1.0] * 3}), images)
    with pytest.raises(ValueError, match="shapes"):
        bridging.judge(table, [images[0], images[1][:90]])
    with pytest.raises(ValueError, match="one size"):
        bridging.motion_px(images[0][:5], images[1][:5])


@pytest.mark.parametrize("offset_idx", [0, 1, 2])
def test_images_are_even_and_on_multiples_of_a_power_of_two(offset_idx):
    for n in range(5, G + 1):
        chosen = bridging.choose(np.arange(G), G, n, offset_idx, np.ones(G))
        spacing = (G - 1) / (n - 1)
        q = max([1] + [2**k for k in range(8) if 2**k <= 0.4 * spacing])
        assert len(chosen) == n and np.all(np.diff(chosen) > 0) and np.all(chosen % q == 0)
        assert np.diff(chosen[:-1]).max() < spacing + 1.01 * q
        assert chosen[0] < spacing and chosen[-1] > G - 1 - spacing


def test_offsets_give_other_images():
    sets = [set(bridging.choose(np.arange(G), G, 20, o, np.ones(G)).tolist()) for o in (0, 1, 2)]
    for one, other in combinations(sets, 2):
        assert len(one & other) <= 2  # the ends meet


def test_a_clearly_sharper_neighbour_wins_and_a_slightly_sharper_one_does_not():
    sharpness = np.full(G, 100.0)
    plain = bridging.choose(np.arange(G), G, 20, 0, sharpness)
    q, at = 2, plain[7]
    sharpness[at + q] = 120.0
    np.testing.assert_array_equal(bridging.choose(np.arange(G), G, 20, 0, sharpness), plain)
    sharpness[at + q] = 130.0
    found = bridging.choose(np.arange(G), G, 20, 0, sharpness)
    assert found[7] == at + q
    np.testing.assert_array_equal(np.delete(found, 7), np.delete(plain, 7))


def test_unusable_frames_are_never_chosen():
    rng = np.random.default_rng(0)
    for n in (5, 10, 20, 40, 75, 100):
        kept_idx = np.flatnonzero(rng.random(G) > 0.2)
        chosen = bridging.choose(kept_idx, G, n, 1, rng.uniform(50, 150, G))
        assert set(chosen.tolist()) <= set(kept_idx.tolist())
        assert len(chosen) == n and np.all(np.diff(chosen) > 0)


def test_all_usable_frames_are_taken_when_all_are_wanted():
    kept_idx = np.flatnonzero(np.arange(G) % 3)
    for rule in ("even", "interval"):
        found = bridging.choose(kept_idx, G, len(kept_idx), 0, np.ones(G), rule)
        np.testing.assert_array_equal(found, kept_idx)


@pytest.mark.parametrize("seed", range(3))
def test_places_are_settled_at_the_least_cost(seed):
    """Against every choice of three places of thirteen."""
    rng = np.random.default_rng(seed)
    costs = rng.uniform(0, 100, (3, 13))
    costs[:, rng.integers(0, 13, 3)] = np.inf
    costs[2, :11] += 5e5  # so that wide gaps are worth their price at times

    def cost(places):
        wide = np.count_nonzero(np.diff(places) > 8)
        return costs[range(3), places].sum() + wide * bridging.GAP_COST

    best = min(combinations(range(13), 3), key=cost)
    assert tuple(bridging._settle(costs).tolist()) == best


def test_a_long_unusable_stretch_is_crossed():
    kept_idx = np.r_[0:30, 120:150]
    chosen = bridging.choose(kept_idx, G, 40, 0, np.ones(G))
    assert len(chosen) == 40 and set(chosen.tolist()) <= set(kept_idx.tolist())


@pytest.mark.parametrize(
    ("offset_idx", "n", "expected"),
    [(0, 4, [0, 3, 6, 9]), (1, 4, [1, 4, 7, 10]), (2, 4, [2, 5, 8, 11]), (0, 5, [0, 2, 4, 6, 8])],
)
def test_the_plain_interval_takes_every_dth(offset_idx, n, expected):
    found = bridging.choose(np.arange(14), 14, n, offset_idx, np.ones(14), "interval")
    assert found.tolist() == expected
    shifted = bridging.choose(np.arange(14) + 3, 17, n, offset_idx, np.ones(17), "interval")
    assert shifted.tolist() == [place + 3 for place in expected]


@pytest.mark.parametrize("rule", ["even", "interval"])
def test_too_few_usable_frames_are_said(rule):
    with pytest.raises(InputError) as caught:
        bridging.choose(np.arange(0, 30, 3), 30, 11, 0, np.ones(30), rule, walk="walk1")
    message = "walk1: expected at least 11 usable frames, found 10 of 30"
    assert str(caught.value).startswith(message) and "film longer, or lower n" in str(caught.value)


@pytest.mark.parametrize(
    "change",
    [{"n": 1}, {"offset_idx": 3}, {"rule": "best"}, {"kept_idx": [3, 2, 5]}, {"kept_idx": [1, 30]}],
)
def test_wrong_arguments_are_faults(change):
    arguments = {"kept_idx": np.arange(30), "n": 2, "offset_idx": 0, "rule": "even"} | change
    with pytest.raises(ValueError, match=r"offset|ascend") as caught:
        bridging.choose(n_grid=30, sharpness=np.ones(30), **arguments)
    assert not isinstance(caught.value, InputError)


def test_angles_between_views_are_those_of_a_circle():
    point = np.array([3.05, 6.7, 1.0])
    turn = np.radians([0, 10, 35, 90, 270])
    circle = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(5)])
    radii = np.array([5, 9, 2, 7, 4.0])[:, None]
    found = bridging.neighbour_angles_deg(point + radii * circle, point)
    np.testing.assert_allclose(found, [10, 25, 55, 180], atol=1e-9)
    with_gap = point + radii * circle
    with_gap[2] = np.nan
    found = bridging.neighbour_angles_deg(with_gap, point)
    np.testing.assert_array_equal(np.isnan(found), [False, True, True, False])
