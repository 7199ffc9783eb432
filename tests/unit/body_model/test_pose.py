import numpy as np

from courtside.body_model import pose, segments
from fixtures.people import moving_model


def test_derivatives_are_those_of_small_steps():
    model, body, poses = segments.model(), moving_model.body(), moving_model.moving(3)

    def points(at):
        origin, turned = pose.forward(model, at, body.offsets)
        return origin, turned, pose.placed(origin, turned, body.segment_of, body.places)

    origin, turned, before = points(poses)
    by = pose.derivatives(model, origin, turned, before, body.segment_of)
    step = np.random.default_rng(0).standard_normal((3, len(model.sigma)))
    after = points(pose.moved(model, poses, 1e-6 * step))[2]
    np.testing.assert_allclose(
        (after - before) / 1e-6, np.einsum("tjad,td->tja", by, step), atol=1e-5
    )


def test_coordinates_follow_steps_by_their_blocks():
    model, poses = segments.model(), moving_model.moving(3)
    before, blocks = pose.coordinates(model, poses)
    step = 1e-6 * np.random.default_rng(0).standard_normal(before.shape)
    after, _ = pose.coordinates(model, pose.moved(model, poses, step))
    first = moving_model.column("left_humerus")
    own, at = slice(first, first + 3), moving_model.NAMES.index("left_humerus")
    wanted = np.einsum("tab,tb->ta", blocks[at], step[:, own])
    np.testing.assert_allclose(after[:, own] - before[:, own], wanted, atol=1e-10)
    hinge = moving_model.column("left_tibia")
    np.testing.assert_allclose((after - before)[:, hinge], step[:, hinge], atol=1e-15)
