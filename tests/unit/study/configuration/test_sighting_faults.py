"""Where a session's file says that a subject is: takes and cameras that are there."""

import pytest

from courtside.study.configuration import sighting_faults

FILE = "gym.yaml"
SEEN = {"camera": "a", "time_s": 1.0, "at_px": [10, 20]}
VIDEOS = {"a": "a.mp4", "b": "b.mp4"}


def find(seen, takes, cameras=("a", "b"), others=()):
    subjects = {"p1": {"seen": seen}} | {name: {} for name in others}
    content = {"cameras": {name: {} for name in cameras}, "subjects": subjects, "takes": takes}
    return list(sighting_faults.find(FILE, content))


ONE = {"walk": {"videos": VIDEOS}}
TWO = ONE | {"run": {"videos": VIDEOS}}


@pytest.mark.parametrize(
    ("seen", "takes"),
    [
        (SEEN, ONE),
        ([SEEN, SEEN | {"time_s": 2.0}], ONE),
        (SEEN | {"take": "run"}, TWO),
        (SEEN, ONE | {"suit": {"devices": {}}}),
        (SEEN, ONE | {"run": {"videos": VIDEOS, "subjects": ["p2"]}}),
        (SEEN, {"shot": {"virtual": {"motion": "shot"}}}),
    ],
)
def test_good_sightings_have_no_fault(seen, takes):
    assert find(seen, takes, others=["p2"]) == []


@pytest.mark.parametrize(
    ("seen", "takes", "words"),
    [
        (SEEN | {"camera": "c"}, ONE, "seen.camera: expected one of ['a', 'b'], found 'c'"),
        (SEEN, TWO, "seen: expected `take`, one of ['walk', 'run'], found none"),
        (SEEN, {}, "seen: expected a filmed take of p1, found none; remove it"),
        (SEEN | {"take": "jump"}, ONE, "seen.take: expected one of ['walk'], found 'jump'"),
        (
            SEEN | {"take": "run"},
            ONE | {"run": {"videos": VIDEOS, "subjects": ["p2"]}},
            "seen.take: expected one of ['walk'], found 'run'",
        ),
        (
            SEEN,
            {"shot": {"virtual": {"motion": "shot", "cameras": ["b"]}}},
            "seen.camera: expected one of ['b'], found 'a'",
        ),
    ],
)
def test_a_fault_is_one_line(seen, takes, words):
    (line,) = find(seen, takes, others=["p2"])
    assert line.startswith(f"{FILE}: subjects.p1.{words}")
    assert "\n" not in line
