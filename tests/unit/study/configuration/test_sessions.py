"""Records of sessions and models, and what a session can do with its recordings."""

from dataclasses import replace

import pytest

from courtside.study.configuration import sessions

NETWORK = {"artefact": "a", "member": "m", "sha256": "0" * 64}


DETECTORS = {"blazepose-detector": {"decoder": "blazepose", "min_score": 0.4, "network": NETWORK}}


def test_a_model_passes_what_it_declares_to_its_decoder():
    entry = {
        "decoder": "heatmaps",
        "skeleton": "cpm14",
        "tracking": False,
        "landmarks": {"file": "n.onnx", "sha256": "0" * 64, "outputs": ["maps"]},
        "input": {"size": [192, 256], "channels": "bgr"},
        "flip_test": True,
    }
    model = sessions.model("m", entry, DETECTORS)
    assert model.decoder_options() == {
        "decoder": "heatmaps",
        "outputs": ["maps"],
        "input": {"size": [192, 256], "channels": "bgr"},
        "flip_test": True,
    }
    assert model.detector.decoder_options() == {"decoder": "blazepose", "min_score": 0.4}
    assert not model.tracking
    assert model.landmarks.is_onnx
    assert model.landmarks.path == "n.onnx"


def test_outputs_of_tflite_are_for_its_conversion():
    network = NETWORK | {"outputs": ["Identity"]}
    entry = {"decoder": "blazepose", "skeleton": "s", "landmarks": network}
    model = sessions.model("m", entry, DETECTORS)
    assert model.decoder_options() == {"decoder": "blazepose"}
    assert model.landmarks.outputs == ["Identity"]
    assert not model.landmarks.is_onnx
    assert model.landmarks.path == "results/external/a/m"


def test_a_one_stage_model_has_no_detector():
    network = {"file": "n.onnx", "sha256": "0" * 64}
    entry = {"decoder": "rtmo", "skeleton": "coco17", "landmarks": network, "min_score": 0.5}
    model = sessions.model("m", entry, {})
    assert model.detector is None
    assert model.decoder_options() == {"decoder": "rtmo", "min_score": 0.5}


WAYS = [
    *("file", "sfm-n40", "sim3-n40", "paper-n40", "paper-global-n40"),
    *("known", "board", "wand", "people", "known18", "known8", "dlt18", "known18-board"),
]
FILMED = {"take": sessions.Take("take", {"a": "a.mp4", "b": "b.mp4"}, ())}
SCALED = {  # three cameras, and one person of whom the height is stated
    "cameras": {name: sessions.FixedCamera() for name in "abc"},
    "subjects": {"p1": sessions.Subject(1.7), "p2": sessions.Subject()},
    "takes": {"take": sessions.Take("take", dict.fromkeys("abc", "v.mp4"), ("p1",))},
}
BOARD = {"images": "boards", "inner_corners": [7, 4], "square_m": 0.06}


def session(**changes):
    fields = dict.fromkeys(["court", "calibration_file", "court_points", "virtual"])
    fields |= {"name": "s", "file": "s.yaml", "description": "d", "condition": {}}
    fields |= {
        "subjects": {},
        "takes": {},
        "walks": {},
        "blur_faces": True,
        "views": {},
        "halfbody": None,
    }
    fields |= {"cameras": {name: sessions.FixedCamera(static=f"{name}.png") for name in "ab"}}
    return sessions.Session(**{**fields, "parameters": {"calibrations": WAYS}, **changes})


@pytest.mark.parametrize(
    ("recordings", "ways"),
    [
        ({"calibration_file": "c.toml"}, ["file"]),
        ({"board": {"kind": "charuco"}}, ["board"]),
        ({"board": {"kind": "tags"}, "court_points": "p.csv", "placed": True}, ["board"]),
        ({"wand": {"length_m": 0.5}}, ["wand"]),
        ({"wand": {"length_m": 0.5}, "court_points": "p.csv", "placed": True}, ["wand"]),
        (SCALED, ["people"]),
        (SCALED | {"court": "badminton"}, []),
        (SCALED | {"calibration_file": "c.toml"}, ["file", "people"]),
        (SCALED | {"cameras": {name: sessions.FixedCamera() for name in "ab"}}, []),
        (SCALED | {"takes": {}, "known_lengths": ({"length_m": 6.1},)}, []),
        ({"walks": {"w": "w.mp4"}}, ["sfm-n40"]),
        ({"court_points": "p.csv"}, ["known", "known18", "known8", "dlt18"]),
        ({"court_points": "p.csv", "placed": True}, ["known"]),
        (
            {"court_points": "p.csv", "calibration_file": "c.toml"},
            ["file", "known18", "known8", "dlt18"],
        ),
        (
            {"court_points": "p.csv", "calibration_file": "c.toml", "also_known": True},
            ["file", "known", "known18", "known8", "dlt18"],
        ),
        (
            {"court_points": "p.csv", "walks": {"w": "w.mp4"}},
            [
                way
                for way in WAYS
                if way not in ("file", "known", "board", "wand", "people", "known18-board")
            ],
        ),
        ({"walks": {"w": "photos"}, "cameras": {}}, []),
        ({}, []),
    ],
)
def test_each_session_has_the_calibrations_that_its_recordings_allow(recordings, ways):
    assert session(**recordings).calibrations() == ways


@pytest.mark.parametrize("persons", [("p2",), ("p1", "p2"), ()])
def test_people_alone_calibrate_only_where_something_tells_their_scale(persons):
    """A take tells none where the height of anybody in it is missing."""
    take = replace(SCALED["takes"]["take"], subjects=persons)
    found = session(**SCALED | {"takes": {"take": take}, "calibration_file": "c.toml"})
    assert found.calibrations() == ["file"]
    known = replace(found, known_lengths=({"length_m": 6.1},))
    assert known.calibrations() == ["file", "people"]
    more = {"take": take, "other": replace(take, name="other", subjects=("p1",))}
    assert replace(found, takes=more).calibrations() == ["file", "people"]


def test_cameras_are_resected_one_by_one_in_pictures_of_the_empty_hall_only():
    cameras = {"a": sessions.FixedCamera(static="a.png"), "b": sessions.FixedCamera()}
    assert session(court_points="p.csv", cameras=cameras).calibrations() == ["known"]


def test_lines_are_adjusted_with_the_clicks_of_a_walk():
    ways = {"parameters": {"calibrations": ["sfm-n40", "sfm-n40-lines"]}, "walks": {"w": "w.mp4"}}
    cameras = {"cameras": {"a": sessions.FixedCamera()}}
    clicked = session(**ways, **cameras, court_points="p.csv")
    assert clicked.calibrations() == ["sfm-n40", "sfm-n40-lines"]
    assert session(**ways, **cameras, court_points=None).calibrations() == ["sfm-n40"]


def test_calibration_with_boards_needs_those_of_every_camera():
    every = {name: sessions.FixedCamera(static=f"{name}.png", chessboard=BOARD) for name in "ab"}
    one = {**every, "b": sessions.FixedCamera(static="b.png")}
    made = {"court_points": "p.csv", "cameras": every}
    assert session(**made).calibrations()[-1] == "known18-board"
    assert "known18-board" not in session(**{**made, "cameras": one}).calibrations()
    assert session(cameras=every).calibrations() == []


def test_the_sweep_has_offsets_for_few_images_only():
    sweep = {"n_images": [5, 40, 75], "n_offsets": 3, "offsets_up_to": 40}
    parameters = {"sweep": sweep | {"mappers": ["global", "incremental"]}}
    found = [variant.name for variant in session(parameters=parameters).variants()]
    assert found == [
        *("global-n5-o0", "global-n5-o1", "global-n5-o2"),
        *("global-n40-o0", "global-n40-o1", "global-n40-o2", "global-n75-o0"),
        *("incremental-n5-o0", "incremental-n5-o1", "incremental-n5-o2"),
        *("incremental-n40-o0", "incremental-n40-o1", "incremental-n40-o2", "incremental-n75-o0"),
    ]


def test_only_virtual_sessions_film_boards():
    assert session(walks={"w": "w.mp4"}).cameras_and_walks() == ["a", "b", "w"]
    assert session(walks={"w": "w.mp4"}).recorded_empty() == ["a", "b", "w"]
    assert session(virtual={"boards": True}).films_boards()
    assert not session(virtual={"boards": False}).films_boards()
    assert not session(virtual={}).films_boards()
    assert not session().films_boards()


def test_ways_to_fuse_views_are_those_whose_cameras_a_session_names():
    names = ["all-robust", "two-dlt", "three-dlt", "halfbody"]
    parameters = {"fusions": names[:1], "compared_fusions": names[1:]}
    plain = session(parameters=parameters)
    assert plain.fusions() == ["all-robust"]
    assert plain.fused_cameras("all-robust") == ("a", "b")
    assert plain.fusions("compared_fusions") == []
    halves = {"centre": "b", "left": "a", "right": "c"}
    named = session(parameters=parameters, views={"two": ("b", "a")}, halfbody=halves)
    assert named.fusions("compared_fusions") == ["two-dlt", "halfbody"]
    assert named.fused_cameras("two-dlt") == ("b", "a")
    assert named.fused_cameras("halfbody") == ("b", "a", "c")


def test_a_take_has_the_fusions_of_which_enough_cameras_see_it():
    names = ["all-robust", "two-robust", "halfbody"]
    halves = {"centre": "b", "left": "a", "right": "c"}
    shown = {
        "cameras": {name: sessions.FixedCamera() for name in "abc"},
        "views": {"two": ("b", "c")},
        "halfbody": halves,
        "parameters": {"fusions": names[:1], "compared_fusions": names[1:]},
    }
    found = session(**shown)

    def fused(*cameras):
        take = sessions.Take("t", {name: f"{name}.mp4" for name in cameras}, ())
        return found.fusions_of(take) + found.fusions_of(take, "compared_fusions")

    assert fused("a", "b", "c") == names
    assert fused("a", "b") == ["all-robust"]
    assert fused("c", "b") == ["all-robust", "two-robust"]
    assert fused("a") == fused() == []
    two = sessions.Take("t", {"c": "c.mp4", "b": "b.mp4"}, ())
    assert found.fused_cameras_of(two, "all-robust") == ("b", "c")
    assert found.fused_cameras_of(two, "halfbody") == ()


def test_takes_are_measured_with_those_calibrations_that_the_study_names():
    parameters = {"calibrations": WAYS, "take_calibrations": ["known8", "file", "known18"]}
    found = session(court_points="p.csv", parameters=parameters)
    assert found.take_calibrations() == ["known18", "known8"]


def test_a_walk_measures_takes_only_where_a_court_gives_metres():
    ways = ["sfm-n40", "sfm-n40-people", "file"]
    parameters = {"calibrations": ways, "take_calibrations": ways}
    walked = session(walks={"w": "w.mp4"}, takes=FILMED, parameters=parameters)
    assert walked.calibrations() == ["sfm-n40"]
    assert (walked.take_calibrations(), walked.unscaled()) == ([], ["sfm-n40"])
    beside = replace(walked, calibration_file="c.toml")
    assert (beside.calibrations(), beside.take_calibrations()) == (["sfm-n40", "file"], ["file"])
    on_court = replace(walked, court="badminton", court_points="p.csv")
    assert on_court.take_calibrations() == on_court.calibrations() == ["sfm-n40", "sfm-n40-people"]
    assert on_court.unscaled() == []


@pytest.mark.parametrize(
    ("way", "reads"),
    [
        *((way, True) for way in ("known18-board", "known18-board-people", "people")),
        *((way, True) for way in ("board", "wand", "board-people", "wand-people")),
        *((way, False) for way in ("file", "known", "known18", "dlt18")),
        *((way, False) for way in ("sfm-n40", "sfm-n40-lines", "sfm-n40-people", "paper-n40")),
    ],
)
def test_some_calibrations_read_the_lenses_from_chessboards(way, reads):
    cameras = {name: sessions.FixedCamera(chessboard=BOARD) for name in "ab"}
    assert session(cameras=cameras).chessboards_of(way) == ["a", "b"] * reads
    stated = {"lenses": "c.toml"}
    other = session(cameras=cameras, board=stated, wand=stated).chessboards_of(way)
    assert other == ["a", "b"] * (reads and not way.startswith(("board", "wand")))
    one = {**cameras, "b": sessions.FixedCamera()}
    assert session(cameras=one).chessboards_of("wand") == ["a"]
    assert session(cameras=one).chessboards_of("board") == []


def test_fixed_cameras_measure_a_take_that_enough_of_them_see_where_they_are_calibrated():
    parameters = {"calibrations": WAYS, "take_calibrations": ["file"], "fusions": ["all-robust"]}
    found = session(calibration_file="c.toml", parameters=parameters)
    two, one = FILMED["take"], sessions.Take("one", {"a": "a.mp4"}, ())
    assert (found.measures(two), found.measures(one)) == (True, False)
    assert not session(parameters=parameters).measures(two)


def test_choices_of_images_that_are_the_same_are_made_once(tmp_path):
    sweep = {"n_images": [11, 5], "n_offsets": 3, "offsets_up_to": 40, "mappers": ["global"]}
    parameters = {"sweep": sweep, "map_images": {"rule": "even"}}
    for number in range(11):
        (tmp_path / f"{number}{'.JPG' if number else '.png'}").touch()
    for other in ("notes.txt", "cover.psd", ".hidden.jpg"):
        (tmp_path / other).touch()
    photos = session(parameters=parameters, walks={"door": str(tmp_path)})
    assert photos.n_walk_frames() == 11
    found = [variant.name for variant in photos.variants()]
    assert found == ["global-n11-o0", *(f"global-n5-o{o}" for o in (0, 1, 2))]
    filmed = session(parameters=parameters, walks={"walk": "walk.mp4"})
    assert filmed.n_walk_frames() is None
    assert len(filmed.variants()) == 6
    virtual = session(parameters=parameters, walks={"walk": "w.mp4"}, virtual={"walk_frames": 20})
    found = [variant.name for variant in virtual.variants() if variant.n_images == 11]
    assert found == ["global-n11-o0", "global-n11-o1"]


def test_recordings_are_those_of_the_user_wherever_they_are():
    device = sessions.Device("inertial", "/disk/suit.bvh", "p1")
    videos = {"a": "/disk/a.mp4", "b": "results/external/b.mp4"}
    take = sessions.Take("t", videos, (), devices={"suit": device})
    found = session(takes={"t": take}, walks={"w": "photos"}).recordings()
    assert found[-3:] == ["photos", "/disk/a.mp4", "/disk/suit.bvh"]
    assert "a.png" in found and "results/external/b.mp4" not in found


def test_a_device_says_whether_it_is_a_suit_and_has_a_skeleton():
    found = {kind: sessions.Device(kind, "f", "p1") for kind in ("inertial", "nuitrack", "rgbd")}
    assert [kind for kind, device in found.items() if device.is_suit] == ["inertial"]
    assert found["inertial"].skeleton == "mocopi27"
    assert found["nuitrack"].skeleton == "nuitrack19"
    assert found["rgbd"].skeleton is None


def test_people_refine_a_calibration_that_the_session_has_where_takes_are_filmed():
    ways = ["file", "file-people", "sfm-n40-people"]
    filmed = {"t": sessions.Take("t", {"a": "a.mp4"}, ())}
    made = {"parameters": {"calibrations": ways}, "calibration_file": "c.toml"}
    assert session(**made, takes=filmed).calibrations() == ["file", "file-people"]
    assert session(**made).calibrations() == ["file"]
