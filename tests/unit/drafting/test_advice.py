"""What users are told to check after a session is drafted."""

from courtside.drafting import advice
from courtside.drafting import guess as session_guess
from fixtures.study.drafts import CALIBRATION, TAKE, THREE, WALK, draft, recording


def guessed(*recordings):
    return session_guess.guess(list(recordings))


def test_files_that_are_not_used_are_told_at_once():
    """Otherwise a video that is cut short is one camera less, and nobody notices."""
    bad = recording("data/north/a_back.mp4", "unusable", note="expected a video,\nfound none")
    more = [recording(f"data/north/{at}.mp4", "unusable", note="cut short") for at in range(6)]
    said = advice.to_check(draft(*TAKE, bad)[0], "n.yaml", "c.csv", "s.yaml")
    assert said[1] == "Not used: data/north/a_back.mp4: expected a video, found none"
    said = advice.to_check(draft(*TAKE, bad, *more)[0], "n.yaml", "c.csv", "s.yaml")
    assert said[6] == "Not used: 2 more"
    said = advice.to_check(draft(*TAKE)[0], "n.yaml", "c.csv", "s.yaml")
    assert not any("Not used" in line for line in said)


def test_no_page_for_clicks_is_promised_without_a_court():
    guess, text, _ = draft(*TAKE, court="none")
    assert "calibrations" not in text and "static" not in text
    said = "\n".join(advice.to_check(guess, "n.yaml", None, "s.yaml"))
    assert "Cameras: nothing in the folder tells how they stand" in said
    assert not any(part in said for part in ("Court points", "No walk", "people alone"))
    walked = advice.to_check(draft(*THREE, WALK, court="none")[0], "n.yaml", None, "s.yaml")
    assert not any(line.startswith(("Cameras", "Court points")) for line in walked)
    (court,) = (line for line in walked if line.startswith("Court: "))
    assert "gives no metres without a court, so takes are not measured; name a court" in court
    for others in ((CALIBRATION,), (WALK,)):
        assert "calibrations: [people]" not in draft(*THREE, *others, court="none")[1]
    assert "calibrations: [people]" not in draft(*THREE)[1]


def test_a_page_for_clicks_has_a_picture_of_every_camera():
    static = [recording(f"data/north/{name}_empty.mp4") for name in ("left", "right")]
    start = "Court points: the first run makes a page"
    for films in (static, ()):
        guess, text, *_ = draft(*TAKE, *films)
        said = advice.to_check(guess, "n.yaml", "c.csv", "s.yaml")
        assert sum(line.startswith(start) and line.endswith("for c.csv.") for line in said) == 1
        assert text.count("static: ") == 2


def test_what_to_check_names_what_is_odd(tmp_path):
    slow = recording("data/north/a_right.mp4", rate_hz=25.0, duration_s=60.0, size=(32, 48))
    static = recording("data/north/right_empty.mp4"), recording("data/north/left_empty.mp4")
    walk = recording("data/north/walk.mp4", note="frames come at irregular times")
    guess = guessed(TAKE[0], slow, *static, walk)
    points = "data/north/court_points.csv"
    lines = advice.to_check(guess, tmp_path / "north.yaml", points, "config/north.yaml")
    said = "\n".join(lines)
    for part in ("camera right has pictures of 32x48 and 64x48", "25 and 30 Hz", "twofold"):
        assert part in said
    assert "walk.mp4: frames come at irregular times" in said
    assert "data/north/court_points.csv" in said
    assert "--configfile config/north.yaml" in said
    assert "No walk" not in said
    lines = advice.to_check(guessed(*TAKE), tmp_path / "north.yaml", "c.csv", "n.yaml")
    assert any(line.startswith("No walk") for line in lines)
    assert [line for line in lines if line.startswith("Odd")] == [
        "Odd: take a is 5.0 s long: in less than 15 s the clocks of cameras are seldom found; "
        "say `synchronised: true` if they share one"
    ]
    long = [recording(r.path, duration_s=15.0) for r in TAKE]
    lines = advice.to_check(guessed(*long), tmp_path / "north.yaml", "c.csv", "n.yaml")
    assert not any(line.startswith("Odd") for line in lines)


def test_one_video_alone_may_be_a_person_whom_one_camera_sees():
    def said(*recordings):
        return "\n".join(advice.to_check(guessed(*recordings), "n.yaml", None, "s.yaml"))

    match = recording("data/north/match.mp4")
    assert "Odd: data/north/match.mp4 is the only video, and was taken for a walk" in said(match)
    assert "is the only video" not in said(WALK)  # it says that it is one
    assert "is the only video" not in said(match, *TAKE)


def test_names_of_another_script_are_said():
    videos = [recording(f"data/north/{c}カメラ_試技1.mp4") for c in ("左", "右")]
    guess, _, content = draft(*videos)
    assert list(content["cameras"]) == ["left", "right"]
    said = "\n".join(advice.to_check(guess, "north.yaml", "c.csv", "n.yaml"))
    assert "camera left (data/north/左カメラ_試技1.mp4)" in said
    assert "take trial1 (data/north/左カメラ_試技1.mp4)" in said


def odd(*recordings):
    lines = advice.to_check(guessed(*recordings), "n.yaml", "c.csv", "s.yaml")
    return [line for line in lines if line.startswith("Odd")]


def test_takes_that_only_the_order_of_files_makes_are_told():
    films = [
        recording(f"data/north/{camera}/clip ({number}).mp4", duration_s=20.0)
        for camera, numbers in (("left", (8, 9)), ("right", (1, 2)))
        for number in numbers
    ]
    (line,) = odd(*films)
    assert "those of take1, take2 were put together in the order of each camera's files" in line


def test_videos_of_unlike_lengths_in_a_take_are_told():
    films = {"clip1_left": 24.0, "clip1_right": 14.0}
    (line,) = odd(*(recording(f"data/north/{n}.mp4", duration_s=s) for n, s in films.items()))[:1]
    assert line == (
        "Odd: take clip1 has videos of 14.0 to 24.0 s; check that they show one recording"
    )


def test_takes_of_as_many_frames_in_each_camera_may_be_copies():
    def told(**n_frames):
        films = [
            recording(f"data/north/{name}.mp4", n_frames=count) for name, count in n_frames.items()
        ]
        return [line for line in advice.to_check(guessed(*films), "n", "c", "s") if "copy" in line]

    one = {"a_left": 610, "a_right": 633, "b_left": 700, "b_right": 690}
    assert told(**one, old_a_left=610, old_a_right=633) == [
        "Odd: takes a and old_a have as many frames in each camera; is one a copy?"
    ]
    assert told(**one) == []
    assert told(a_left=600, a_right=600, b_left=600, b_right=600) == []  # a fixed length


def test_a_static_trial_of_a_person_may_be_the_empty_court():
    def told(*names):
        films = [recording(f"data/north/{name}.mp4") for name in names]
        said = advice.to_check(guessed(*TAKE, *films), "n", "c", "s")
        return [line for line in said if "if a person stands there" in line]

    (line,) = told("static_left", "static_right")
    assert line.startswith("Odd: data/north/static_left.mp4 and the other videos called `static`")
    assert told("static_left") == told("static_empty_left", "static_empty_right") == []
    assert told("neutral_left", "neutral_right") == []
