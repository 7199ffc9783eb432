"""Drafted sessions: what they say, that their schema takes them, what users are told to check."""

import pytest
import yaml

from courtside.drafting import advice
from courtside.drafting import draft as session_draft
from courtside.drafting.recordings import Recording
from courtside.study.configuration import schemas, session_faults, session_files, yaml_files
from courtside.study.errors import InputError
from fixtures.study.drafts import CALIBRATION, TAKE, THREE, WALK, draft, recording


def test_a_whole_session_has_all_its_keys():
    static = recording("data/north/left_empty.mp4"), recording("data/north/right_empty.mp4")
    _, text, content = draft(*TAKE, *static, WALK)
    assert content == {
        "description": "North",
        "court": "badminton",
        "subjects": {"p1": {"consent": ["analysis", "pictures"]}},
        "cameras": {
            "left": {"static": "data/north/left_empty.mp4"},
            "right": {"static": "data/north/right_empty.mp4"},
        },
        "walks": {"walk": {"video": "data/north/walk.mp4"}},
        "court_points": "data/north/court_points.csv",
        "people": "data/north/people.csv",
        "takes": {
            "a": {"videos": {"left": "data/north/a_left.mp4", "right": "data/north/a_right.mp4"}}
        },
    }
    assert "walk.mp4}  # 64x48, 60 Hz, 95.2 s" in text
    assert text.count(session_draft.MARK) >= 6
    assert "click them" in text
    (described,) = (line for line in text.splitlines() if line.startswith("description:"))
    assert "no names of persons, the report shows it" in described  # the folder may be called so


def test_named_persons_are_looked_for_where_pictures_show_them():
    _, text, content = draft(*TAKE, recording("data/north/a/who.csv", "people"))
    assert content["people"] == "data/north/a/who.csv"
    assert "who.csv" not in text.partition("not used")[2]
    assert "people" not in draft(WALK)[2]
    assert "people" not in draft(recording("data/north/mocopi.bvh", "bvh"))[2]


def test_the_workflow_takes_a_draft(tmp_path):
    """All but the files themselves, which are not there, is as a session must be."""
    _, text, _ = draft(*TAKE, WALK)
    path = tmp_path / "sessions" / "north.yaml"
    path.parent.mkdir()
    session_draft.write(path, text)
    folder = schemas.SCHEMAS.parents[1] / "config"
    content = yaml.safe_load(path.read_text())
    found = list(session_faults.find(folder, path, content, None, tmp_path))
    assert [line for line in found if "expected a file, found none" not in line] == []
    assert (
        len(found) == 5
    )  # two videos, the same as static recordings, the walk; clicks may come later
    for camera, video in content["takes"]["a"]["videos"].items():
        assert content["cameras"][camera]["static"] == video


def test_a_take_stands_in_for_the_empty_hall_where_walks_or_clicks_need_its_pictures():
    def static(*recordings, **keys):
        cameras = draft(*recordings, **keys)[2]["cameras"]
        return {camera: said["static"] for camera, said in cameras.items() if "static" in said}

    taken = {"left": "data/north/a_left.mp4", "right": "data/north/a_right.mp4"}
    empty = recording("data/north/left_empty.mp4")
    assert static(*TAKE, WALK) == static(*TAKE) == taken
    more = recording("data/north/b_left.mp4"), recording("data/north/b_right.mp4")
    assert static(*TAKE, *more, WALK, empty) == taken | {"left": empty.path}
    assert static(*TAKE, WALK, CALIBRATION) == taken
    assert static(*TAKE, court="none") == static(*TAKE, CALIBRATION) == {}
    assert static(*TAKE, empty, court="none") == {"left": empty.path}


def test_odd_names_stay_what_they_are():
    odd = 'data/my gym, no. 2/a: "x" #1'
    takes = [recording(f"{odd} {camera}.mp4") for camera in ("left", "right")]
    _, _, content = draft(*takes, title="no", folder="data/my gym, no. 2")
    (take,) = content["takes"].values()
    assert list(take["videos"].values()) == [f"{odd} left.mp4", f"{odd} right.mp4"]
    assert content["description"] == "no"
    assert content["court_points"] == "data/my gym, no. 2/court_points.csv"
    takes = [recording(f"data/x/{camera}.mp4") for camera in ("no", "on", "1")]
    assert list(draft(*takes)[2]["cameras"]) == ["no", "on", "1"]


def test_a_calibration_replaces_clicks_and_its_cameras_are_matched():
    calibration = recording(
        "data/north/Calib.toml",
        "calibration",
        cameras={"Left": (64, 48), "cam": (1, 1), "right": (72, 48)},
    )
    _, text, content = draft(*TAKE, calibration)
    assert content["calibration"] == {"file": "data/north/Calib.toml"}
    assert content["court"] == "none"
    assert "court_points" not in content
    assert content["cameras"] == {
        "left": {"name_in_calibration": "Left"},
        "right": {"crop_px": [0, 0, 64, 48]},
    }
    assert "72x48" in text


@pytest.mark.parametrize("there", ["cam_1", "Cam 01", "CAM-1"])
def test_a_camera_of_a_name_with_other_signs_is_found_in_the_calibration(there):
    films = [recording(f"data/north/serve/cam_{k}.mp4", n_frames=150) for k in (1, 2)]
    cameras = {there: (64, 48), "cam_2": (64, 48)}
    _, _, content = draft(*films, recording("data/north/c.toml", "calibration", cameras=cameras))
    named = {} if there == "cam_1" else {"name_in_calibration": there}
    assert content["cameras"] == {"cam_1": named, "cam_2": {}}


def test_a_camera_unknown_to_the_calibration_is_marked():
    calibration = recording("data/north/c.toml", "calibration", cameras={"int_1_img": (64, 48)})
    _, text, content = draft(*TAKE, calibration)
    assert content["cameras"]["left"] == {"name_in_calibration": "left"}
    assert "one of int_1_img" in text


def folder(path, skeletons=(25, ("body25b", "body25"))):
    parts = tuple(path.split("/")[2:])
    return Recording(path, parts, "keypoints", n_frames=101, skeleton=skeletons)


KEYPOINTS = tuple(folder(f"data/north/pose/{name}_json") for name in ("left", "right"))


def test_a_court_that_is_asked_for_is_written_beside_a_calibration_file():
    """Its painted lines check the file; nobody clicks."""
    assert draft(*TAKE, CALIBRATION)[2]["court"] == "none"
    content = draft(*TAKE, CALIBRATION, court="volleyball")[2]
    assert content["court"] == "volleyball" and "court_points" not in content


def test_keypoints_without_videos_are_a_session_that_wants_their_rate(tmp_path):
    guess, text, content = draft(*KEYPOINTS, CALIBRATION)
    folders = {name: f"data/north/pose/{name}_json" for name in ("left", "right")}
    assert content["takes"] == {"take1": {"pose2d": {"body25b": folders}}}
    assert content["override"] == {"models": ["body25b"]}
    assert (content["court"], content["synchronised"]) == ("none", True)
    assert f"# rate_hz: 60  {session_draft.MARK} no file states it" in text
    assert "25 points are body25b or body25: the points look like body25b" in text
    said = advice.to_check(guess, "north.yaml", "points.csv", "config/north.yaml")
    assert "Keypoints without videos: state `rate_hz` of take1." in said
    folder = schemas.SCHEMAS.parents[1] / "config"
    content["takes"]["take1"]["rate_hz"] = 60
    found = session_faults.find(folder, tmp_path / "north.yaml", content, None, tmp_path)
    assert [line for line in found if "expected a file, found none" not in line] == []
    guess, _, content = draft(*KEYPOINTS)
    assert "court_points" not in content
    said = advice.to_check(guess, "north.yaml", "points.csv", "config/north.yaml")
    assert any("put the calibration file into the folder" in line for line in said)
    assert not any("Court points" in line or "No walk" in line for line in said)


def test_keypoints_beside_videos_are_used_where_all_takes_have_them():
    halpe = [folder(r.path, (26, ("halpe26",))) for r in KEYPOINTS]
    _, text, content = draft(*TAKE, *halpe, CALIBRATION)
    take = content["takes"]["a"]
    assert set(take) == {"videos", "pose2d"}
    assert list(take["pose2d"]) == ["halpe26"]
    assert content["override"] == {"models": ["halpe26"]}
    assert "101 files" in text
    assert "26 points are halpe26\n" in text
    second = [recording(f"data/north/b_{name}.mp4") for name in ("left", "right")]
    beside = [folder(f"data/north/a/{name}_json") for name in ("left", "right")]
    _, _, content = draft(*TAKE, *second, *beside, CALIBRATION)
    assert "pose2d" in content["takes"]["a"]
    assert "pose2d" not in content["takes"]["b"]
    assert "override" not in content


def test_photos_alone_make_a_session_of_any_court():
    photos = Recording("data/door/images", ("images",), "photos", (640, 480), n_photos=12)
    _, text, content = draft(photos, folder="data/door")
    assert content["walks"] == {"images": {"images": "data/door/images"}}
    assert (content["cameras"], content["court"]) == ({}, "none")
    assert "12 photos, 640x480" in text
    assert draft(*TAKE, court="tennis")[2]["court"] == "tennis"
    assert "court_points" not in draft(*TAKE, WALK, court="none")[2]


def test_devices_and_left_over_files_are_told():
    bad = recording("data/north/bad_left.mp4", "unusable", note="expected a video,\nfound none")
    bvh = recording("data/north/a.bvh", "bvh")
    again = recording("data/north/a2.bvh", "bvh")
    chess = recording("data/north/chess.x", "photos")
    _, text, content = draft(*TAKE, WALK, bad, bvh, again, chess)
    assert content["takes"]["a"]["devices"] == {
        "mocopi": {"file": "data/north/a.bvh"},
        "mocopi_2": {"file": "data/north/a2.bvh"},
    }
    assert '#   "data/north/bad_left.mp4": expected a video, found none\n' in text
    assert '"data/north/chess.x"' in text


def test_names_that_a_session_may_not_have_are_replaced():
    long = "practice of the second team before the regional finals " * 2
    names = [f"{long} {k} {camera}" for k in (1, 2) for camera in ("left", "right")]
    names += [f"{take}_{camera}" for take in ("con", "nul") for camera in ("left", "right")]
    files = [recording(f"data/north/{name}.mp4") for name in names]
    files += [recording(f"data/north/{end}.mp4") for end in (f"walk {long}1", f"walk {long}2")]
    _, _, content = draft(*files)
    first, second, *others = content["takes"]
    assert first == "practice_of_the_second_team_before_the_regional_finals"
    assert second == f"{first}_2"
    assert others == ["take3", "take4"]
    assert [len(name) for name in content["walks"]] == [55, 57]


def test_files_of_devices_whose_names_are_replaced_are_takes_of_their_own():
    found, _, _ = draft(*(recording(f"data/x/{name}.bvh", "bvh") for name in ("con", "nul")))
    assert sorted(take for take, *_ in found.devices) == ["take1", "take2"]


def test_a_folder_without_recordings_says_what_is_there():
    with pytest.raises(
        InputError, match=r"data/north: expected videos, .* found none; put"
    ) as told:
        draft()
    assert "\n" not in str(told.value)
    bad = recording("data/north/x.mp4", "unusable", note="expected a video, found text")
    with pytest.raises(
        InputError, match=r"found data/north/x.mp4 \(expected a video, found text\)"
    ):
        draft(bad)


def test_nothing_is_written_over(tmp_path):
    path = tmp_path / "north.yaml"
    path.write_text("mine")
    advice = "found one and left it; delete it to draft it anew, or give another name by --name"
    with pytest.raises(InputError, match=advice):
        session_draft.write(path, draft(*TAKE)[1])
    assert path.read_text() == "mine"


@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("North_Gym", "capital letters; give --name north_gym"),
        *((name, "another; give one by --name") for name in ("external", "External", "a b", "nan")),
        (".yaml", "another; give one by --name"),
    ],
)
def test_a_session_needs_a_name_that_it_may_have(tmp_path, name, found):
    with pytest.raises(InputError, match=f", found {found}$"):
        session_draft.write(tmp_path / f"{name}.yaml", draft(*TAKE)[1])
    assert list(tmp_path.iterdir()) == []


def test_a_draft_that_its_schema_refuses_leaves_no_file(tmp_path):
    with pytest.raises(ValueError, match="schema"):
        session_draft.write(tmp_path / "north.yaml", "description: 1\n")
    assert list(tmp_path.iterdir()) == []


def test_without_a_walk_takes_rest_on_the_clicked_points():
    content = draft(*TAKE)[2]
    parameters = yaml_files.read("config/config.yaml")
    clicked = content | {"court_points": "results/clicks.csv"}
    drafted = session_files.session("north", "config/sessions/north.yaml", clicked, parameters)
    assert drafted.take_calibrations() == ["known"]
    assert "override" not in content
    assert "override" not in draft(*TAKE, WALK)[2]
    assert "override" not in draft(*TAKE, court="none")[2]


def uncommented(text):
    """Return a draft in which the line on people alone counts, in place of another `override`."""
    lines = [line for line in text.splitlines() if not line.startswith("override:")]
    return "\n".join(line.replace("# override:", "override:") for line in lines)


@pytest.mark.parametrize("beside", [False, True])
def test_three_cameras_without_a_court_may_be_calibrated_by_people_alone(tmp_path, beside):
    names = ("left", "right", "back") if beside else ()
    halpe = [folder(f"data/north/pose/{name}_json", (26, ("halpe26",))) for name in names]
    guess, text, content = draft(*THREE, *halpe, court="none")
    assert "calibrations" not in content.get("override", {})
    assert text.count("# override: {") == 1
    assert "remove the first #" in text and "state height_m of every person" in text
    alone = yaml.safe_load(uncommented(text))
    models = {"models": ["halpe26"]} if beside else {}
    assert alone["override"] == {"calibrations": ["people"]} | models
    alone["subjects"]["p1"]["height_m"] = 1.74
    config = schemas.SCHEMAS.parents[1] / "config"
    found = session_faults.find(config, tmp_path / "n.yaml", alone, None, tmp_path)
    assert [line for line in found if "expected a file, found none" not in line] == []
    parameters = yaml_files.read("config/config.yaml")
    session = session_files.session("north", "config/sessions/north.yaml", alone, parameters)
    assert session.take_calibrations() == ["people"]
    said = "\n".join(advice.to_check(guess, "north.yaml", None, "config/north.yaml"))
    assert "or use the draft's line for people alone" in said


def test_a_study_of_the_session_alone_is_written_once(tmp_path):
    path = tmp_path / "north.yaml"
    assert session_draft.write_study(path, "north", ["a", "b"]) == f"Wrote {path}."
    said = yaml.safe_load(path.read_text())
    assert said == {
        "sessions": ["north"],
        "plans": [],
        "variations": [],
        "calibrations": list(session_draft.WAYS),
        "export_overlay_video": {"takes": ["north/a", "north/b"]},
    }
    folder = schemas.SCHEMAS.parents[1] / "config"
    config = yaml.safe_load((folder / "config.yaml").read_text())
    assert set(session_draft.WAYS) <= set(config["calibrations"]) & set(config["take_calibrations"])
    videos = config["export_overlay_video"] | said["export_overlay_video"]
    config |= said | {"export_overlay_video": videos}
    assert schemas.faults(config, "config", "north.yaml") == []
    path.write_text("mine")
    assert "name north among its `sessions`" in session_draft.write_study(path, "north", ["a"])
    assert path.read_text() == "mine"


@pytest.mark.parametrize("name", ["20260302", "2026_03_02", "2026-03-02", "007", "1e3", "on"])
def test_the_study_of_a_session_called_like_a_number_or_a_date_names_it(tmp_path, name):
    path = tmp_path / "study.yaml"
    session_draft.write_study(path, name, ["a"])
    said = yaml.safe_load(path.read_text())
    assert said["sessions"] == [name]
    assert said["export_overlay_video"] == {"takes": [f"{name}/a"]}


def test_a_half_size_video_is_drafted_as_a_scaled_copy():
    calibration = recording(
        "data/north/c.toml", "calibration", cameras={"left": (128, 96), "right": (48, 64)}
    )
    _, text, content = draft(*TAKE, calibration)
    assert content["cameras"] == {"left": {"scale": 0.5}, "right": {}}
    assert "a scaled copy of the calibrated 128x96 px" in text
    assert "turned against the calibrated 48x64 px" in text


def test_cameras_are_found_in_the_calibration_by_their_serial_number():
    videos = [
        recording(f"data/north/Serve_Miqus_{k}_{23086 + k}.avi", n_frames=150) for k in (1, 2)
    ]
    cameras = {"23087": (64, 48), "23088": (64, 48)}
    _, _, content = draft(
        *videos, recording("data/north/c.qca.txt", "calibration", cameras=cameras)
    )
    assert content["cameras"] == {
        "miqus1": {"name_in_calibration": "23087"},
        "miqus2": {"name_in_calibration": "23088"},
    }
    assert list(content["takes"]) == ["serve"]


def test_as_many_frames_are_taken_for_one_clock():
    alike = [recording(r.path, n_frames=150) for r in TAKE]
    guess, text, content = draft(*alike)
    assert content["synchronised"] is True
    assert "remove it if they were started by hand" in text
    lines = advice.to_check(guess, "north.yaml", "c.csv", "n.yaml")
    assert any(line.startswith("Clocks: as many frames") for line in lines)
    other = [alike[0], recording(TAKE[1].path, n_frames=151)]
    assert "synchronised" not in draft(*other)[2]
    assert "synchronised" not in draft(*TAKE)[2]


def test_few_pictures_of_a_walk_are_asked_for():
    photos = Recording("data/door/images", ("images",), "photos", (640, 480), n_photos=11)
    _, _, content = draft(photos, folder="data/door")
    assert content["override"] == {"sweep": {"n_images": [11], "n_offsets": 1}}
    short = recording("data/north/walk.mp4", duration_s=10.0)
    _, _, content = draft(*TAKE, short)
    assert content["override"] == {
        "sweep": {"n_images": [16], "n_offsets": 1},
        "calibrations": ["sfm-n16"],
        "take_calibrations": ["sfm-n16"],
    }


def test_devices_alone_make_a_session():
    one = recording("data/suit/jump.bvh", "bvh", size=None, rate_hz=None, duration_s=None)
    other = recording("data/suit/arm raise.bvh", "bvh", size=None, rate_hz=None, duration_s=None)
    guess, _, content = draft(one, other, folder="data/suit")
    assert (content["cameras"], content["court"]) == ({}, "none")
    assert content["takes"] == {
        "jump": {"devices": {"mocopi": {"file": "data/suit/jump.bvh"}}},
        "arm_raise": {"devices": {"mocopi": {"file": "data/suit/arm raise.bvh"}}},
    }
    lines = advice.to_check(guess, "suit.yaml", "c.csv", "n.yaml")
    assert not any(line.startswith(("Odd", "No walk", "Court")) for line in lines)


def test_a_single_view_is_a_take_of_devices():
    film = recording("data/room/balance_webcam.mp4", note="frames come at irregular times")
    suit = recording("data/room/balance_mocopi.bvh", "bvh", size=None)
    guess, _, content = draft(film, suit, folder="data/room")
    assert (content["cameras"], content["court"]) == ({}, "none") and "walks" not in content
    assert content["takes"] == {
        "balance": {"devices": {"webcam": {"file": film.path}, "mocopi": {"file": suit.path}}}
    }
    lines = advice.to_check(guess, "room.yaml", None, "n.yaml")
    assert f"Odd: {film.path}: {film.note}" in lines
    assert not any(line.startswith(("No walk", "Court", "Cameras")) for line in lines)


def test_cameras_without_names_are_marked():
    videos = [recording(f"data/north/IMG_{n}.MOV") for n in ("0007", "1234")]
    _, text, content = draft(*videos)
    assert list(content["cameras"]) == ["cam1", "cam2"]
    assert text.count("no name tells the cameras apart") == 2


def test_clicks_beside_a_calibration_are_not_passed_over():
    calibration = recording(
        "data/north/c.toml", "calibration", cameras={"left": (64, 48), "right": (64, 48)}
    )
    clicked = recording("data/north/clicks.csv", "court_points")
    _, text, content = draft(*TAKE, calibration, clicked)
    assert not {"court_points", "static_points"} & set(content)
    assert '"data/north/clicks.csv": clicked points; as `static_points`' in text


def test_points_with_their_own_coordinates_need_no_court_and_no_page():
    points = recording("data/north/court_points.csv", "own_points")
    guess, text, content = draft(*THREE, points)
    assert (content["court"], content["court_points"]) == ("none", points.path)
    assert content["cameras"] == {"left": {}, "right": {}, "back": {}}  # nothing is clicked
    assert "click them" not in text and "not used" not in text
    assert "calibrations: [people]" not in text
    for court in (None, "data/north/court_points.csv"):  # as the command says it with --court none
        said = advice.to_check(guess, "n.yaml", court, "s.yaml")
        (line,) = (line for line in said if "points" in line)
        assert line == (
            "Cameras: they will be calibrated from the points with their own coordinates in "
            "data/north/court_points.csv."
        )


def test_points_with_their_own_coordinates_beside_other_ways_are_told():
    points = recording("data/north/points.csv", "own_points")
    _, text, content = draft(*TAKE, CALIBRATION, points)
    assert "court_points" not in content
    said = "points with their own coordinates; without `calibration` they calibrate"
    assert f'"data/north/points.csv": {said}' in text
    guess, _, content = draft(*TAKE, WALK, points)  # the check tells that a walk needs a court
    assert content["court_points"] == points.path
    lines = advice.to_check(guess, "n.yaml", points.path, "s.yaml")
    assert not any("will be calibrated" in line for line in lines)


def test_of_recordings_that_all_fit_nowhere_the_commonest_reason_is_told():
    names = ("left/IMG_E0001", "left/IMG_0001", "right/IMG_0007", "right/IMG_0008")
    films = [recording(f"data/north/{name}.MOV") for name in names]
    told = (
        r"found data/north/left/IMG_0001.MOV \(no name tells .* \(left 1, right 2\).* and 3 more;"
    )
    with pytest.raises(InputError, match=told):
        draft(*films)


@pytest.mark.parametrize(
    ("there", "named"),
    [
        ({"cam_01", "cam_02"}, {"kamera1": "cam_01", "kamera2": "cam_02"}),
        ({"cam_2", "Left1"}, {"kamera1": "Left1", "kamera2": "cam_2"}),
        ({"cam_0", "cam_1"}, None),  # counted from 0
        ({"cam_1", "cam_2", "cam_3"}, None),
        ({"cam_1", "view_1", "cam_2"}, None),
        ({"a1", "b1"}, None),
        ({"left", "cam_1"}, None),
    ],
)
def test_cameras_of_a_calibration_are_told_by_their_numbers(there, named):
    films = [recording(f"data/north/a_Kamera {n}.mp4") for n in (1, 2)]
    calibration = recording(
        "data/north/c.toml", "calibration", cameras=dict.fromkeys(sorted(there), (64, 48))
    )
    _, text, content = draft(*films, calibration)
    found = {name: camera["name_in_calibration"] for name, camera in content["cameras"].items()}
    assert found == (named or {"kamera1": "kamera1", "kamera2": "kamera2"})
    assert text.count(f"{session_draft.MARK} the same number there") == (2 if named else 0)
