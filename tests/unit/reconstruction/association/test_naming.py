"""Subjects among the persons found: named, inferred where only one is left, never guessed."""

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import yaml

from courtside.reconstruction.association import naming
from courtside.records.keypoints import sightings
from courtside.records.keypoints.sightings import Sighting
from courtside.study.errors import InputError
from fixtures.people import named_takes

WORDS = naming.Wording("hall/walk", "results/people.html", "config/sessions/hall.yaml")
COURT = SimpleNamespace(size_m=np.array([6.1, 13.4]))


def sighting(subject, person, time_s=1.0):
    return Sighting(subject, "c0", time_s, named_takes.place_px(person), "line 2")


def name(take, sightings=(), subjects=("p1",), court=None, words=WORDS):
    return naming.name(take.found, take.seen, sightings, subjects, words, court)


def test_one_subject_and_one_person_need_no_name():
    take = named_takes.take(1)
    named = name(take)
    assert named.person_id.tolist() == ["p1"]
    for camera, rows in take.found.index.items():
        np.testing.assert_array_equal(named.index[camera], rows)
    np.testing.assert_array_equal(named.path, take.found.path)
    assert naming.others(take.found, named) == []


def test_who_was_there_for_less_than_a_tenth_does_not_count():
    take = named_takes.take(2, gone=[(1, slice(5, None))])
    take.found.placed[:] = np.isfinite(take.found.path[..., 0]).mean(axis=1)
    assert (name(take).index["c0"] == 0).all()


def test_who_stays_beside_the_court_does_not_count():
    paths = np.stack([np.tile(at, (61, 1)) for at in ([3.0, 5.0], [9.0, 5.0])])
    take = named_takes.take(2, paths=paths)
    assert (name(take, court=COURT).index["c0"] == 0).all()
    with pytest.raises(InputError, match=r"expected a statement who is p1, .* person-2 \("):
        name(take)


def test_a_player_who_rests_beside_the_court_for_most_of_the_take_still_counts():
    """Who stands on the court meanwhile is a coach; nothing but a statement says so."""
    paths = np.stack([np.tile(at, (61, 1)) for at in ([-2.8, 6.5], [5.0, 9.0])])
    paths[0, :20] = 3.0, 5.0
    take = named_takes.take(2, paths=paths, gone=[(1, slice(25))])
    with pytest.raises(InputError, match=r"who is p1, found person-1 .* person-2 \("):
        name(take, court=COURT)
    paths[0, 5:] = -2.8, 6.5  # for less than a tenth: he passes by
    assert (name(named_takes.take(2, paths=paths), court=COURT).index["c0"] == 1).all()


def test_one_subject_among_several_is_not_guessed():
    with pytest.raises(InputError) as fault:
        name(named_takes.take(2))
    assert str(fault.value) == (
        "hall/walk: expected a statement who is p1, found person-1 (100% of the take, about x 0.0 "
        "y 0.0 m, seen by c0, c1), person-2 (100% of the take, about x 3.0 y 0.0 m, seen by c0, "
        "c1); say which of them is p1 on the page results/people.html (people.csv), or by `seen` "
        "in config/sessions/hall.yaml"
    )


def test_without_a_page_each_person_comes_with_the_entry_that_names_it():
    take = named_takes.take(2)
    with pytest.raises(InputError, match="which of them is p1 by `seen` in") as fault:
        name(take, words=naming.Wording("hall/walk", "", "hall.yaml"))
    entries = [yaml.safe_load(text) for text in re.findall(r"{.*?}", str(fault.value))]
    assert len(entries) == 2
    for person, entry in enumerate(entries):
        found = name(take, [sightings.stated("hall.yaml", "p1", entry)])
        assert (found.index["c1"] == person).all()


def test_without_a_page_every_person_of_a_team_comes_with_an_entry():
    names = [f"player{k}" for k in range(12)]
    take = named_takes.take(14, n_cameras=8)
    with pytest.raises(InputError) as fault:
        name(take, subjects=names, words=naming.Wording("hall/walk", "", "hall.yaml"))
    first, *others = fault.value.lines
    assert first.startswith("hall/walk: expected a statement who is player0 and who is player1 ")
    assert "found 14 persons, listed below in the log; say which" in first and first.endswith(
        "in hall.yaml"
    )
    assert [line.split()[0] for line in others] == [f"person-{k + 1}" for k in range(14)]
    for person, line in enumerate(others):
        (entry,) = (yaml.safe_load(text) for text in re.findall(r"{.*?}", line))
        assert entry == {"camera": "c0", "time_s": 3.0, "at_px": [*named_takes.place_px(person)]}


def test_a_sighting_chooses_the_person_and_says_who_is_left():
    take = named_takes.take(3)
    named = name(take, [sighting("p1", 1)])
    assert all((rows == 1).all() for rows in named.index.values())
    assert (named.path[0, :, 0] == 3.0).all()
    left = naming.others(take.found, named)
    assert [line.split()[0] for line in left] == ["person-1", "person-3"]


def test_the_last_subject_is_the_last_person():
    named = name(named_takes.take(2), [sighting("b", 0)], ("a", "b"))
    assert named.person_id.tolist() == ["a", "b"]
    assert (named.index["c1"] == [[1], [0]]).all()
    with pytest.raises(
        InputError, match=r"expected a statement who is a, found person-2 .*person-3"
    ):
        name(named_takes.take(3), [sighting("b", 0)], ("a", "b"))


def test_who_is_there_for_a_third_as_long_as_a_stranger_may_be_the_last_subject():
    """A coach is there for 15 of 61 instants, player b for 5 of them: 8 %."""
    take = named_takes.take(3, gone=[(1, slice(15, None)), (2, slice(5, None))])
    with pytest.raises(InputError, match=r"who is b, found person-2 .* person-3"):
        name(take, [sighting("a", 0)], ("a", "b"))
    take = named_takes.take(3, gone=[(1, slice(15, None)), (2, slice(4, None))])
    assert (name(take, [sighting("a", 0)], ("a", "b")).index["c0"][1] == 1).all()


@pytest.mark.parametrize("n_people", [1, 2])
def test_several_subjects_need_names(n_people):
    with pytest.raises(
        InputError, match=r"expected a statement who is a and who is b, found person"
    ):
        name(named_takes.take(n_people), subjects=("a", "b"))


def test_a_subject_whom_nobody_is_left_for_is_not_found():
    take = named_takes.take(1)
    named = name(take, [sighting("b", 0)], ("a", "b"))
    assert named.placed.tolist() == [0, 1]
    assert (named.index["c0"][0] == -1).all() and np.isnan(named.path[0]).all()
    assert naming.lines(take.found, named)[0] == "a: not found"


def test_people_who_were_never_placed_stop_the_take():
    take = named_takes.take(1, gone=[(0, slice(None))])
    take.found.placed[:] = 0
    with pytest.raises(InputError, match=r"^c0, c1: expected people whom two views see .* check"):
        name(take)


def test_gaps_and_doubts_are_said():
    take = named_takes.take(2, gone=[(1, slice(20, 30))])
    rows = np.array([[1.0, 3.5, 4.0, 0, 0.6], [0.0, 3.5, 4.0, 1, 0.9]])
    take.found = replace(take.found, doubts=rows)
    named = name(take, [sighting("p1", 1)])
    assert named.doubts.tolist() == [[0, 3.5, 4.0, -1, 0.6]]
    assert named.confidence.tolist() == [0.6]
    (line,) = naming.lines(take.found, named)
    assert "one person throughout with probability 0.60; not placed from 1.9 to 3.0 s" in line
    assert "may be somebody else after 4.0 s (0.60 that not)" in line
    # A second sighting, after it, settles the doubt.
    sure = name(take, [sighting("p1", 1), sighting("p1", 1, 5.0)])
    assert sure.confidence.tolist() == [1.0]


def test_doubts_that_are_surer_each_but_not_together_are_said():
    take = named_takes.take(2)
    rows = [[0.0, at, at + 0.3, 1, kept] for at, kept in enumerate((0.95, 0.93, 0.96, 0.94, 0.97))]
    take.found = replace(take.found, doubts=np.array(rows))
    (line,) = naming.lines(take.found, name(take, [sighting("p1", 0, 0.0)]))
    assert "with probability 0.77; may be somebody else after 0.3 s (0.95 that not)" in line
    assert line.count("may be") == 3 and "3.3 s (0.94 that not)" in line


def met_twice(doubts):
    """Return two people who meet at 2 s, and closer at 4 s, with these doubts."""
    apart = np.interp(named_takes.TIMES, [0, 2, 3, 4, 6], [3, 0.6, 3, 0.5, 3])
    paths = np.stack([np.stack([k * apart, 0 * apart], axis=1) for k in (0, 1)])
    take = named_takes.take(paths=paths)
    take.found = replace(take.found, doubts=np.array(doubts))
    return take


EXCHANGED = [sighting("a", 0), sighting("b", 1), sighting("b", 0, 5.0), sighting("a", 1, 5.0)]


def test_an_exchange_at_one_of_two_meetings_is_told_with_its_probability():
    """The truth is the first meeting or the second one, as likely; the closer one is taken."""
    take = met_twice([[k, t - 0.2, t + 0.2, 1 - k, 0.6] for k in (0, 1) for t in (2, 4)])
    named = name(take, EXCHANGED, ("a", "b"))
    first, second = named.index["c0"]
    assert (first[:41] == 0).all() and (first[41:] == 1).all() and (second == 1 - first).all()
    assert named.confidence == pytest.approx([0.5, 0.5])
    for line, other in zip(naming.lines(take.found, named), "ba", strict=True):
        assert f"may be {other} from 1.8 to 4.2 s (0.50 that not): look at the page" in line


def test_an_exchange_at_the_only_meeting_is_settled():
    """Somebody who also was not placed meanwhile makes it no second occasion."""
    take = met_twice([[0, 3.8, 4.2, 1, 0.6], [0, 3.9, 4.6, -1, 0.95], [1, 3.8, 4.2, 0, 0.6]])
    named = name(take, EXCHANGED, ("a", "b"))
    assert not len(named.doubts) and named.confidence.tolist() == [1, 1]


def test_two_sightings_that_agree_settle_both_meetings():
    take = met_twice([[k, t - 0.2, t + 0.2, 1 - k, 0.6] for k in (0, 1) for t in (2, 4)])
    sure = [sighting("a", 0), sighting("b", 1), sighting("a", 0, 5.0), sighting("b", 1, 5.0)]
    assert name(take, sure, ("a", "b")).confidence.tolist() == [1, 1]


def test_the_rest_of_a_person_whom_a_subject_leaves_asks_for_a_name():
    """The tracks of a and b are exchanged at 4 s; nobody says who person-1 is from then on."""
    take = met_twice(np.zeros((0, 5)))
    named = name(take, EXCHANGED[:2] + EXCHANGED[3:], ("a", "b"))
    assert named.placed == pytest.approx([1, 41 / 61])
    assert naming.others(take.found, named) == ["person-1 (from 4.0 to 6.0 s)"]
    first, second = naming.lines(take.found, named)
    assert "not named" not in first
    assert second.endswith("; not named from 4.0 to 6.0 s: say who person-1 is then")
    assert "not placed" not in second
    every = name(take, EXCHANGED, ("a", "b"))
    assert naming.others(take.found, every) == []
    assert "not named" not in "".join(naming.lines(take.found, every))


def test_a_joined_subject_gets_the_rows_of_both_parts():
    gone = [(0, slice(20, None)), (2, slice(0, 25))]
    named = name(named_takes.take(3, gone=gone), [sighting("p1", 0), sighting("p1", 2, 5.0)])
    rows = named.index["c0"][0]
    assert (rows[:20] == 0).all() and (rows[21:] == 2).all()
    assert np.isfinite(named.path[0, :20]).all() and np.isfinite(named.path[0, 25:]).all()
