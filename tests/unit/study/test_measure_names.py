"""Names of measures are those that are measured; others are told with the nearest name."""

import pytest

from courtside.calibration.court import court
from courtside.footwork import feet, measures
from courtside.kinematics import joint_angles
from courtside.study import measure_names
from fixtures.people import walking_feet


def test_every_angle_and_every_measure_of_the_feet_is_known():
    _, steps, events = feet.find(
        walking_feet.record(walking_feet.hop(), 3.0)[0], walking_feet.CUTOFFS
    )
    table = measures.summary(steps, events, court.read("config/courts/badminton.yaml"))
    assert len(table) and not list(measure_names.unknown("here", table["measure"]))
    limbs = {name for name in joint_angles.DICTIONARY if not name.startswith("trunk")}
    assert limbs == set(measure_names.LIMBS)
    assert set(joint_angles.DICTIONARY) - limbs <= set(measure_names.ANGLES)


@pytest.mark.parametrize(
    ("name", "advice"),
    [
        ("neck_distence", "found 'neck_distence'; did you mean 'neck_distance'?"),
        ("left_knee_flexion", "did you mean 'left_knee_flexion_m"),
        ("left_hip_adduction", "found 'left_hip_adduction'; "),
        ("rally_0_time", "did you mean 'rally_1_time'?"),
        ("qqq", "found 'qqq'; correct the name, or remove it"),
    ],
)
def test_another_name_is_told(name, advice):
    (line,) = measure_names.unknown("a.yaml: measures", [name])
    assert line.startswith("a.yaml: measures: expected measures of study.csv, such as neck_dist")
    assert advice in line
