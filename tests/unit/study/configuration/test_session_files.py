"""Sessions built from their files, and variations of virtual ones."""

import pytest

from courtside.study.configuration import schemas, session_files, sessions

CONTENT = {
    "description": "d",
    "court": "hall",
    "subjects": {"p1": {}, "p2": {"height_m": 1.8}},
    "cameras": {"a": {}, "b": {"crop_px": [1, 2, 3, 4], "name_in_calibration": "B"}},
    "calibration": {"file": "c.toml"},
    "takes": {
        "t1": {"videos": {"a": "1", "b": "2"}, "subjects": ["p2"], "trim_s": [0.5, 2]},
        "t2": {"videos": {"a": "3", "b": "4"}},
    },
    "override": {"step": {"x": 5}},
}


def test_a_session_holds_what_its_file_says():
    parameters = {"step": {"x": 1, "y": 2}, "models": ["m"]}
    found = session_files.session("s", "s.yaml", CONTENT, parameters)
    assert found.court == "hall"
    assert found.subjects["p2"] == sessions.Subject(height_m=1.8)
    assert found.cameras["b"] == sessions.FixedCamera(None, (1, 2, 3, 4), "B")
    assert hash(found.cameras["b"]) == hash(sessions.FixedCamera(None, (1, 2, 3, 4), "B"))
    assert found.cameras["a"].crop_px is None
    assert found.calibration_camera_names() == {"a": "a", "b": "B"}
    assert (found.takes["t1"].subjects, found.takes["t1"].trim_s) == (("p2",), (0.5, 2))
    assert (found.takes["t2"].subjects, found.takes["t2"].trim_s) == (("p1", "p2"), None)
    assert found.parameters == {"step": {"x": 5, "y": 2}, "models": ["m"]}
    assert parameters == {"step": {"x": 1, "y": 2}, "models": ["m"]}


VIRTUAL = {
    "description": "d",
    "court": "badminton",
    "cameras": {
        "side": {"chessboard": {"images": "b", "inner_corners": [7, 4], "square_m": 0.06}},
        "back": {},
    },
    "walks": {"walk": {}},
    "virtual": {
        "preset": "plain",
        "layout": "a",
        "seed": 1,
        "size_px": [640, 360],
        "walk_frames": 40,
        "boards": True,
    },
    "override": {"sweep": {"n_images": [12]}},
}
PARAMETERS = {
    "sweep": {"n_images": [40], "mappers": ["global"]},
    "step": {"x": 1},
    "calibrations": ["sfm-n40"],
    "conditions": {"speed": {"override": {}}},
}


@pytest.mark.parametrize(
    ("header", "placed"),
    [
        (b"camera,x_px,y_px,x_m,y_m,z_m\n", True),
        (b"\xef\xbb\xbfx_m, y_m ,camera\n", True),
        (b'"camera","x_px","y_px","x_m","y_m","z_m"\r\n', True),
        (b'"' + b"x" * 200_000 + b'",x_m\n', False),
        (b"camera,point,frame_idx,x_px,y_px\n", False),
        (b"\xff\xfe\x00x_m", False),
        (b"", False),
    ],
)
def test_a_table_of_points_says_whether_it_states_their_places(tmp_path, header, placed):
    (tmp_path / "p.csv").write_bytes(header)
    content = {"description": "d", "court": "none", "court_points": "p.csv", "cameras": {"a": {}}}
    found = session_files.session("s", "s.yaml", content, PARAMETERS, tmp_path)
    assert (found.placed, found.also_known) == (placed, False)
    asked = content | {"override": {"calibrations": ["file", "known"]}}
    assert session_files.session("s", "s.yaml", asked, PARAMETERS, tmp_path).also_known
    assert not session_files.has_places(tmp_path / "none.csv")


def test_a_session_with_walks_names_its_recordings(tmp_path):
    (tmp_path / "p.csv").touch()
    content = {
        "description": "d",
        "court": "none",
        "court_points": "p.csv",
        "cameras": {"a": {"static": "a.mp4"}},
        "walks": {"w1": {"video": "w1.mp4"}, "w2": {"images": "photos"}},
    }
    found = session_files.session("s", "s.yaml", content, {}, tmp_path)
    assert found.walks == {"w1": "w1.mp4", "w2": "photos"}
    assert (found.court, found.court_points, found.cameras["a"].static) == (None, "p.csv", "a.mp4")
    assert (found.takes, found.subjects, found.calibration_file, found.virtual) == (
        {},
        {},
        None,
        None,
    )
    assert found.cameras_and_walks() == ["a", "w1", "w2"]


def test_a_virtual_session_gets_its_files_by_name():
    found = session_files.session("gym", "gym.yaml", VIRTUAL, PARAMETERS)
    assert found.cameras["side"].static == "results/virtual/gym/side.mp4"
    assert found.cameras["back"].static == "results/virtual/gym/back.mp4"
    assert found.cameras["side"].chessboard["square_m"] == 0.06
    assert found.walks == {"walk": "results/virtual/gym/walk.mp4"}
    assert found.court_points == "results/virtual/gym/court_points.csv"
    assert found.films_boards() and found.condition == {}
    assert found.parameters["sweep"] == {"n_images": [12], "mappers": ["global"]}


def test_a_virtual_session_without_static_frames_has_no_pictures_of_the_empty_hall():
    virtual = VIRTUAL["virtual"] | {"static_frames": 0, "walk_frames": 0}
    content = VIRTUAL | {"virtual": virtual, "walks": {}}
    found = session_files.session("gym", "gym.yaml", content, PARAMETERS)
    assert [camera.static for camera in found.cameras.values()] == [None, None]
    assert (found.cameras_and_walks(), found.recorded_empty()) == (["side", "back"], [])
    varied = session_files.variations(found, "seeds", {"vary": {"seed": [1]}})["seeds-0"]
    assert varied.recorded_empty() == []


def variations(**content):
    base = session_files.session("gym", "gym.yaml", VIRTUAL, PARAMETERS)
    return session_files.variations(base, "speed", {"session": "gym", **content})


def test_every_combination_of_values_is_one_session():
    found = variations(vary={"speed_kmh": [1, 4], "stabiliser": [True, False]})
    assert [s.condition for s in found.values()] == [
        {"condition": "speed", "speed_kmh": 1, "stabiliser": True},
        {"condition": "speed", "speed_kmh": 1, "stabiliser": False},
        {"condition": "speed", "speed_kmh": 4, "stabiliser": True},
        {"condition": "speed", "speed_kmh": 4, "stabiliser": False},
    ]
    assert list(found) == [s.name for s in found.values()] == [f"speed-{k}" for k in range(4)]
    assert found["speed-2"].virtual["speed_kmh"] == 4
    assert found["speed-2"].virtual["stabiliser"] is True


def test_a_variation_has_its_own_files_and_no_boards():
    found = variations(vary={"seed": [7]}, set={"walk_frames": 20})["speed-0"]
    assert found.walks == {"walk": "results/virtual/speed-0/walk.mp4"}
    assert found.cameras["back"].static == "results/virtual/speed-0/back.mp4"
    assert found.court_points == "results/virtual/speed-0/court_points.csv"
    expected = VIRTUAL["virtual"] | {"seed": 7, "walk_frames": 20, "boards": False}
    assert found.virtual == expected
    assert all(camera.chessboard is None for camera in found.cameras.values())
    assert found.calibrations() == []


def test_an_override_of_a_variation_starts_from_that_of_its_session():
    override = {"sweep": {"mappers": ["incremental"]}}
    found = variations(vary={"seed": [7]}, override=override)["speed-0"].parameters
    assert found["sweep"] == {"n_images": [12], "mappers": ["incremental"]}
    assert found["step"] == {"x": 1}
    assert PARAMETERS["sweep"] == {"n_images": [40], "mappers": ["global"]}
    assert PARAMETERS["calibrations"] == ["sfm-n40"]


def test_boards_can_be_asked_for_in_a_variation():
    assert variations(vary={"seed": [7]}, set={"boards": True})["speed-0"].films_boards()


def test_a_virtual_take_gets_the_videos_of_all_cameras():
    filmed = {"motion": "shot", "seconds": 2, "seed": 1, "players": {"p1": {"body": "m1"}}}
    takes = {"t1": {"virtual": filmed, "synchronised": True}}
    content = {
        **VIRTUAL,
        "subjects": {"p1": {}},
        "takes": takes,
        "views": {"two": ["side", "back"]},
    }
    found = session_files.session("gym", "gym.yaml", content, PARAMETERS)
    folder = "results/virtual/gym/takes/t1"
    videos = {"side": f"{folder}/side.mp4", "back": f"{folder}/back.mp4"}
    assert found.takes["t1"] == sessions.Take("t1", videos, ("p1",), None, True, False, filmed)
    assert found.views == {"two": ("side", "back")}
    varied = session_files.variations(found, "speed", {"vary": {"seed": [3]}})["speed-0"]
    assert varied.takes == {}


def test_a_virtual_device_measures_whom_the_simulation_gives_it_to():
    players = {"p2": {"body": "m2"}, "p1": {"body": "m1"}}
    devices = {"suit": {"kind": "inertial", "subject": "p1"}, "depth": {"kind": "rgbd"}}
    filmed = {"motion": "shot", "seconds": 2, "seed": 1, "players": players, "devices": devices}
    content = {
        **VIRTUAL,
        "subjects": {"p1": {}, "p2": {}},
        "takes": {"t1": {"virtual": filmed}},
    }
    found = session_files.session("gym", "gym.yaml", content, PARAMETERS).takes["t1"].devices
    assert {name: device.subject for name, device in found.items()} == {"suit": "p1", "depth": "p2"}


def test_a_session_may_override_lists_of_methods():
    content = {**CONTENT, "override": {"fusions": ["two-dlt"]}}
    found = session_files.session(
        "s", "s.yaml", content, {"fusions": ["all-robust"], "models": ["m"]}
    )
    assert found.parameters == {"fusions": ["two-dlt"], "models": ["m"]}


def test_court_points_that_nobody_has_clicked_are_waited_for(tmp_path):
    content = {
        "description": "d",
        "court": "badminton",
        "cameras": {"a": {"static": "a.mp4"}, "b": {"static": "b.mp4"}},
        "walks": {"w": {"video": "w.mp4"}},
        "court_points": "p.csv",
    }
    parameters = {"calibrations": ["sfm-n40", "known18"], "take_calibrations": ["sfm-n40"]}
    found = session_files.session("s", "s.yaml", content, parameters, tmp_path)
    assert (found.court_points, found.unclicked, found.calibrations()) == (None, "p.csv", [])
    (tmp_path / "p.csv").touch()
    found = session_files.session("s", "s.yaml", content, parameters, tmp_path)
    assert (found.court_points, found.unclicked) == ("p.csv", None)
    assert found.calibrations() == ["sfm-n40", "known18"]


def test_ways_that_need_more_points_than_the_court_has_are_left_out(tmp_path):
    (tmp_path / "p.csv").touch()
    ways = {"calibrations": ["known", "known18", "known8", "dlt20", "known10"]}
    cameras = {name: {"static": f"{name}.png"} for name in "ab"}
    content = {"description": "d", "cameras": cameras, "court_points": "p.csv"}
    file = schemas.SCHEMAS.parents[1] / "config" / "sessions" / "s.yaml"
    for court, found in (
        ("badminton", ["known", "known18", "known8"]),
        ("volleyball", ["known", "known8", "known10"]),
        ("basketball", ["known", "known8", "dlt20"]),
    ):
        made = session_files.session("s", file, content | {"court": court}, ways, tmp_path)
        assert made.calibrations() == found


def test_a_session_replaces_numbers_of_its_calibration_file():
    stated = {"principal_point_px": {"a": [1.0, 2.0]}, "reason": "mirrored in the file"}
    content = CONTENT | {"calibration": {"file": "c.toml", **stated}, "static_points": "p.csv"}
    found = session_files.session("s", "s.yaml", content, {})
    assert (found.calibration_file, found.calibration_override) == ("c.toml", stated)
    assert found.static_points == "p.csv"
    plain = session_files.session("s", "s.yaml", CONTENT, {})
    assert (plain.calibration_override, plain.static_points) == ({}, None)
    assert plain.known_lengths == ()


def test_the_covariance_beside_a_calibration_file_is_that_of_its_cameras(tmp_path):
    cameras, folder = {"a": {}, "b": {"crop_px": [1, 2, 3, 4]}}, tmp_path / "data" / "hall"

    def known(file, **changes):
        content = {"calibration": {"file": file}, "cameras": cameras, **changes}
        return session_files.session("s", "s.yaml", CONTENT | content, {}, tmp_path).file_covariance

    assert known("data/hall/cameras.toml") is None
    folder.mkdir(parents=True)
    (folder / "covariance.npz").touch()
    assert known("data/hall/cameras.toml") == "data/hall/covariance.npz"
    for other in ({"scale": 0.5}, {"name_in_calibration": "B"}):
        assert known("data/hall/cameras.toml", cameras=cameras | {"b": other}) is None
    replaced = {"file": "data/hall/cameras.toml", "principal_point_px": {"a": [1, 2]}}
    assert known("", calibration=replaced | {"reason": "mirrored in the file"}) is None


@pytest.mark.parametrize(("way", "has"), [("sfm-n40", True), ("known", True), ("file", False)])
def test_a_calibration_that_the_study_makes_has_its_covariance_beside_it(way, has):
    folder = f"results/hall/calibration/{way}"
    content = CONTENT | {"calibration": {"file": f"{folder}/cameras.toml"}, "cameras": {"a": {}}}
    found = session_files.session("s", "s.yaml", content, {}).file_covariance
    assert found == (f"{folder}/covariance.npz" if has else None)


def test_known_lengths_are_read():
    lengths = [{"points": ["left", "right"], "length_m": 6.1, "on_floor": True}]
    content = CONTENT | {"static_points": "p.csv", "known_lengths": lengths}
    assert session_files.session("s", "s.yaml", content, {}).known_lengths == tuple(lengths)


def test_points_at_rest_may_lie_beside_the_configuration(tmp_path):
    content = CONTENT | {"static_points": "config/static_points/s.csv"}
    file = tmp_path / "config" / "sessions" / "s.yaml"
    found = session_files.session("s", file, content, {})
    assert found.static_points == str(tmp_path / "config" / "static_points" / "s.csv")


@pytest.mark.parametrize(
    ("whole", "own", "expected"),
    [
        ({}, {}, False),
        (True, {}, True),
        (True, False, False),
        (False, True, True),
        ({}, True, True),
    ],
)
def test_a_session_says_for_all_takes_whether_cameras_share_a_clock(whole, own, expected):
    take = {"videos": {"a": "a.mp4", "b": "b.mp4"}}
    take |= {} if own == {} else {"synchronised": own}
    content = {"description": "d", "court": "none", "subjects": {"p1": {}}}
    content |= {"cameras": {"a": {"scale": 0.5}, "b": {}}, "takes": {"one": take}}
    content |= {} if whole == {} else {"synchronised": whole}
    assert schemas.faults(content, "session", "s.yaml") == []
    found = session_files.session("s", "s.yaml", content, {})
    assert found.takes["one"].synchronised is expected
    assert (found.cameras["a"].scale, found.cameras["b"].scale) == (0.5, 1.0)


def test_sightings_may_be_one_or_several_and_names_stand_in_a_file():
    seen = {"camera": "a", "time_s": 1.0, "at_px": [1, 2]}
    content = CONTENT | {"subjects": {"p1": {"seen": seen}, "p2": {"seen": [seen, seen]}}}
    content |= {"people": "config/people.csv"}
    found = session_files.session("s", "up/sessions/s.yaml", content, {"models": ["m"]})
    assert found.subjects["p1"].seen == (seen,)
    assert found.subjects["p2"].seen == (seen, seen)
    assert found.people == "up/people.csv"


def test_the_ending_of_a_recording_says_what_made_it_and_a_folder_is_of_a_depth_camera(tmp_path):
    folder = tmp_path / "2026-03-02_10.15.30"
    folder.mkdir()
    assert session_files.kind_of(str(folder)) == "rgbd"
    endings = {"a.BVH": "inertial", "a.bag": "rgbd", "a.json": "nuitrack", "a.mp4": "rgb"}
    assert {name: session_files.kind_of(name) for name in endings} == endings
    assert session_files.kind_of(f"{'long' * 100}.mp4") == "rgb"


def test_a_name_of_which_a_file_says_nothing_is_an_empty_part():
    content = {
        "description": "d",
        "cameras": {"a": None, "b": {"scale": 2.0}},
        "takes": {"t": None},
    }
    filled = session_files.filled(content | {"views": {"two": ["a", "b"]}})
    assert filled["cameras"] == {"a": {}, "b": {"scale": 2.0}}
    assert (filled["takes"], filled["views"]) == ({"t": {}}, {"two": ["a", "b"]})
    assert set(filled) == {*content, "views"}
