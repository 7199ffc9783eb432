"""Networks in parts: who is in which, and that nothing is lost or seen twice."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.bundle import problem as networks
from courtside.calibration.bundle import selection, walk_parts
from fixtures.cameras import networks_made


@pytest.mark.parametrize(
    ("n_walk", "per_part", "sizes"),
    [
        (0, 40, [0]),
        (5, 40, [5]),
        (59, 40, [59]),
        (60, 40, [30, 30]),
        (100, 40, [50, 50]),
        (101, 40, [34, 34, 33]),
        (7, 2, [2, 2, 2, 1]),
    ],
)
def test_parts_come_near_to_the_size_asked_for(n_walk, per_part, sizes):
    parts = walk_parts.split(networks_made.make(n_walk, 3), [0, 1], per_part)
    assert [len(part.images) - 2 for part in parts] == sizes


def test_images_take_turns_and_fixed_ones_are_everywhere():
    parts = walk_parts.split(networks_made.make(6, 3), [7, 0], 3)
    assert [part.images.tolist() for part in parts] == [[0, 1, 3, 5, 7], [0, 2, 4, 6, 7]]
    assert [part.fixed.tolist() for part in parts] == [[4, 0], [4, 0]]


def test_a_part_sees_what_the_whole_sees_in_its_images():
    whole = networks_made.make(7, 12, noise_px=0.5, flex=True)
    off = networks.residuals(whole)
    for part in walk_parts.split(whole, [0, 1], 3):
        mine = np.isin(whole.image_idx, part.images)
        np.testing.assert_array_equal(networks.residuals(part.network), off[mine])
        np.testing.assert_array_equal(part.images[part.network.image_idx], whole.image_idx[mine])
        np.testing.assert_array_equal(part.network.xyz, whole.xyz)
    (same,) = walk_parts.split(whole, [0, 1], 7)
    np.testing.assert_array_equal(networks.residuals(same.network), off)


def test_put_together_every_image_has_its_place_and_fixed_ones_that_of_the_first_part():
    whole = networks_made.make(6, 10)
    first, second = walk_parts.split(whole, [0, 1], 3)
    pose = second.network.cam_from_world
    pose[second.fixed, :, 3] += 0.5
    parts = [first, second]
    np.testing.assert_array_equal(walk_parts.centres(parts), selection.centres(whole))
    assert walk_parts.points(parts).shape == (20, 3)
    np.testing.assert_array_equal(walk_parts.points(parts)[10:], whole.xyz)


def test_parts_are_brought_to_the_frame_of_the_first():
    whole = networks_made.make(7, 10)
    split = walk_parts.split(whole, [0, 1], 3)
    parts = [
        replace(part, network=networks_made.in_random_frame(part.network, seed))
        for seed, part in enumerate(split, start=4)
    ]
    found = walk_parts.in_one_frame(parts, networks_made.in_random_frame(whole, 9))
    assert found[0] is parts[0] and len(found) == len(parts) == 2
    expected = networks_made.in_random_frame(whole, 4)
    np.testing.assert_allclose(walk_parts.centres(found), selection.centres(expected), atol=1e-9)
    np.testing.assert_allclose(found[1].network.xyz, expected.xyz, atol=1e-9)


def test_images_are_cameras_by_name_those_of_fixed_ones_of_the_first_part():
    whole = networks_made.make(6, 10)
    first, second = walk_parts.split(whole, [0, 1], 3)
    second.network.cam_from_world[second.fixed, :, 3] += 0.5
    names = [f"{at}.png" for at in range(8)]
    sizes = [(100 + at, 90) for at in range(len(whole.lens))]
    views = walk_parts.views([first, second], names, sizes)
    assert [view.name for view in views] == names
    for at, view in enumerate(views):
        np.testing.assert_array_equal(view.cam_from_world, whole.cam_from_world[at])
        lens = whole.lens_of_image[at]
        assert view.size == sizes[lens] and view.K[1, 1] == whole.lens[lens, 0]


def test_the_spread_of_residuals_is_that_of_the_parts():
    whole = networks_made.make(40, 100, noise_px=0.5)
    parts = walk_parts.split(whole, [0, 1], 20)
    assert walk_parts.residual_spread(parts) == pytest.approx(0.5, rel=0.05)
