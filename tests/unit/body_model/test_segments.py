import numpy as np
import pytest

from courtside.body_model import segments
from fixtures.people.moving_model import NAMES, column


def test_parents_come_first_and_ranges_of_the_sides_mirror_each_other():
    model = segments.model()
    assert (model.parents < np.arange(len(NAMES))).all()
    assert NAMES[model.parents[NAMES.index("left_humerus")]] == "left_clavicle"
    flexion, rotation = (column("left_tibia", k) for k in (0, 1))
    assert np.degrees(model.low[flexion]) == pytest.approx(-160)
    for k, sign in ((0, -1), (1, -1), (2, 1)):
        left, right = column("left_femur", k), column("right_femur", k)
        ends = sorted([sign * model.low[right], sign * model.high[right]])
        np.testing.assert_allclose([model.low[left], model.high[left]], ends)
    assert model.moves[flexion, NAMES.index("left_foot")]
    assert not model.moves[rotation, NAMES.index("right_foot")]


@pytest.mark.parametrize(
    ("joint", "segment"),
    [
        ("left_wrist", "left_hand"),
        ("right_heel", "right_foot"),
        ("nose", "head"),
        ("left_ear", "head"),
        ("neck", "thorax"),
        ("tail", None),
    ],
)
def test_joints_of_networks_are_fixed_to_segments(joint, segment):
    assert segments.segment_of(joint) == segment
