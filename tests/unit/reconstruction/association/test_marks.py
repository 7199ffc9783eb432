"""Sightings by pixel and time, and who is who over time by them."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.reconstruction.association import marks
from courtside.reconstruction.association.marks import Mark
from courtside.records.keypoints.sightings import Sighting
from courtside.study.errors import InputError
from fixtures.people import named_takes


def located(take, camera="c0", time_s=1.0, xy=None, **bounds):
    xy = named_takes.place_px(1) if xy is None else xy
    sighting = Sighting("p1", camera, time_s, xy, "people.csv: line 2", **bounds)
    return marks.locate(sighting, take.found, take.seen, ["p0", "p1"])


def test_a_pixel_on_the_body_is_the_person_at_the_reference_time():
    take = named_takes.take()
    assert located(take) == Mark(1, 1, 1.0, None, None, "people.csv: line 2")
    x, y = named_takes.place_px(1)
    assert located(take, xy=(x + 10, y - 70)).person == 1  # above the shoulders
    other = located(take, "c1", 1.5, named_takes.place_px(0, 1), from_s=1.0, to_s=2.0)
    assert (other.person, other.time_s, other.from_s, other.to_s) == (0, 1.0, 0.5, 1.5)


def test_the_middle_of_a_body_is_its_own_where_somebody_elses_hip_is():
    """The middle of a trunk is farther from its own joints than a limb of who stands behind."""
    take = named_takes.take()
    (x, y), tracklets = named_takes.place_px(1), take.seen[0].tracklets
    tracklets.xy[0] += [184, 0]  # a hip is 4 px beside the middle of person 1
    assert located(take, xy=(x, y)).person == 1
    with pytest.raises(InputError, match=r"expected one person at \(302, 150\) px .* found two"):
        located(take, xy=(x + 2, y))
    assert located(take, xy=(x + 20, y)).person == 1


def test_a_person_who_was_missed_in_the_very_frame_is_found_beside_it():
    take = named_takes.take()
    take.seen[0].tracklets.xy[1, 9:12] = np.nan
    take.found.index["c0"][1, 9:12] = -1
    assert located(take).person == 1
    take.seen[0].tracklets.xy[1, 5:16] = np.nan
    with pytest.raises(InputError, match=r"found people at \(100, 138\); choose a pixel"):
        located(take)


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"camera": "c7"}, r"expected a camera of c0, c1, found 'c7'; correct it"),
        ({"time_s": 9.0}, r"expected time_s from 0\.00 to 6\.00 s, .* found 9; correct it"),
        ({"camera": "c1", "time_s": 0.2}, r"expected time_s from 0\.50 to 6\.50 s, .* found 0\.2"),
        ({"xy": (900.0, 10.0)}, r"expected a pixel of c0's pictures of 800 x 400 px, found"),
        ({"xy": (200.0, 20.0)}, r"expected a person at \(200, 20\) px of c0 at 1 s, found people"),
    ],
)
def test_faults_are_one_line_with_where_it_was_stated(changed, words):
    with pytest.raises(InputError, match=rf"^people\.csv: line 2: {words}") as fault:
        located(named_takes.take(), **changed)
    assert "\n" not in str(fault.value)


def test_a_track_of_one_camera_alone_is_told():
    take = named_takes.take()
    take.found.index["c0"][1] = -1
    with pytest.raises(InputError, match="whom another camera sees too, found one in this camera"):
        located(take)


def test_an_empty_picture_is_told():
    take = named_takes.take()
    take.seen[0].tracklets.xy[:] = np.nan
    with pytest.raises(InputError, match="found nobody in this picture"):
        located(take)


def mark(subject, person, time_s, from_s=None, to_s=None):
    return Mark(subject, person, time_s, from_s, to_s, f"line {time_s:g}")


def crossing(gap_m=0.4):
    """Return people whose tracks meet at 3 s."""
    x = np.linspace(-3, 3, len(named_takes.TIMES))
    paths = np.stack([np.stack([x, 0 * x], axis=1), np.stack([-x, 0 * x + gap_m], axis=1)])
    return named_takes.take(paths=paths).found


def changes(row):
    """Return the values of a row and when they change."""
    at = np.flatnonzero(np.diff(row))
    return [int(row[0]), *(int(row[i + 1]) for i in at)], named_takes.TIMES[at].tolist()


def test_one_mark_names_the_whole_track():
    owner, used = marks.timelines(crossing(), [mark(0, 1, 2.0)], 2)
    assert (owner[1] == 0).all() and (owner[0] == -1).all()
    assert (used[0] == 1).all() and (used[1] == -1).all()


def test_two_who_were_exchanged_are_put_right_where_they_met():
    marked = [mark(0, 0, 1.0), mark(1, 1, 1.0), mark(1, 0, 5.0), mark(0, 1, 5.0)]
    owner, used = marks.timelines(crossing(), marked, 2)
    for rows in (owner, used):
        for row, values in zip(rows, ([0, 1], [1, 0]), strict=True):
            assert changes(row) == (values, [pytest.approx(3.0)])


def test_two_who_were_exchanged_met_each_other_not_a_third_who_came_nearer():
    found = crossing(0.6)
    third = found.path[:1] + [0.0, 0.2, 0.0] + 3 * np.abs(named_takes.TIMES - 4)[None, :, None]
    found = replace(
        found, path=np.concatenate([found.path, third]), person_id=np.array(["a", "b", "c"])
    )
    marked = [mark(0, 0, 1.0), mark(1, 1, 1.0), mark(1, 0, 5.0), mark(0, 1, 5.0), mark(2, 2, 1.0)]
    owner, used = marks.timelines(found, marked, 3)
    for rows in (owner, used):
        assert [changes(row) for row in rows[:2]] == [
            (values, [pytest.approx(3.0)]) for values in ([0, 1], [1, 0])
        ]


def test_two_who_were_exchanged_met_each_other_not_in_an_occlusion_of_one_before():
    found = crossing()
    found.path[0, (named_takes.TIMES > 1.2) & (named_takes.TIMES < 2.0)] = np.nan
    marked = [mark(0, 0, 1.0), mark(1, 1, 1.0), mark(1, 0, 5.0), mark(0, 1, 5.0)]
    owner, used = marks.timelines(found, marked, 2)
    for rows in (owner, used):
        for row, values in zip(rows, ([0, 1], [1, 0]), strict=True):
            assert changes(row) == (values, [pytest.approx(3.0)])


def test_two_who_came_back_exchanged_did_it_out_of_sight_not_at_a_meeting():
    found = crossing()  # they meet at 3 s
    found.path[:, (named_takes.TIMES > 3.25) & (named_takes.TIMES < 5.55)] = np.nan
    marked = [mark(0, 0, 1.0), mark(1, 1, 1.0), mark(1, 0, 5.8), mark(0, 1, 5.8)]
    owner, used = marks.timelines(found, marked, 2)
    for rows in (owner, used):
        for row, values in zip(rows, ([0, 1], [1, 0]), strict=True):
            assert changes(row) == (values, [pytest.approx(4.4, abs=0.15)])


def test_pieces_of_one_person_are_joined():
    found = named_takes.take(3, gone=[(0, slice(20, None)), (2, slice(0, 25))]).found
    owner, used = marks.timelines(found, [mark(0, 0, 1.0), mark(0, 2, 5.0)], 1)
    assert changes(used[0]) == ([0, 2], [pytest.approx(1.9)])
    assert (owner[[0, 2]] == 0).all() and (owner[1] == -1).all()


def test_two_who_are_there_and_never_near_are_not_joined():
    found = named_takes.take().found
    marked = [mark(0, 0, 1.0), mark(0, 1, 5.0)]
    said = r"line 5: expected the person of line 1, found another one, never nearer than 3\.0 m"
    with pytest.raises(InputError, match=said):
        marks.timelines(found, marked, 1)
    bounded = [mark(0, 0, 1.0, to_s=2.0), mark(0, 1, 5.0, from_s=2.0)]
    _, used = marks.timelines(found, bounded, 1)
    assert changes(used[0]) == ([0, 1], [pytest.approx(2.0, abs=0.11)])


@pytest.mark.parametrize(
    ("gone", "change_s"),
    [([(0, slice(23, None)), (1, slice(0, 20))], 2.0), ([(k, slice(20, 30)) for k in (0, 1)], 2.4)],
    ids=["pieces that overlap", "both out of sight"],
)
def test_pieces_of_one_person_are_joined_also_where_nothing_is_near(gone, change_s):
    found = named_takes.take(gone=gone).found
    _, used = marks.timelines(found, [mark(0, 0, 1.0), mark(0, 1, 5.0)], 1)
    assert changes(used[0]) == ([0, 1], [pytest.approx(change_s, abs=0.11)])


def test_stated_bounds_split_where_nothing_else_does():
    marked = [mark(0, 0, 1.0, to_s=2.0), mark(1, 0, 5.0, from_s=4.0)]
    owner, used = marks.timelines(named_takes.take().found, marked, 2)
    assert changes(owner[0]) == ([0, -1, 1], [pytest.approx(2.0), pytest.approx(3.9)])
    assert changes(used[0]) == ([0, -1], [pytest.approx(2.0)])
    assert changes(used[1]) == ([-1, 0], [pytest.approx(3.9)])


def test_bounds_exchange_two_people_for_a_while_only():
    marked = [
        mark(0, 0, 1.0),
        mark(1, 1, 1.0),
        mark(1, 0, 3.0, 2.0, 4.0),
        mark(0, 1, 3.0, 2.0, 4.0),
    ]
    for later in ([], [mark(0, 0, 5.0), mark(1, 1, 5.0)]):
        owner, used = marks.timelines(named_takes.take().found, marked + later, 2)
        for rows in (owner, used):
            for row, values in zip(rows, ([0, 1, 0], [1, 0, 1]), strict=True):
                assert changes(row) == (values, [pytest.approx(1.9), pytest.approx(4.0)])


def test_one_subject_ends_and_the_next_begins_at_a_bound():
    found = named_takes.take().found
    for first, second in (
        ({"to_s": 3.0}, {}),
        ({}, {"from_s": 3.05}),
        ({"to_s": 3.0}, {"from_s": 3.0}),
    ):
        owner, _ = marks.timelines(found, [mark(0, 0, 1.0, **first), mark(1, 0, 5.0, **second)], 2)
        assert changes(owner[0]) == ([0, 1], [pytest.approx(3.0, abs=0.11)])


@pytest.mark.parametrize(
    ("other", "what"),
    [((1, 0), "two subjects for one person"), ((0, 1), "one subject at two places")],
)
def test_bounds_that_contradict_each_other_are_refused(other, what):
    said = rf"line 5: expected times apart from those of line 1, found {what} from 2\.0 to 4\.0 s"
    first, second = mark(0, 0, 1.0, 0.0, 4.0), mark(*other, 5.0, 2.0, 6.0)
    with pytest.raises(InputError, match=said):
        marks.timelines(named_takes.take().found, [first, second], 2)
    with pytest.raises(InputError, match="expected times apart"):
        marks.timelines(named_takes.take().found, [second, first], 2)


def test_bounds_of_one_subject_may_overlap_where_its_persons_are_not_both_there():
    found = named_takes.take(gone=[(0, slice(30, None)), (1, slice(0, 28))]).found
    marked = [mark(0, 0, 1.0, 0.0, 4.0), mark(0, 1, 5.0, 2.0, 6.0)]
    owner, _ = marks.timelines(found, marked, 1)
    assert changes(owner[0]) == ([0, -1], [pytest.approx(4.0)])


def test_somebody_between_two_others_needs_bounds_alone():
    marked = [mark(0, 0, 1.0), mark(1, 0, 3.0, 2.0, 4.0), mark(2, 0, 5.0)]
    owner, _ = marks.timelines(named_takes.take().found, marked, 3)
    assert changes(owner[0]) == ([0, 1, 2], [pytest.approx(1.9), pytest.approx(4.0)])


def test_a_gap_may_have_exchanged_somebody():
    found = named_takes.take(gone=[(0, slice(20, 40))]).found
    owner, _ = marks.timelines(found, [mark(0, 0, 1.0), mark(1, 0, 5.0)], 2)
    assert changes(owner[0])[0] == [0, 1]
    assert changes(owner[0])[1][0] == pytest.approx(2.9, abs=0.11)


@pytest.mark.parametrize("times", [(1.0, 5.0), (3.0, 3.0)])
def test_two_subjects_on_one_person_are_refused(times):
    found = named_takes.take().found if times[0] != times[1] else crossing()
    with pytest.raises(
        InputError, match=r"expected another person than at line .*, found the same"
    ):
        marks.timelines(found, [mark(0, 0, times[0]), mark(1, 0, times[1])], 2)


def test_one_subject_at_two_places_is_refused():
    with pytest.raises(InputError, match=r"found the subject of line 2 at the same time 3\.0 m"):
        marks.timelines(named_takes.take().found, [mark(0, 0, 2.0), mark(0, 1, 2.0)], 1)
