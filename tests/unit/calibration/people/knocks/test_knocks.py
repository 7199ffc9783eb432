"""A camera knocked during a take: found, timed and measured by people; none where none was."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.people import prior
from courtside.calibration.people.knocks import judgement, knocks, steps
from courtside.calibration.people.views import Limits
from courtside.geometry import camera as cameras
from courtside.records.cameras import knock_table
from courtside.records.devices.clocks import Clock
from fixtures.cameras import corner_cameras, walkers

TRUE = corner_cameras.four_cameras()
LIMITS = Limits(score=0.05, limit=0.05, fade=0.067)
KNOWN = prior.stated(TRUE, **corner_cameras.STATED)
WALK = walkers.joints(80)
SEEN = walkers.seen(TRUE, WALK)
TURN = np.radians([0.25, -0.3, 0.1])
AT_S = 4.5


@pytest.fixture(scope="module")
def knocked():
    """Return what is seen where c2 is knocked: projected by the turned camera."""
    after, turned = SEEN.time_s >= AT_S, cameras.turned(TRUE[2], TURN)
    xy = SEEN.xy.copy()
    xy[2, after] += (cameras.project(turned, WALK) - cameras.project(TRUE[2], WALK))[after]
    return replace(SEEN, xy=xy)


@pytest.fixture(scope="module")
def found(knocked):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(knocks, "MOST", 1)  # a take without one is tested below
        return knocks.find(walkers.disturbed(TRUE, KNOWN, 3), KNOWN, knocked, LIMITS)


def test_a_knock_is_found_by_the_right_camera_and_time_before_disturbed_cameras(found):
    assert found[0].taken and found[0].camera == 2
    assert found[0].time_s == pytest.approx(AT_S, abs=0.2)
    assert np.degrees(np.abs(found[0].turn - TURN)).max() < 0.04
    assert (np.abs(found[0].turn - TURN) < 3 * found[0].sigma).all()
    assert found[0].change < -0.3


def test_keypoints_return_to_where_the_camera_stood(knocked, found):
    back = knocks.undone(TRUE, knocked, [replace(found[0], turn=TURN, time_s=AT_S)])
    assert np.abs(back.xy - SEEN.xy).max() < 0.2  # noise is turned, too
    assert np.abs(knocked.xy - SEEN.xy).max() > 5
    other = replace(found[0], verdicts={"joints": "not better"})
    np.testing.assert_array_equal(knocks.undone(TRUE, knocked, [other]).xy, knocked.xy)


def test_nobody_knocks_where_no_camera_was_knocked():
    assert not any(one.taken for one in knocks.find(TRUE, KNOWN, SEEN, LIMITS))


def test_people_who_stand_still_show_no_knock():
    still = walkers.seen(TRUE, walkers.joints(64, still=True))
    assert knocks.find(TRUE, KNOWN, still, LIMITS) == []


def test_a_knock_is_told_in_the_clock_of_its_camera(found):
    row = {"take": "t", **knocks.row(found[0], TRUE, {"c2": Clock(offset_s=1.0)})}
    assert row["time_s"] == pytest.approx(float(Clock(offset_s=1.0).from_reference(AT_S)), abs=0.2)
    assert row["camera"] == "c2" and row["taken"] == 1 and row["joints"] == "better"
    (line,) = knock_table.lines([row, {**row, "taken": 0}])
    assert line.startswith("camera c2 was knocked at ") and "of take t by 0.4" in line


def test_a_camera_that_sees_nobody_of_the_others_hinders_no_search(knocked, monkeypatch):
    said = judgement.Judged(0.0, judgement.NOT_BETTER)
    monkeypatch.setattr(judgement, "judged", lambda *_: said)
    blind = knocked.xy.copy()
    blind[3] = np.nan
    found = knocks.find(TRUE, KNOWN, replace(knocked, xy=blind), LIMITS)
    assert found and all(one.camera != 3 for one in found)


def test_a_camera_turned_between_takes_has_a_pose_in_each(knocked, monkeypatch):
    monkeypatch.setattr(knocks, "MOST", 1)
    after = knocked.time_s >= AT_S
    takes = {"a": knocked.of(~after), "b": knocked.of(after)}
    seen, rows = knocks.between(TRUE, KNOWN, takes, LIMITS)
    (row,) = rows
    assert (row["take"], row["after"], row["camera"], row["time_s"]) == ("b", "a", "c2", 0.0)
    turn = [row[f"turn_{axis}_deg"] for axis in "xyz"]
    assert row["taken"] == 1 and np.abs(turn - np.degrees(TURN)).max() < 0.04
    (line,) = knock_table.lines([row, {**row, "take": "c"}])
    assert line.startswith("camera c2 was turned between takes a and b by 0.4")
    assert np.median(np.abs(seen.xy - SEEN.xy)) < 0.5 < np.abs(knocked.xy - SEEN.xy).max()
    one, none = knocks.between(TRUE, KNOWN, {"a": SEEN}, LIMITS)
    assert none == [] and len(one.track) == len(SEEN.track)


def test_a_camera_turned_before_the_last_of_several_takes_is_found(monkeypatch):
    """Most of the time no camera is turned: the median over all of it does not tell."""
    monkeypatch.setattr(knocks, "MOST", 1)
    takes = {
        name: walkers.seen(TRUE, walkers.joints(64), share=0.008, seed=seed)
        for seed, name in enumerate("abcd")
    }
    turned = cameras.turned_back(TRUE[1], takes["d"].xy[1], -4 * TURN)
    xy = np.concatenate([takes["d"].xy[:1], turned[None], takes["d"].xy[2:]])
    _, rows = knocks.between(TRUE, KNOWN, takes | {"d": replace(takes["d"], xy=xy)}, LIMITS)
    (row,) = rows
    assert (row["camera"], row["take"], row["after"], row["taken"]) == ("c1", "d", "c", 1)
    turn = [row[f"turn_{axis}_deg"] for axis in "xyz"]
    assert (np.abs(turn - 4 * np.degrees(TURN)) < [0.04, 0.04, 0.15]).all()
    assert row["joints_percent"] < -30


def test_every_camera_turned_between_takes_is_found_and_measured_with_the_others(monkeypatch):
    """`MOST` is of a take; alone, the first would be measured with the other still in it."""
    monkeypatch.setattr(knocks, "MOST", 1)
    monkeypatch.setattr(knocks, "MOST_TRIED", 2)
    five = [*TRUE, corner_cameras.camera("c4", np.array([0, -5.5, 3]), (960, 540))]
    first, second = (
        walkers.seen(five, walkers.joints(64), share=0.008, seed=seed) for seed in (0, 1)
    )
    turns = {"c0": 4 * TURN, "c3": 4 * TURN[[1, 2, 0]]}
    for at, turn in ((0, turns["c0"]), (3, turns["c3"])):
        second.xy[at] = cameras.turned_back(five[at], second.xy[at], -turn)
    takes = {"a": first, "b": second}
    _, rows = knocks.between(five, prior.stated(five, **corner_cameras.STATED), takes, LIMITS)
    taken = {row["camera"]: row for row in rows if row["taken"]}
    assert sorted(taken) == sorted(turns)
    for camera, row in taken.items():
        turn, sigma = ([row[f"{what}_{axis}_deg"] for axis in "xyz"] for what in ("turn", "sigma"))
        assert (np.abs(turn - np.degrees(turns[camera])) < 3 * np.array(sigma)).all()


def test_two_cameras_knocked_at_one_time_turn_no_third():
    """While one is not known, a step of a third camera fits, too."""
    turn, after = np.radians([0.28, 0.94, 0.19]), SEEN.time_s >= AT_S
    xy = SEEN.xy.copy()
    for at in (0, 2):
        xy[at, after] = cameras.turned_back(TRUE[at], xy[at, after], -turn)
    found = knocks.find(TRUE, KNOWN, replace(SEEN, xy=xy), LIMITS)
    taken = {one.camera: one for one in found if one.taken}
    assert sorted(taken) == [0, 2]
    for one in taken.values():
        assert one.time_s == pytest.approx(AT_S, abs=0.2)
        assert np.degrees(np.abs(one.turn - turn)[:2]).max() < 0.06


def test_steps_that_the_turn_of_another_camera_makes_are_not_tried():
    xy, after = SEEN.xy.copy(), SEEN.time_s >= AT_S
    xy[2, after] = cameras.turned_back(TRUE[2], xy[2, after], -4 * TURN)
    seen = replace(SEEN, xy=xy)
    tried = [
        step
        for one in (TRUE, walkers.disturbed(TRUE, KNOWN, 3))
        for step in steps.clearest(one, seen, LIMITS.score, None)
    ]
    tried.sort(key=lambda one: one.gain)
    kept = knocks._of_turned(TRUE, KNOWN, seen, LIMITS, tried)
    there = [{s.camera for s in some if abs(s.time_s - AT_S) < 0.5} for some in (tried, kept)]
    assert len(there[0]) > 1 and there[1] == {2}


def test_two_turns_of_one_camera_are_measured_in_a_row():
    """Each from the pose before it, and what is found again at one time is part of it."""
    xy = SEEN.xy.copy()
    for first, turn in ((3.0, TURN), (5.0, -2 * TURN)):
        after = SEEN.time_s >= first
        xy[2, after] = cameras.turned_back(TRUE[2], xy[2, after], -turn)
    seen, better = replace(SEEN, xy=xy), {"joints": "better"}
    rough = ((5.0, -1.5 * TURN), (3.0, 0.8 * TURN), (5.0, -0.4 * TURN))
    found = [knocks.Knock(2, at_s, turn, 0 * TURN, -0.5, better) for at_s, turn in rough]
    first, second = knocks._together(TRUE, KNOWN, seen, LIMITS, found)
    assert (first.time_s, second.time_s) == (3.0, 5.0)
    for one, turn in ((first, TURN), (second, -2 * TURN)):
        assert (np.abs(one.turn - turn) < 3 * one.sigma).all()
        assert np.degrees(np.abs(one.turn - turn)[:2]).max() < 0.03
    off = np.linalg.norm(knocks.undone(TRUE, seen, [first, second]).xy - SEEN.xy, axis=-1)
    assert np.median(off) < 1


def test_a_camera_that_is_put_back_was_knocked_twice():
    xy, during = SEEN.xy.copy(), (SEEN.time_s >= 2.5) & (SEEN.time_s < 5.5)
    xy[2, during] = cameras.turned_back(TRUE[2], xy[2, during], -2 * TURN)
    found = knocks.find(TRUE, KNOWN, replace(SEEN, xy=xy), LIMITS)
    there, back = (one for one in found if one.taken)
    for one, at_s, turn in ((there, 2.5, 2 * TURN), (back, 5.5, -2 * TURN)):
        assert one.camera == 2 and one.time_s == pytest.approx(at_s, abs=0.2)
        assert np.degrees(np.abs(one.turn - turn)[:2]).max() < 0.04


def test_a_knock_in_the_last_seconds_of_a_longer_take_is_found(monkeypatch):
    """The cameras are known well: most of the time one pose of each fits."""
    monkeypatch.setattr(knocks, "MOST", 1)
    known = replace(KNOWN, covariance=KNOWN.covariance / 400)
    seen = walkers.seen(TRUE, walkers.joints(240))
    xy, after = seen.xy.copy(), seen.time_s >= 20.5
    xy[2, after] = cameras.turned_back(TRUE[2], xy[2, after], -2 * TURN)
    (found,) = knocks.find(TRUE, known, replace(seen, xy=xy), LIMITS)
    assert found.taken and found.camera == 2 and found.time_s == pytest.approx(20.5, abs=0.2)
    assert (np.abs(found.turn - 2 * TURN) < 3 * found.sigma).all()
