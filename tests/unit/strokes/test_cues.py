"""Each hypothesis gives the time of its extremum, or nothing."""

import numpy as np

from courtside.evaluation.movement import strokes as evaluation
from courtside.strokes import cues, signals
from fixtures.people import strokes_made


def test_cues_are_near_the_hit_and_the_farthest_wrist_nearest_of_an_overhead_stroke():
    points, truth = strokes_made.take(seed=1)
    found = signals.of_person(points, 0)
    arm = found.arms["right"]
    hits_s = evaluation.hits(truth, "p1")[:2]
    assert len(hits_s) == 2
    for true_s in hits_s:
        said = cues.times(found, "right", true_s)
        assert set(said) == set(cues.CUES)
        far = said["wrist_far"]
        at = np.argmin(abs(points.time_s - far))
        assert arm.reach[at] == arm.reach[at - 1 : at + 2].max()
        slow = np.argmin(abs(points.time_s - said["wrist_slow"]))
        assert arm.wrist.speed[slow] == arm.wrist.speed[slow - 1 : slow + 2].min()


def test_of_a_still_person_nothing_is_said():
    time_s = np.arange(60) / 30
    _, xyz, _ = strokes_made.joints("rally", 1, 10, "right")
    points = strokes_made.record(time_s, np.repeat(xyz[:1], 60, axis=0))
    said = cues.times(signals.of_person(points, 0), "right", 1.0)
    assert np.isnan([said["wrist_far"], said["wrist_fast"]]).all()


def test_the_components_of_a_line_are_its_course():
    course = np.sin(np.linspace(0, 3, 40))
    path = np.outer(course, [3.0, 4.0])
    first, second = cues._components(path)
    np.testing.assert_allclose(np.abs(first), 5 * np.abs(course - course.mean()), atol=1e-9)
    np.testing.assert_allclose(second, 0, atol=1e-9)
