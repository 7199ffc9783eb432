"""The centre of mass against the printed table's second definitions and known bodies."""

from pathlib import Path

import numpy as np
import pytest

from courtside.kinematics import centre_of_mass
from courtside.records.keypoints import derived_joints
from courtside.study.errors import InputError
from fixtures.people import footwork, walker

TABLE = derived_joints.read(Path(__file__).parents[3] / "config" / "derived_joints.yaml")
# de Leva 1996, table 4: lengths in mm and the place of the centre in %, for men and women, where
# the same segment is given between other points; what both say of the distance to their common end
# must agree.
TRUNK_FROM_SUPRASTERNALE = {"m": (531.9, 44.86), "f": (529.3, 41.51)}
TRUNK_FROM_MID_SHOULDER = {"m": 515.5, "f": 497.9}
SHANK_TO_MALLEOLUS = {"m": (434.0, 44.59), "f": (432.3, 44.16)}
SHANK_TO_ANKLE = {"m": 440.3, "f": 438.6}
HAND_TO_FINGERTIP = {"m": (187.9, 36.24), "f": (170.1, 34.27)}
FOREARM = {"m": 268.9, "f": 264.3}


def weights(sex):
    return centre_of_mass.weights(TABLE, "blazepose33", walker.SKELETON.joints, sex)


@pytest.mark.parametrize("sex", ["m", "f", None])
def test_all_mass_is_somewhere(sex):
    assert sum(centre_of_mass.shares(sex).values()) == pytest.approx(1.0, abs=1e-12)
    assert weights(sex).sum() == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("sex", ["m", "f"])
def test_the_masses_are_percent_of_the_body(sex):
    total = sum(s.mass[sex] * (2 if s.paired else 1) for s in centre_of_mass.SEGMENTS.values())
    assert total == pytest.approx(100.0, abs=0.02)


@pytest.mark.parametrize("sex", ["m", "f"])
def test_the_places_agree_with_the_second_definitions_of_the_table(sex):
    length, percent = TRUNK_FROM_SUPRASTERNALE[sex]
    own = centre_of_mass.SEGMENTS["trunk"].place[sex]
    assert TRUNK_FROM_MID_SHOULDER[sex] * (100 - own) == pytest.approx(
        length * (100 - percent), rel=2e-3
    )
    length, percent = SHANK_TO_MALLEOLUS[sex]
    own = centre_of_mass.SEGMENTS["shank"].place[sex]
    assert SHANK_TO_ANKLE[sex] * own == pytest.approx(length * percent, rel=2e-3)
    length, percent = HAND_TO_FINGERTIP[sex]
    beyond = centre_of_mass.SEGMENTS["hand"].place[sex] - 100
    assert FOREARM[sex] * beyond == pytest.approx(length * percent, rel=2e-3)


def test_a_symmetric_pose_has_its_centre_in_the_plane_of_symmetry():
    xyz, _ = footwork.body(np.array([[2.0, 3.0, 1.45]]), np.zeros(1))
    assert np.einsum("j,jk->k", weights("m"), xyz[0])[0] == pytest.approx(2.0, abs=1e-12)


def test_a_standing_man_has_his_centre_at_the_height_that_is_measured():
    heights = {
        "shoulder": 1.43,
        "elbow": 1.14,
        "wrist": 0.87,
        "hip": 0.93,
        "knee": 0.50,
        "ankle": 0.08,
    }
    heights |= {"ear": 1.63, "eye": 1.64}
    z = [
        next((h for joint, h in heights.items() if name.endswith("_" + joint)), 1.0)
        for name in walker.SKELETON.joints
    ]
    # A man of 1.75 m: 55 to 57 % of body height (Zatsiorsky 2002); the feet are put 5 cm too high
    # here.
    assert 0.55 < weights("m") @ z / 1.75 < 0.575


def test_a_raised_arm_raises_the_centre_by_its_share():
    at = walker.SKELETON.index("left_elbow"), walker.SKELETON.index("left_wrist")
    raised = sum(weights("m")[index] for index in at)
    whole = 0.0271 * 0.5772 + 0.0162 + 0.0061  # upper arm in part; forearm and hand whole
    assert raised == pytest.approx(whole, rel=1e-6)


def test_an_unknown_sex_is_one_line():
    with pytest.raises(InputError, match=r"expected m or f.*found 'x'"):
        centre_of_mass.shares("x")
