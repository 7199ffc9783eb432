from dataclasses import replace

import numpy as np
import pytest

from courtside.body_model import pose, segments, shape
from fixtures.people import moving_model

TRUE = {name: length for name, (length, _) in moving_model.LENGTHS.items()}


def seen(noise_m=0.0):
    points = moving_model.points(moving_model.moving(), noise_m)
    place = dict(zip(points.joints.tolist(), np.moveaxis(points.xyz[0], 1, 0), strict=True))
    return points, place, {joint: np.full(len(points.time_s), 0.01) for joint in place}


def placed(body, points, gone=(), free=None):
    """Return the shape with points by true poses, some joints unseen."""
    true = moving_model.body()
    origin, turned = pose.forward(segments.model(), moving_model.moving(), true.offsets)
    weight = np.ones(points.xyz.shape[1:3])
    weight[:, list(gone)] = 0
    free = shape.is_free(body) if free is None else free
    return shape.with_points(body, free, origin, turned, points.xyz[0], weight)


def test_lengths_lie_between_what_is_seen_and_their_share_of_the_height():
    _, place, sigma = seen()
    found = shape.lengths(place, sigma, height_m=1.75)
    assert {name: one for name, (one, _) in found.items()} == pytest.approx(TRUE, rel=1e-6)
    tall = shape.lengths(place, sigma, height_m=1.95)
    assert TRUE["thigh"] < tall["thigh"][0] < shape.OF_HEIGHT["thigh"] * 1.95
    assert 0 < found["thigh"][1] < shape.SYSTEMATIC * TRUE["thigh"]


def test_a_length_that_is_not_seen_is_its_share_of_the_height_and_less_certain():
    _, place, sigma = seen()
    known = shape.lengths(place, sigma, 1.75)["forearm"]
    gone = {joint: np.full_like(line, np.nan) for joint, line in place.items() if "wrist" in joint}
    found = shape.lengths(place | gone, sigma, 1.75)["forearm"]
    assert found[0] == pytest.approx(TRUE["forearm"])
    assert found[1] > 1.5 * known[1]


def test_the_best_frames_count():
    _, place, sigma = seen()
    place = {joint: line.copy() for joint, line in place.items()}
    for side in ("left", "right"):
        place[f"{side}_wrist"][:25] += 0.5
        sigma[f"{side}_wrist"][:25] = 0.2
    assert shape.lengths(place, sigma, 1.75)["forearm"][0] == pytest.approx(TRUE["forearm"])


def test_feet_and_other_points_are_placed_where_they_are_seen():
    points, place, _ = seen()
    model, true = segments.model(), moving_model.body()
    bare = shape.of_lengths(model, moving_model.LENGTHS, moving_model.JOINTS)
    found = shape.with_feet(bare, place)
    np.testing.assert_allclose(found.places, true.places, atol=1e-6)
    np.testing.assert_allclose(placed(bare, points).places, true.places, atol=1e-6)


@pytest.mark.parametrize("unseen", ["left", "right"])
def test_a_point_that_is_seen_on_one_side_only_mirrors_to_the_other(unseen):
    points, _, _ = seen()
    gone = [at for at, name in enumerate(moving_model.JOINTS) if name == f"{unseen}_heel"]
    bare = shape.of_lengths(segments.model(), moving_model.LENGTHS, moving_model.JOINTS)
    found = placed(bare, points, gone)
    np.testing.assert_allclose(found.places, moving_model.body().places, atol=1e-6)


def test_toes_without_heels_follow_the_poses_of_every_round():
    points, place, _ = seen()
    heels = [at for at, name in enumerate(moving_model.JOINTS) if "heel" in name]
    gone = {moving_model.JOINTS[at]: np.full_like(points.xyz[0, :, at], np.nan) for at in heels}
    bare = shape.of_lengths(segments.model(), moving_model.LENGTHS, moving_model.JOINTS)
    first = shape.with_feet(bare, place | gone)
    free = shape.is_free(first)
    shifted = replace(points, xyz=points.xyz + 0.05)
    again = placed(placed(first, shifted, heels, free), points, heels, free)
    others = [at for at in range(len(moving_model.JOINTS)) if at not in heels]
    true = moving_model.body().places
    np.testing.assert_allclose(again.places[others], true[others], atol=1e-6)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("part", ["heel", "foot_index"])
def test_feet_whose_heels_or_toes_are_never_seen_stay_at_the_ankle(part):
    _, place, _ = seen()
    gone = {name: np.full_like(line, np.nan) for name, line in place.items() if part in name}
    bare = shape.of_lengths(segments.model(), moving_model.LENGTHS, moving_model.JOINTS)
    found = shape.with_feet(bare, place | gone)
    np.testing.assert_array_equal(found.places, bare.places)
