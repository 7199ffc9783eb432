import numpy as np

from courtside.body_model import pose, segments, start
from courtside.records.keypoints import skeleton
from fixtures.people import moving_model


def test_bent_limbs_start_where_they_are():
    model, true = segments.model(), moving_model.moving()
    points = moving_model.points(true)
    names = points.joints.tolist()
    found = start.pose(model, {j: points.xyz[0][:, names.index(j)] for j in skeleton.JOINTS})
    hinges = [moving_model.column(name) for name in ("left_tibia", "right_forearm")]
    np.testing.assert_allclose(found.angle[:, hinges], true.angle[:, hinges], atol=1e-6)
    origin, _ = pose.forward(model, found, moving_model.body().offsets)
    knee = origin[moving_model.NAMES.index("left_tibia")]
    np.testing.assert_allclose(knee, points.xyz[0][:, names.index("left_knee")], atol=1e-6)
