"""Verdicts: a fault of one camera is that camera's, its cause is named, and the rest is good."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.quality import causes, verdict
from courtside.quality.calibration_doubts import Doubts
from courtside.records.devices.clocks import Clock
from courtside.study.execution.verdicts import ALL, COLUMNS, DOUBTFUL, FAILED, GOOD, WHOLE
from fixtures.people import judged

MIRRORED = "the principal point of camera c1 is mirrored in x"
SAME = dict.fromkeys(("c0", "c1", "c2", "c3"), (0, 1))


def wholes(cameras, **said):
    """Return {(camera, person): row} of the verdicts, and the table; `said` against cameras."""
    table = verdict.judge(judged.gathered(cameras), Doubts(**said))
    rows = table[table["measure"] == WHOLE]
    return {(row.camera, row.person): row for row in rows.itertuples()}, table


def test_a_good_take_is_good_throughout():
    rows, table = wholes(judged.footage())
    assert {row.verdict for row in rows.values()} == {GOOD}
    assert set(table["verdict"]) == {GOOD} and list(table.columns) == COLUMNS
    assert list(rows) == [(ALL, ALL), *((f"c{k}", ALL) for k in range(4)), (ALL, "p1"), (ALL, "p2")]
    assert table["sentence"].str.endswith(".").all()


def test_a_camera_that_was_switched_on_later_is_good():
    cameras = judged.footage(offset_s={1: 1.0})
    cameras[1] = replace(cameras[1], clock=Clock(offset_s=-1.0))
    rows, _ = wholes(cameras)
    assert {row.verdict for row in rows.values()} == {GOOD}


def absent(person, frames, found, n_frames=150):
    """Return the cameras where the association loses a person, or nobody is found there."""
    cameras = []
    for one in judged.footage(n_frames):
        one.people.index[one.camera.name][person, frames] = -1
        view = one.tracklets
        for values in () if found else (view.xy, view.score):
            values[person, frames] = np.nan
        cameras.append(one)
    return cameras


@pytest.mark.parametrize(
    ("frames", "when"), [(slice(82), "from 1.6 to 3.0 s"), (slice(45, None), "from 0.0 to 0.9 s")]
)
def test_who_comes_later_or_leaves_earlier_makes_nothing_doubtful(frames, when):
    rows, table = wholes(absent(1, frames, found=False))
    assert {row.verdict for row in rows.values()} == {GOOD}
    assert set(table["verdict"]) == {GOOD}
    assert when in rows[ALL, "p2"].sentence and "from" not in rows[ALL, "p1"].sentence


@pytest.mark.parametrize(
    ("found", "cause", "words"),
    [(True, causes.IDENTITY, "followed in 75%"), (False, causes.DETECTION, "network found 75%")],
)
def test_who_is_lost_by_all_cameras_in_the_middle_is_doubtful_or_failed(found, cause, words):
    rows, _ = wholes(absent(1, slice(40, 115), found=found))
    assert rows[ALL, "p2"].verdict == DOUBTFUL
    assert rows[ALL, "p1"].verdict == GOOD
    for camera in SAME:
        assert rows[camera, ALL].verdict == DOUBTFUL and rows[camera, ALL].cause == cause
        assert words in rows[camera, ALL].sentence and "poor" not in rows[camera, ALL].sentence
    rows, _ = wholes(absent(1, slice(15, 135), found=found))
    assert rows[ALL, "p2"].verdict == rows[ALL, ALL].verdict == FAILED


LONG = slice(60, 330)  # 5.4 of 8 s


def test_who_is_away_in_between_makes_nothing_doubtful():
    rows, table = wholes(absent(1, LONG, found=False, n_frames=400))
    assert set(table["verdict"]) == {GOOD}
    agree = "the cameras agree from 0.0 to 1.2 s and 6.6 to 8.0 s of the take."
    assert rows[ALL, "p2"].sentence == f"p2: {agree}"


def test_a_camera_that_finds_nobody_meanwhile_is_doubtful():
    cameras = absent(1, LONG, found=False, n_frames=400)
    cameras[2].tracklets.xy[:, LONG] = np.nan
    rows, _ = wholes(cameras)
    assert rows["c2", ALL].verdict != GOOD and rows["c2", ALL].cause == causes.DETECTION
    assert {rows[f"c{k}", ALL].verdict for k in (0, 1, 3)} == {GOOD}
    assert rows[ALL, ALL].verdict == DOUBTFUL


@pytest.mark.parametrize("lost", ["found in one camera", "nobody anywhere"])
def test_who_is_lost_for_long_is_not_away(lost):
    cameras = absent(1, LONG, found=False, n_frames=400)
    if lost == "nobody anywhere":  # cameras lose them within a few frames: the light went out
        for at, one in enumerate(cameras):
            one.tracklets.xy[:, LONG.start + at : LONG.stop] = np.nan
    else:
        cameras[2].tracklets.xy[1] = judged.footage(400)[2].tracklets.xy[1]
    rows, _ = wholes(cameras)
    assert rows[ALL, "p2"].verdict == rows[ALL, ALL].verdict == FAILED


def emptied(leaving, returning):
    """Return pictures that become empty one after another, by these frames, and fill so."""
    cameras = judged.footage(900)
    for at, one in enumerate(cameras):
        one.tracklets.xy[:, 60 + leaving * at : 390 - returning * at] = np.nan
    return cameras


@pytest.mark.parametrize(("leaving", "returning"), [(0, 10), (10, 0)])
def test_pictures_that_become_empty_or_fill_at_one_time_are_a_fault(leaving, returning):
    rows, _ = wholes(emptied(leaving, returning))
    assert rows[ALL, ALL].verdict != GOOD


@pytest.mark.parametrize(("leaving", "returning"), [(10, 10), (10, 5)])
def test_everybody_may_leave_the_pictures_and_come_back(leaving, returning):
    rows, table = wholes(emptied(leaving, returning))
    assert set(table["verdict"]) == {GOOD}
    until_s, since_s = (60 + 3 * leaving - 1) / 50, (390 - 3 * returning) / 50
    when = f"from 0.0 to {until_s:.1f} s and {since_s:.1f} to 18.0 s of the take"
    assert rows[ALL, "p1"].sentence == f"p1: the cameras agree {when}."


PLANTED = {
    "turned by 2 degrees": (lambda: judged.turned(judged.footage(), 1, 2.0), causes.CALIBRATION),
    "0.1 s late": (lambda: judged.footage(offset_s={1: 0.1}), causes.CLOCK),
    "another person": (
        lambda: judged.followed(judged.footage(), SAME | {"c1": (1, 0)}),
        causes.IDENTITY,
    ),
    "nobody": (lambda: judged.footage(hidden={1: 1.0}), causes.DETECTION),
}


@pytest.mark.parametrize("fault", PLANTED)
def test_one_wrong_camera_is_named_with_its_cause_and_the_others_are_good(fault):
    cameras, cause = PLANTED[fault]
    rows, _ = wholes(cameras())
    assert rows["c1", ALL].verdict in (DOUBTFUL, FAILED) and rows["c1", ALL].cause == cause
    assert {rows[f"c{k}", ALL].verdict for k in (0, 2, 3)} == {GOOD}
    assert rows[ALL, ALL].verdict == DOUBTFUL and rows[ALL, ALL].cause == cause
    assert "Camera c1: " in rows[ALL, ALL].sentence


@pytest.mark.parametrize("shift_s", [0.04, -0.04])
def test_a_clock_that_is_off_by_less_than_poor_keypoints_are_is_named(shift_s):
    """No measure of the camera is beyond its limit: only another time shows it."""
    rows, table = wholes(judged.footage(offset_s={1: shift_s}, height_m=3.0))
    measured = table[table["measure"] != WHOLE]
    assert set(measured["verdict"]) == {GOOD}
    assert (rows["c1", ALL].verdict, rows["c1", ALL].cause) == (DOUBTFUL, causes.CLOCK)
    assert f"its clock is off: moved by {-shift_s:+.3f} s" in rows["c1", ALL].sentence
    assert {rows[f"c{k}", ALL].verdict for k in (0, 2, 3)} == {GOOD}
    assert (rows[ALL, ALL].verdict, rows[ALL, ALL].cause) == (DOUBTFUL, causes.CLOCK)


@pytest.mark.parametrize("shift_s", [0.06, -0.3])
def test_of_two_cameras_either_clock_may_be_off(shift_s):
    rows, _ = wholes(judged.footage(n_cameras=2))
    assert {row.verdict for row in rows.values()} == {GOOD}
    rows, _ = wholes(judged.footage(n_cameras=2, offset_s={1: shift_s}))
    for name, sign in (("c0", 1), ("c1", -1)):
        assert (rows[name, ALL].verdict, rows[name, ALL].cause) == (DOUBTFUL, causes.CLOCK)
        moved = f"moved by {sign * shift_s:+.3f} s"
        assert moved in rows[name, ALL].sentence and verdict.ANY in rows[name, ALL].sentence
    assert rows[ALL, ALL].verdict != GOOD and rows[ALL, ALL].cause == causes.CLOCK


def test_of_cameras_that_face_each_other_either_clock_may_be_off():
    rows, _ = wholes(judged.footage(offset_s={1: 0.06}))
    late = [row for row in rows.values() if row.camera != ALL and row.verdict != GOOD]
    assert [row.camera for row in late] == ["c1", "c3"]
    assert all(row.cause == causes.CLOCK and verdict.ANY in row.sentence for row in late)


def test_no_clock_is_doubted_where_people_stand_still_or_nobody_is_compared():
    still = judged.footage()
    for one in still:
        one.tracklets.xy[...] = one.tracklets.xy[:, :1]
    one = [judged.footage(n_frames=1, n_cameras=n_cameras) for n_cameras in (2, 4)]
    lost = judged.followed(judged.footage(n_cameras=2), {"c0": (0, 1), "c1": (-1, -1)})
    for cameras in (still, *one, lost):
        rows, _ = wholes(cameras)
        assert causes.CLOCK not in {row.cause for row in rows.values()}


@pytest.mark.parametrize("people", [False, True], ids=["nobody", "people"])
def test_a_camera_that_looks_elsewhere_is_good_only_if_it_finds_nobody(people):
    away = judged.turned(judged.footage(hidden={} if people else {1: 1.0}), 1, 60.0)
    rows, _ = wholes(away)
    assert rows["c1", ALL].verdict == (FAILED if people else GOOD)
    assert ("nobody should be in its picture" in rows["c1", ALL].sentence) != people
    assert {rows[f"c{k}", ALL].verdict for k in (0, 2, 3)} == {GOOD}
    assert (rows[ALL, ALL].verdict == GOOD) != people


def test_of_three_cameras_that_contradict_each_other_none_is_blamed_for_sure():
    """Cameras as high as what they look at, turned about the vertical: any two agree."""
    rows, _ = wholes(judged.turned(judged.footage(n_cameras=3, height_m=1.0), 1, 1.0))
    wrong = [row for row in rows.values() if row.camera != ALL and row.verdict != GOOD]
    assert len(wrong) > 1
    assert all(verdict.ANY in row.sentence for row in wrong)
    assert rows[ALL, ALL].cause == causes.CALIBRATION


def test_a_right_camera_is_not_blamed_where_the_others_are_too_near_each_other_to_check_it():
    """They leave open how far away people are, and it sees exactly along that."""
    cameras = judged.footage(n_cameras=3, sides_deg=(0, 5, 90), n_frames=60)
    rows, _ = wholes(cameras)
    words = "Camera c2: the other cameras stand too near each other, or face each other, to check"
    for row in (rows["c2", ALL], rows[ALL, ALL]):
        assert (row.verdict, row.cause) == (DOUBTFUL, causes.UNKNOWN)
        assert words in row.sentence
    assert {rows[name, ALL].verdict for name in ("c0", "c1")} == {GOOD}
    rows, _ = wholes(judged.turned(cameras, 2, 2.0))  # a wrong one, with people to all sides
    assert (rows["c2", ALL].verdict, rows["c2", ALL].cause) == (FAILED, causes.CALIBRATION)


def test_painted_lines_tell_the_wrong_one_of_three_cameras():
    cameras = judged.turned(judged.footage(n_cameras=3, height_m=1.0), 1, 1.0)
    words = "does not see the court's lines where the others do"
    rows, _ = wholes(cameras, by_lines={"c1": words})
    assert rows["c1", ALL].verdict != GOOD and rows["c1", ALL].cause == causes.CALIBRATION
    assert rows["c1", ALL].sentence == f"Camera c1: its calibration is off: it {words}."
    assert {rows[name, ALL].verdict for name in ("c0", "c2")} == {GOOD}
    assert rows[ALL, ALL].sentence.endswith(rows["c1", ALL].sentence)


@pytest.mark.parametrize("by", ["by_lines", "by_check"])
def test_a_camera_that_agrees_is_doubtful_where_a_check_doubts_its_calibration(by):
    words = {"by_lines": "does not see the court's lines", "by_check": MIRRORED}[by]
    rows, _ = wholes(judged.footage(), **{by: {"c1": words}})
    whole = rows["c1", ALL]
    assert (whole.verdict, whole.cause) == (DOUBTFUL, causes.CALIBRATION)
    assert whole.sentence.startswith("Camera c1: it agrees with the other cameras, but ")
    assert whole.sentence.endswith(f"{words}.")
    assert {rows[f"c{k}", ALL].verdict for k in (0, 2, 3)} == {GOOD}
    take = rows[ALL, ALL]
    assert (take.verdict, take.cause) == (DOUBTFUL, causes.CALIBRATION)
    assert take.sentence == whole.sentence


def test_a_camera_is_not_said_to_be_turned_where_a_check_names_another_fault():
    cameras = judged.turned(judged.footage(), 1, 2.0)
    rows, _ = wholes(cameras, by_check={"c1": MIRRORED})
    whole = rows["c1", ALL]
    assert whole.verdict != GOOD and whole.cause == causes.CALIBRATION
    off = "its calibration is off: by the check of the calibration file"
    assert whole.sentence == f"Camera c1: {off} {MIRRORED}."


def test_nor_is_one_that_disagrees_with_cameras_that_a_check_names():
    cameras = judged.turned(judged.footage(), 2, 2.0)
    rows, _ = wholes(cameras, by_check={"c1": MIRRORED})
    assert rows["c1", ALL].verdict == DOUBTFUL
    assert rows["c2", ALL].verdict != GOOD and rows["c2", ALL].cause == causes.CALIBRATION
    assert rows["c2", ALL].sentence == f"Camera c2: {causes.OTHERS}."
    assert "turned" not in rows[ALL, ALL].sentence


def test_a_take_is_doubtful_where_its_calibration_doubts_itself():
    rows, _ = wholes(judged.footage(), shared=("floor: 9 degrees", "people: 2 s"))
    take = rows.pop((ALL, ALL))
    assert (take.verdict, take.cause) == (DOUBTFUL, causes.CALIBRATION)
    assert take.sentence == "The calibration is in doubt: floor: 9 degrees; people: 2 s."
    assert {row.verdict for row in rows.values()} == {GOOD}
    failed, _ = wholes(judged.footage(hidden=dict.fromkeys(range(4), 1.0)), shared=("floor",))
    take = failed[ALL, ALL]
    assert (take.verdict, take.cause) == (FAILED, causes.DETECTION)
    assert take.sentence.endswith(" The calibration is in doubt: floor.")


@pytest.mark.parametrize("doubted", [{"shared": ("floor",)}, {"by_lines": {"c2": "is off"}}])
def test_cameras_with_poor_detection_do_not_outvote_a_doubted_calibration(doubted):
    """Whoever reads the take's cause asks whether its metres are right."""
    poor = judged.footage(hidden={0: 0.2, 1: 0.2})
    rows, _ = wholes(poor)
    assert (rows[ALL, ALL].verdict, rows[ALL, ALL].cause) == (DOUBTFUL, causes.DETECTION)
    rows, _ = wholes(poor, **doubted)
    assert {rows[name, ALL].cause for name in ("c0", "c1")} == {causes.DETECTION}
    assert {rows[ALL, person].verdict for person in ("p1", "p2")} == {GOOD}
    assert (rows[ALL, ALL].verdict, rows[ALL, ALL].cause) == (DOUBTFUL, causes.CALIBRATION)


def test_nor_do_they_outvote_a_clock():
    rows, _ = wholes(judged.footage(hidden={0: 0.2, 2: 0.2}, offset_s={1: 0.1}))
    assert [rows[name, ALL].cause for name in ("c0", "c1", "c2")].count(causes.DETECTION) == 2
    assert (rows["c1", ALL].cause, rows[ALL, ALL].cause) == (causes.CLOCK, causes.CLOCK)


DRIFT = "expected a drift of at most 400 ppm, found 1100 ppm: look whether a file lacks frames"


def test_a_camera_that_agrees_is_doubtful_where_its_clock_is_in_doubt():
    cameras = judged.footage()
    cameras[1] = replace(cameras[1], clock=Clock(doubt=DRIFT))
    rows, _ = wholes(cameras)
    whole, take = rows["c1", ALL], rows[ALL, ALL]
    assert (whole.verdict, whole.cause) == (take.verdict, take.cause) == (DOUBTFUL, causes.CLOCK)
    said = f"it agrees with the other cameras; its clock is in doubt: {DRIFT}."
    assert whole.sentence == take.sentence == f"Camera c1: {said}"
    assert {rows[name, ALL].verdict for name in ("c0", "c2", "c3")} == {GOOD}
    assert {rows[ALL, person].verdict for person in ("p1", "p2")} == {GOOD}


def test_a_clock_in_doubt_stands_beside_another_fault_of_its_camera():
    said = {0: causes.CLOCK, 1: causes.CALIBRATION}  # poor detection does not hide it
    cameras = judged.turned(judged.footage(hidden={0: 0.9}), 1, 2.0)
    before, _ = wholes(cameras)
    assert before["c0", ALL].verdict == FAILED and before["c0", ALL].cause == causes.DETECTION
    cameras = [
        replace(one, clock=Clock(doubt=DRIFT if at in said else ""))
        for at, one in enumerate(cameras)
    ]
    rows, _ = wholes(cameras)
    for at, cause in said.items():
        was, is_now = before[f"c{at}", ALL], rows[f"c{at}", ALL]
        assert (is_now.verdict, is_now.cause) == (was.verdict, cause)
        assert is_now.sentence == f"{was.sentence[:-1]}; its clock is in doubt: {DRIFT}."


def crowded(hidden=(), others=37):
    """Return the verdicts on a take whose camera c1 shows spectators beside the two players."""
    cameras = judged.footage(hidden=hidden)
    players = cameras[1].tracklets
    rows = {
        name: np.concatenate([getattr(players, name), np.tile(getattr(players, name)[:1], shape)])
        for name, shape in (("xy", (others, 1, 1, 1)), ("score", (others, 1, 1)))
    }
    cameras[1] = replace(cameras[1], tracklets=replace(players, **rows))
    return wholes(cameras)[0]


def test_a_take_is_doubtful_where_more_people_are_found_than_can_be_followed():
    rows = crowded()
    take = rows.pop((ALL, ALL))
    assert (take.verdict, take.cause) == (DOUBTFUL, causes.IDENTITY)
    line = "camera c1: expected at most 38 people at once, found 39; only 40 are followed"
    assert line in take.sentence and take.sentence.endswith("out of the pictures.")
    assert {row.verdict for row in rows.values()} == {GOOD}
    assert crowded(others=36)[ALL, ALL].verdict == GOOD
    failed = crowded(hidden=dict.fromkeys((0, 2, 3), 1.0))[ALL, ALL]
    assert (failed.verdict, failed.cause) == (FAILED, causes.DETECTION)
    assert line in failed.sentence


@pytest.mark.parametrize("n_cameras", [2, 4])
def test_a_take_in_which_nobody_was_found_failed(n_cameras):
    rows, _ = wholes(judged.footage(n_cameras=n_cameras, hidden=dict.fromkeys(range(4), 1.0)))
    assert {row.verdict for row in rows.values()} == {FAILED}
    assert rows[ALL, ALL].cause == causes.DETECTION
    message = rows[ALL, ALL].sentence
    assert message.count("found nobody in 100% of the frames") == 1 and "Cameras c0, c1" in message


def test_cameras_that_follow_different_people_fail_the_take():
    """One subject is stated: two cameras follow one person, one the other, one a stranger."""
    cameras = judged.footage()
    stranger = cameras[3].tracklets
    stranger.xy[...] = np.array([1920.0, 0.0]) + stranger.xy[:1] * np.array([-1.0, 1.0])
    rows, _ = wholes(judged.followed(cameras, {"c0": (0,), "c1": (1,), "c2": (1,), "c3": (0,)}))
    assert rows[ALL, ALL].verdict == FAILED
    assert rows["c3", ALL].verdict == FAILED


@pytest.mark.parametrize(
    ("value", "expected"), [(0.95, GOOD), (0.7, DOUBTFUL), (0.3, FAILED), (float("nan"), FAILED)]
)
def test_a_value_is_judged_by_its_limit(value, expected):
    limit = verdict.Limit(0.9, 0.5, "{:.0%} of it", "how much of it")
    assert verdict.level(limit, value) == expected
    high = verdict.Limit(0.1, 0.5, "{:.3f}", "it", falling=False)
    assert verdict.level(high, 1 - value) == expected


@pytest.mark.parametrize(
    ("limits", "measure", "words"),
    [
        (verdict.OF_PERSON, "limb_length", "how much the lengths of limbs vary"),
        (verdict.OF_PERSON, "views_2", "how many of the joints rest on two cameras or more"),
        (verdict.OF_CAMERA, "reprojection", "how far its keypoints are from the other cameras'"),
    ],
)
def test_an_unknown_value_is_told_in_a_whole_sentence(limits, measure, words):
    (row,) = verdict._judged({measure: float("nan")}, limits, ALL, "p1")
    assert row["sentence"] == f"Nothing is known of {words}." and row["verdict"] == FAILED
    (row,) = verdict._judged({measure: 0.25}, limits, ALL, "p1")
    assert "nothing" not in row["sentence"].lower() and "25" in row["sentence"]
