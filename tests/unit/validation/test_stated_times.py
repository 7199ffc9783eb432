"""Times and pixels that do not lie in the videos: each is one line, before any job."""

from dataclasses import replace

import pytest

from courtside.validation import stated_times
from fixtures.recordings import rooms_filmed


def seen(hall, **entry):
    there = {"take": "serve", "camera": "left", "time_s": 0.5, "at_px": [160, 90]}
    hall.content["subjects"]["p1"] = {"seen": there | entry}
    return hall


def test_a_sighting_in_the_video_says_nothing(hall):
    assert seen(hall).said() == ([], [])
    width, height = rooms_filmed.SIZE
    assert seen(hall, at_px=[width - 1, height - 1], time_s=0).said() == ([], [])


def test_the_number_of_a_frame_as_time_is_told(hall):
    said = seen(hall, time_s=12).fault()
    assert "takes.serve: subjects.p1.seen: expected time_s from 0.00 to 2.00 s" in said
    assert said.endswith(
        "of left's video that is used, found 12; state the time in seconds, not the frame"
    )


def test_a_time_outside_of_the_part_that_is_used_is_told(hall):
    hall.content["takes"]["serve"]["trim_s"] = [0.2, 0.4]
    assert "expected time_s from 0.20 to 0.40 s" in seen(hall, time_s=0.6).fault()


def test_a_pixel_outside_of_the_picture_is_told(hall):
    said = seen(hall, at_px=[400, 90]).fault()
    assert "expected a pixel of left's pictures of 320 x 180 px, found (400, 90)" in said


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ("serv,p1,left,0.5,160,90", "line 3: expected a take of serve, lob, found 'serv'"),
        ("serve,p2,left,0.5,160,90", "line 3: expected a subject of p1, found 'p2'"),
        ("lob,p1,lift,0.5,160,90", "line 3: expected a camera of left, right, back, found 'lift'"),
        ("lob,p1,left,12,160,90", "line 3: expected time_s from 0.00 to 2.00 s"),
        ("lob,p1,left,0.5,160,190", "line 3: expected a pixel of left's pictures of 320 x 180 px"),
    ],
)
def test_a_row_that_names_nobody_is_told(hall, row, said):
    path = hall.root / "people.csv"
    hall.content["people"] = str(path)
    assert hall.said() == ([], [])  # it may not exist yet
    head = "take,subject,camera,time_s,x_px,y_px\nserve,p1,left,0.5,160,90\n"
    path.write_text(head, encoding="utf-8")
    assert hall.said() == ([], [])
    path.write_text(f"{head}{row}\n", encoding="utf-8")
    assert hall.fault().startswith(f"{path}: {said}")


def test_a_part_in_frames_is_a_remark(hall):
    hall.content["takes"]["serve"]["trim_s"] = [0, 24]
    faults, (remark,) = hall.said()
    assert faults == []
    assert "takes.serve: trim_s ends at 24 s, but no video is longer than 2.00 s" in remark
    hall.content["takes"]["serve"]["trim_s"] = [0, 2]
    assert hall.said() == ([], [])


def test_an_offset_in_milliseconds_is_told(hall):
    take = hall.content["takes"]["serve"]
    del take["synchronised"]
    take["clocks"] = {"right": {"offset_s": 150}, "back": {"offset_s": 0.15}}
    said = hall.fault()
    assert "takes.serve: clocks.right: expected an offset with which its video of 2.00 s" in said
    assert said.endswith("found offset_s 150; state the offset in seconds")
    take["clocks"]["right"] = {"offset_s": -0.5}
    assert hall.said() == ([], [])


def cut(hall, trim_s, **offsets_s):
    take = hall.content["takes"]["serve"]
    take.pop("synchronised", None)
    take["trim_s"] = trim_s
    take["clocks"] = {name: {"offset_s": offset_s} for name, offset_s in offsets_s.items()}
    return hall


def test_cameras_whose_parts_share_no_time_are_told(hall):
    """The whole videos of 2 s overlap, the parts that `trim_s` cuts out of them do not."""
    assert cut(hall, [0, 2], right=-0.5, back=0.5).said()[0] == []
    faults, _ = cut(hall, [0.8, 1.2], right=-0.5, back=0.5).said()
    assert ["clocks.right" in line for line in faults] == [True, False]
    assert "overlaps that of another camera, found offset_s -0.5" in faults[0]
    assert "or a longer trim_s: `trim_s` cuts each video at the times of its own" in faults[0]
    faults, _ = cut(hall, [0.8, 1.2], right=-0.5).said()  # when `back` films is not known yet
    assert not any("clocks.right" in line for line in faults)


def test_cameras_whose_parts_share_little_are_a_remark_with_the_part_to_state(hall):
    faults, (remark,) = cut(hall, [0.6, 1.2], right=-0.3, back=0.4).said()
    assert faults == []
    assert "trim_s: all cameras share 0.00 of 0.60 s" in remark
    assert "[0.30, 1.60] lets all show what camera left shows from 0.60 to 1.20 s" in remark
    assert cut(hall, [0.6, 1.2], right=-0.02, back=0.02).said() == ([], [])


@pytest.mark.parametrize(
    ("one", "other", "is_told"),
    [(None, None, True), ([0, 1], [0.5, 2], True), ([1, 2], None, True), ([0, 1], [1, 2], False)],
)
def test_one_video_in_two_takes_is_told_unless_each_has_a_part_of_it(hall, one, other, is_told):
    takes = hall.content["takes"]
    takes["lob"]["videos"] = dict(takes["serve"]["videos"])
    for name, trim_s in (("serve", one), ("lob", other)):
        takes[name] |= {"trim_s": trim_s} if trim_s else {}
    faults, remarks = hall.said()
    assert faults == []
    videos = "videos.left, videos.right, videos.back"
    said = f"hall.yaml: takes.serve and takes.lob: the same {videos}, and their times overlap"
    assert [said in line for line in remarks] == [True] * is_told


@pytest.mark.parametrize(
    ("key", "recording", "named"),
    [
        ("devices", {"suit": {"file": "suit.bvh"}}, "devices.suit"),
        ("pose2d", {"body25b": {"left": "left_json"}}, "pose2d.body25b.left"),
        ("pose3d", {"body25b": {"p1": "p1.trc"}}, "pose3d.body25b.p1"),
    ],
)
def test_other_recordings_in_two_takes_are_told(hall, key, recording, named):
    assert list(stated_times.repeated([hall.session()])) == []
    for take in hall.content["takes"].values():
        take[key] = recording
    (line,) = stated_times.repeated([hall.session()])
    assert f"takes.serve and takes.lob: the same {named}" in line
    assert ("trim_s" in line) == (key != "devices")  # recordings of devices are read completely


def test_recordings_in_two_sessions_are_told_once(hall):
    one = hall.session()
    other = replace(one, name="gym", file="gym.yaml")
    (line,) = stated_times.repeated([one, other])
    videos = "videos.left, videos.right, videos.back"
    assert f"hall.yaml: takes.serve and takes.serve of gym.yaml: the same {videos}, and" in line
    lob = {"lob": one.takes["lob"]}
    assert len(list(stated_times.repeated([one, replace(other, takes=lob)]))) == 1


def test_sessions_may_share_what_is_no_take(hall):
    hall.content |= {"walks": {"w": {"video": "walk.mp4"}}, "board": {"videos": {"left": "b.mp4"}}}
    hall.content["cameras"]["left"] = {"static": "left.mp4"}
    one = hall.session()
    takes = {"serve": replace(one.takes["serve"], videos={"left": "later.mp4"})}
    other = replace(one, name="gym", file="gym.yaml", takes=takes)
    assert list(stated_times.repeated([one, other])) == []
