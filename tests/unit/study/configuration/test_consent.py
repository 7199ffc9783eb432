"""What persons have agreed to: what is read, what is left out, what contradicts itself."""

import pytest

from courtside.study.configuration import consent, session_faults, session_files

TAKES = {
    "both": {"videos": {"a": "1.mp4", "b": "2.mp4"}},
    "alone": {"videos": {"a": "3.mp4", "b": "4.mp4"}, "subjects": ["p1"]},
}
CONTENT = {
    "description": "d",
    "court": "none",
    "cameras": {"a": {}, "b": {}},
    "calibration": {"file": "c.toml"},
    "takes": TAKES,
}


def session(p1=None, p2=None, **more):
    content = CONTENT | {"subjects": {"p1": p1, "p2": p2}} | more
    return session_files.session("s", "s.yaml", session_files.filled(content), {})


def agreed(*words):
    return {"consent": list(words)}


def test_a_recorded_person_who_says_nothing_is_measured_and_shown_but_not_handed_on():
    found = session({"height_m": 1.8})
    assert found.subjects["p1"].consent == ("analysis", "pictures")
    assert [consent.refusing(found, found.takes["both"], word) for word in consent.WORDS] == [
        (),
        ("p1", "p2"),
        (),
        ("p1", "p2"),
    ]


def test_nobody_stands_in_a_virtual_session():
    virtual = {"preset": "plain", "layout": "b", "seed": 1, "size_px": [64, 64], "walk_frames": 0}
    filmed = {
        "virtual": {"motion": "shot", "seconds": 1, "seed": 1, "players": {"p1": {"body": "m1"}}}
    }
    found = session(virtual=virtual, takes={"shot": filmed})
    assert found.subjects["p1"].consent == tuple(consent.WORDS)
    assert consent.left_out(found) == []


def test_what_is_stated_counts_also_in_a_virtual_session():
    found = session(
        agreed("analysis"), virtual={"preset": "plain"}, takes={"shot": {"virtual": {}}}
    )
    assert consent.refusing(found, found.takes["shot"], "export") == ("p1",)


def test_a_take_is_shown_only_if_all_in_it_agree():
    found = session(agreed("analysis", "pictures"), agreed("analysis"))
    assert consent.refusing(found, found.takes["both"], "pictures") == ("p2",)
    assert consent.refusing(found, found.takes["alone"], "pictures") == ()


def test_nothing_is_made_of_takes_with_somebody_who_withdrew():
    found = session(agreed("analysis", "export", "pictures"), agreed())
    assert list(found.takes) == ["alone"]
    assert list(found.withheld) == ["both"]
    assert consent.left_out(found) == [
        "nothing is made of take both: p2 has not agreed to analysis (consent)"
    ]


def test_takes_of_keypoints_alone_have_no_pictures():
    alone = {"pose2d": {"coco17": {"a": "a_json", "b": "b_json"}}, "rate_hz": 50}
    found = session(agreed("analysis", "export", "pictures"), takes={"t1": alone, "t2": alone})
    assert consent.left_out(found, []) == [
        "no pictures or videos in takes t1, t2: there are keypoints alone, no videos"
    ]
    assert found.takes["t1"].cameras == ("a", "b")


def test_all_takes_of_somebody_who_withdrew_are_told_in_one_line():
    found = session(agreed(), agreed("analysis", "export", "pictures"))
    assert found.takes == {}
    assert consent.left_out(found) == [
        "nothing is made of takes both, alone: p1 has not agreed to analysis (consent)"
    ]


def test_what_is_left_out_is_said_once_for_the_same_persons():
    found = session(agreed("analysis"), agreed("analysis"), takes={**TAKES, "again": TAKES["both"]})
    lines = consent.left_out(found)
    assert len(lines) == 4  # export and pictures, of p1 and p2 together and of p1 alone
    assert lines[0] == (
        "no files of how they moved for other programs in takes both, again: p1, p2 have not "
        "agreed to export (consent)"
    )
    assert lines[3].startswith("no pictures and videos")
    assert lines[3].endswith("in take alone: p1 has not agreed to pictures (consent)")


def test_an_unknown_word_is_a_programming_fault():
    found = session()
    with pytest.raises(ValueError, match="expected one of"):
        consent.refusing(found, found.takes["both"], "publication")


@pytest.mark.parametrize(
    ("person", "more", "parts"),
    [
        (agreed("pictures"), {}, ["subjects.p1.consent: expected analysis with pictures", "[]"]),
        (agreed("analysis", "faces"), {}, ["expected pictures with faces", "add it"]),
        ({}, {"blur_faces": False}, ["blur_faces: expected `faces` in the consent of p1"]),
    ],
)
def test_contradictions_are_named(person, more, parts):
    content = CONTENT | {"subjects": {"p1": person}} | more
    (line,) = consent.faults("gym.yaml", content)
    assert line.startswith("gym.yaml: ") and "\n" not in line
    assert [part for part in parts if part not in line] == []


@pytest.mark.parametrize(
    ("person", "more"),
    [
        (agreed(), {}),
        ({}, {}),
        (agreed("analysis", "pictures", "faces"), {"blur_faces": False}),
        (agreed("analysis"), {"blur_faces": False}),  # no picture is made, so none shows a face
        ({}, {"blur_faces": False, "virtual": {}}),
    ],
)
def test_what_holds_together_passes(person, more):
    assert list(consent.faults("gym.yaml", CONTENT | {"subjects": {"p1": person}} | more)) == []


def test_recordings_of_somebody_who_withdrew_may_be_deleted(tmp_path):
    (tmp_path / "c.toml").touch()
    for name in ("3.mp4", "4.mp4"):
        (tmp_path / name).touch()

    def faults(p2):
        content = CONTENT | {"subjects": {"p1": {}, "p2": p2}}
        return list(session_faults.find(tmp_path, "gym.yaml", content, {}, tmp_path))

    assert faults(agreed()) == []
    assert [line.split(":")[1] for line in faults({})] == [
        " takes.both.videos.a",
        " takes.both.videos.b",
    ]


def test_no_static_picture_is_made_of_a_video_of_somebody_who_withdrew():
    cameras = {"a": {"static": "1.mp4"}, "b": {"static": "empty.mp4"}, "c": {"static": "3.mp4"}}

    def static(p1, p2):
        return {name: one.static for name, one in session(p1, p2, cameras=cameras).cameras.items()}

    every = {"a": "1.mp4", "b": "empty.mp4", "c": "3.mp4"}
    assert static({}, agreed("analysis")) == every
    assert static({}, agreed()) == {**every, "a": None}  # p2 is not in take alone
    cameras["a"]["static"], every["a"] = "./day/../1.mp4", "./day/../1.mp4"
    assert static({}, agreed()) == {**every, "a": None}  # the same file, by another path
    assert static(agreed(), {}) == {**every, "a": None, "c": None}
