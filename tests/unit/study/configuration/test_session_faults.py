"""What a session's file gets wrong beyond its schema, and what conditions do: one line each."""

import re

import pytest

from courtside.study.configuration import session_faults, session_files, take_faults

FILE = "gym.yaml"
RECORDED = {
    "court": "badminton",
    "cameras": {"a": {"static": "a.mp4"}, "b": {"static": "b.mp4"}},
    "walks": {"w": {"video": "w.mp4"}},
    "court_points": "p.csv",
}
OVERRIDDEN = {
    "calibration": {
        "file": "c.toml",
        "principal_point_px": {"a": [960.0, 540.0]},
        "reason": "mirrored in the file",
    }
}
VIRTUAL = {
    "court": "badminton",
    "cameras": {"side": {}, "back": {}},
    "walks": {"walk": {}},
    "virtual": {
        "preset": "plain",
        "layout": "b",
        "seed": 1,
        "size_px": [640, 360],
        "walk_frames": 9,
    },
}


@pytest.fixture
def root(tmp_path):
    for name in ("a.mp4", "b.mp4", "w.mp4", "p.csv", "c.toml"):
        (tmp_path / name).touch()
    (tmp_path / "placed.csv").write_text("camera,x_px,y_px,x_m,y_m,z_m\n")
    (tmp_path / "courts").mkdir()
    (tmp_path / "courts" / "badminton.yaml").touch()
    return tmp_path


def find(root, content):
    found = list(session_faults.find(root, FILE, content, {}, root))
    assert all("\n" not in line and line.startswith(FILE) for line in found)
    return found


def without(content, *keys):
    return {key: value for key, value in content.items() if key not in keys}


FILMED = {"virtual": {"motion": "shot", "seconds": 2, "seed": 1, "players": {"p1": {"body": "m1"}}}}
ALONE = without(RECORDED, "walks")
BOARD = {"kind": "charuco", "squares": [4, 5], "square_m": 0.1, "dictionary": "DICT_4X4_50"}
BOARD |= {"corners": "p.csv", "lenses": "c.toml"}
BOARDED = {"court": "none", "cameras": RECORDED["cameras"], "board": BOARD}
WAND = {"length_m": 0.5, "points": "p.csv", "lenses": "c.toml"}
SWUNG = without(BOARDED, "board") | {"wand": WAND}
AB = {"a": "a.mp4", "b": "b.mp4"}
PEOPLE = without(BOARDED, "board") | {"subjects": {"p1": {"height_m": 1.7}}}
PEOPLE |= {"override": {"calibrations": ["people"]}}
PEOPLE |= {"cameras": {"a": {}, "b": {}, "c": {}}}
PEOPLE |= {"takes": {"t": {"videos": AB | {"c": "w.mp4"}}}}
LENGTHS = {"known_lengths": [{"points": ["left", "right"], "length_m": 6.1}]}
LENGTHS |= {"static_points": "p.csv"}
UNWALKED = without(VIRTUAL, "walks") | {"virtual": VIRTUAL["virtual"] | {"walk_frames": 0}}
PLAYERS = VIRTUAL | {"subjects": {"p1": {}}, "takes": {"shot": FILMED}}


def simulated(**settings):
    """Return a session whose only take has more settings of its simulation."""
    return PLAYERS | {"takes": {"t": {"virtual": FILMED["virtual"] | settings}}}


@pytest.mark.parametrize(
    "content",
    [
        RECORDED,
        ALONE,
        ALONE | {"court": "none", "court_points": "placed.csv"},
        VIRTUAL,
        PLAYERS | {"views": {"two": ["side", "back"]}},
        without(PLAYERS, "walks")
        | {"virtual": PLAYERS["virtual"] | {"walk_frames": 0}}
        | {"calibration": {"file": "results/gym/calibration/sfm-n40/cameras.toml"}},
        without(RECORDED, "court_points") | {"court": "none"},
        RECORDED | {"walks": {"w": {"video": "w.mp4"}, "v": {"images": "a.mp4"}}},
        without(RECORDED, "walks") | {"calibration": {"file": "c.toml"}},
        without(RECORDED, "walks") | OVERRIDDEN | {"static_points": "p.csv"},
        RECORDED | OVERRIDDEN | {"static_points": "config/courts/badminton.yaml"},
        RECORDED | {"cameras": {"a": {"static": "a.mp4"}}},
        BOARDED,
        SWUNG,
        SWUNG | {"wand": without(WAND, "lenses") | {"program": "argus", "cameras": ["b", "a"]}},
        PEOPLE,
        PEOPLE | LENGTHS,
        PEOPLE | LENGTHS | {"subjects": {"p1": {}}},
        BOARDED | {"board": without(BOARD, "lenses")},
        {"court": "none", "cameras": {}, "walks": {"w": {"images": "w.mp4"}}},
        VIRTUAL
        | {"cameras": {"side": {"chessboard": {"images": "results/virtual/g/boards/side"}}}},
    ],
)
def test_good_sessions_have_no_fault(root, content):
    assert find(root, content) == []


@pytest.mark.parametrize(
    ("content", "parts"),
    [
        (
            RECORDED | {"court": "squash"},
            ["court: expected 'none' or one of ['badminton']", "'squash'"],
        ),
        (
            RECORDED | {"cameras": {"a": {}, "b": {"static": "b.mp4"}}},
            ["cameras.a: expected `static`"],
        ),
        (
            RECORDED | {"walks": {"w": {}}},
            ["walks.w: expected `video` or `images`", "found neither"],
        ),
        (RECORDED | {"walks": {"w": {}}}, ["walks.w: expected `video` or `images`"]),
        (
            RECORDED | {"walks": {"w": {"video": "x.mp4"}}},
            ["walks.w.video: expected a file", "x.mp4"],
        ),
        (
            RECORDED | {"walks": {"a": {"video": "w.mp4"}}},
            ["walks.a: expected a name that no camera has"],
        ),
        (
            RECORDED
            | {
                "court_points": "q.csv",
                "cameras": {"a": {}, "b": {"static": "b.mp4"}},
                "walks": {},
            },
            ["court_points: expected a file", "q.csv"],
        ),
        (
            RECORDED | {"court": "none"},
            ["court_points: expected the columns x_m, y_m and z_m", "found none in p.csv; add"],
        ),
        (
            ALONE | {"court_points": "placed.csv"},
            ["court: expected 'none' beside points with their own places", "found 'badminton'"],
        ),
        (
            RECORDED | {"court_points": "placed.csv"},
            [
                "court_points: expected points of the court by their names beside `walks`",
                "write these places into a court file of your own, config/courts/<court>.yaml",
            ],
        ),
        (
            ALONE | {"cameras": {"a": {"static": "a.mp4"}, "b": {}}},
            ["cameras.b: expected `static` or a video in a take", "the size of its picture"],
        ),
        (
            RECORDED
            | {"calibration": OVERRIDDEN["calibration"] | {"principal_point_px": {"q": 1}}},
            ["calibration.principal_point_px: expected", "'q'"],
        ),
        (
            RECORDED | {"calibration": without(OVERRIDDEN["calibration"], "reason")},
            ["calibration: expected `reason` beside `principal_point_px`, found none"],
        ),
        (
            RECORDED | {"calibration": without(OVERRIDDEN["calibration"], "principal_point_px")},
            ["calibration: expected `principal_point_px` beside `reason`, found none"],
        ),
        (
            RECORDED | {"static_points": "p.csv"},
            ["static_points: expected `calibration` (a file that they check) or `known_lengths`"],
        ),
        (
            without(PEOPLE, "override") | OVERRIDDEN | LENGTHS,
            ["known_lengths: expected `static_points` with their ends, and `people` in overri"],
        ),
        (
            PEOPLE | without(LENGTHS, "static_points"),
            ["known_lengths: expected `static_points` with their ends, and `people` in overri"],
        ),
        (
            RECORDED | OVERRIDDEN | {"static_points": "q.csv"},
            ["static_points: expected a file, found none at q.csv"],
        ),
        (
            RECORDED | {"cameras": {"a": {}, "b": {}}, "walks": {}, "court_points": "q.csv"},
            ["court_points: expected a file, found none at q.csv", "give every camera `static`"],
        ),
        (
            without(RECORDED, "court_points"),
            ["expected `court_points`", "a page to click them on, or set court: none"],
        ),
        (
            without(without(RECORDED, "walks"), "court_points"),
            ["expected `walks`, `court_points`, `board`, `wand` or `calibration`, or"],
        ),
        (
            PEOPLE | {"court": "badminton"},
            ["override.calibrations: expected `people` in a session with court: none"],
        ),
        (
            without(PEOPLE, "takes"),
            ["takes: expected one that fixed cameras film, for the calibration `people`"],
        ),
        (
            PEOPLE | {"cameras": {"a": {}, "b": {}}, "takes": {"t": {"videos": AB}}},
            ["cameras: expected three or more for the calibration `people`, found 2"],
        ),
        (
            PEOPLE | {"subjects": {"p1": {}}},
            ["subjects: expected `height_m` of every person of one take or more"],
        ),
        (
            PEOPLE | {"subjects": {"p1": {"height_m": 1.7}, "p2": {}}},
            ["subjects: expected `height_m` of every person of one take or more"],
        ),
        (
            BOARDED | {"board": BOARD | {"videos": {"a": "a.mp4", "b": "b.mp4"}}},
            ["board: expected one of `images`, `videos` and `corners`, found videos and corners"],
        ),
        (
            BOARDED | {"board": without(BOARD, "corners") | {"videos": {"a": "a.mp4"}}},
            ["board.videos: expected every camera, found none for b"],
        ),
        (
            SWUNG | {"wand": WAND | {"points": "q.csv"}},
            ["wand.points: expected a file, found none at q.csv"],
        ),
        (
            SWUNG | {"wand": WAND | {"program": "dltdv", "cameras": ["b"]}},
            ["wand.cameras: expected each camera of the session once, found b"],
        ),
        (
            SWUNG | {"wand": WAND | {"cameras": ["b", "a"]}},
            ["wand.cameras: expected `program`, found none"],
        ),
        (
            SWUNG | {"wand": WAND | {"markers": ["x", "y", "z"]}},
            ["wand.markers: expected 2 names, found 3", "`middle_m`"],
        ),
        (
            SWUNG | {"wand": WAND | {"middle_m": 0.5}},
            ["wand.middle_m: expected less than length_m (0.5), found 0.5"],
        ),
        (
            SWUNG
            | {"wand": without(WAND, "lenses"), "cameras": {"a": {"static": "a.mp4"}, "b": {}}},
            ["cameras.b: expected `static` or a video in a take"],
        ),
        (
            BOARDED | {"board": BOARD | {"corners": "q.csv"}},
            ["board.corners: expected a file, found none at q.csv"],
        ),
        (
            BOARDED | {"board": without(BOARD, "dictionary")},
            ["board: expected `dictionary` of its markers", "where the board was printed"],
        ),
        (
            BOARDED
            | {"board": without(BOARD, "lenses"), "cameras": {"a": {"static": "a.mp4"}, "b": {}}},
            ["cameras.b: expected `static` or a video in a take"],
        ),
        (
            BOARDED
            | {"board": without(BOARD, "lenses")}
            | {
                "cameras": {
                    "a": {"static": "a.mp4", "chessboard": {"images": "a.mp4"}},
                    "b": {"static": "b.mp4"},
                }
            },
            ["board: expected `chessboard` of every camera or of none, found none for b; add it"],
        ),
        (
            RECORDED
            | {"cameras": {"a": {"static": "a.mp4"}}, "takes": {"t": {"videos": {"a": "a.mp4"}}}}
            | {"subjects": {"p1": {}}},
            ["cameras: expected two or more, found 1"],
        ),
        (BOARDED | {"cameras": {"a": {}}}, ["cameras: expected two or more, found 1"]),
        (SWUNG | {"cameras": {"a": {}}}, ["cameras: expected two or more, found 1"]),
        (
            RECORDED | {"cameras": {"a": {"static": "a.mp4", "chessboard": {"images": "boards"}}}},
            ["cameras.a.chessboard.images: expected a file", "boards"],
        ),
        (VIRTUAL | {"court": "none"}, ["court: expected a court to build the virtual hall around"]),
        (VIRTUAL | {"cameras": {}}, ["virtual: expected cameras"]),
        (without(VIRTUAL, "walks"), ["virtual.walk_frames: expected two or more with a walk"]),
        (
            UNWALKED | {"virtual": VIRTUAL["virtual"] | {"walk_frames": 1}},
            ["virtual.walk_frames: expected two or more with a walk", "found 1 and walks []"],
        ),
        (
            VIRTUAL | {"takes": {"t": FILMED}},
            ["takes.t: expected `subjects`", "name the persons of the take"],
        ),
        (
            PLAYERS | {"takes": {"t": {}}},
            ["takes.t: expected the key 'virtual' and not 'videos' in a virtual session, found []"],
        ),
        (
            PLAYERS
            | {
                "takes": {"t": {"virtual": FILMED["virtual"] | {"players": {"p2": {"body": "m1"}}}}}
            },
            ["takes.t.virtual.players: expected each of ['p1'], found ['p2']"],
        ),
        (
            simulated(devices={"d": {"kind": "rgbd", "rate_hz": 30, "strength": "mild"}}),
            ["takes.t.virtual.devices.d.strength: expected it of a device of the kind inertial"],
        ),
        (
            simulated(devices={"d": {"kind": "inertial", "distance_m": 3}}),
            ["devices.d.distance_m: expected it of a device of the kind rgbd only, found inertial"],
        ),
        (
            simulated(shake={"side": {"knock_deg": 1}}),
            ["takes.t.virtual.shake.side: expected knock_s with a knock_deg above 0, or neither"],
        ),
        (
            simulated(shake={"side": {"knock_s": 1}}),
            ["takes.t.virtual.shake.side: expected knock_s with a knock_deg", "state both"],
        ),
        (
            PLAYERS | {"takes": {"t": {"virtual": FILMED["virtual"] | {"clocks": {"up": {}}}}}},
            ["takes.t.virtual.clocks: expected one of", "found 'up'"],
        ),
        (
            RECORDED
            | {"subjects": {"p1": {}}, "takes": {"t": {"devices": {"d": {"file": "d.bvh"}}}}},
            ["takes.t.devices.d.file: expected a file", "d.bvh"],
        ),
        (
            RECORDED
            | {"subjects": {"p1": {}}}
            | {"takes": {"t": {"devices": {"d": {"file": "a.mp4", "subject": "p2"}}}}},
            ["takes.t.devices.d.subject: expected one of ['p1'], found 'p2'"],
        ),
        (
            RECORDED
            | {"subjects": {"p1": {}}}
            | {"takes": {"t": {"devices": {"d": {"file": "a.mp4", "unit": "m"}}}}},
            ["takes.t.devices.d.unit: expected it of a file .bvh, .json, .csv only, found a.mp4"],
        ),
        (
            RECORDED
            | {"subjects": {"p1": {}}, "takes": {"t": {"devices": {"a": {"file": "a.mp4"}}}}},
            ["takes.t.devices: expected names that no camera has, found 'a'"],
        ),
        (
            RECORDED
            | {"subjects": {"p1": {}}, "takes": {"t": {"devices": {"raw": {"file": "a.mp4"}}}}},
            ["takes.t.devices: expected names that no stage of skeletons has, found 'raw'"],
        ),
        (
            RECORDED
            | {"subjects": {"p1": {}}}
            | {"takes": {"t": {"videos": {"a": "a.mp4"}, "clocks": {"up": {"offset_s": 1.0}}}}},
            ["takes.t.clocks: expected one of ['a'], found 'up'"],
        ),
        (
            RECORDED
            | {"subjects": {"p1": {}}}
            | {"takes": {"t": {"videos": {"a": "a.mp4"}, "clocks": {"a": {"offset_s": 1.0}}}}},
            ["takes.t.clocks.a: expected no offset or drift of the first camera"],
        ),
        (
            RECORDED
            | {"subjects": {"p1": {}}, "synchronised": True}
            | {"takes": {"t": {"videos": AB, "clocks": {"b": {"offset_s": 1.0}}}}},
            ["takes.t.clocks: expected none of cameras that share a clock", "found b; remove"],
        ),
        (
            RECORDED
            | {"subjects": {"p1": {}}}
            | {"takes": {"t": {"devices": {"d": {"file": "a.mp4"}, "e": {"file": "a.mp4"}}}}},
            ["takes.t.devices: expected a recording of each device, found a.mp4 twice"],
        ),
        (
            RECORDED | {"halfbody": {"centre": "a", "left": "b", "right": "a"}},
            ["halfbody: expected three different cameras, found a, b, a; correct one"],
        ),
        (PLAYERS | {"views": {"two": ["side", "up"]}}, ["views.two: expected one of", "'up'"]),
        (
            RECORDED | {"subjects": {"p1": {}}, "takes": {"t": FILMED}},
            [
                "takes.t: expected the key 'videos', 'pose2d' or 'devices' and not 'virtual' in a "
                "recorded session"
            ],
        ),
        (
            VIRTUAL | {"court_points": "p.csv"},
            ["court_points: expected no file of its own", "remove it"],
        ),
        (
            VIRTUAL | {"walks": {"walk": {"video": "w.mp4"}}},
            ["walks.walk.video: expected no file of its own"],
        ),
        (
            VIRTUAL | {"cameras": {"side": {"static": "a.mp4"}}},
            ["cameras.side.static: expected no file"],
        ),
        (
            VIRTUAL | {"virtual": VIRTUAL["virtual"] | {"baseline_deg": 30}},
            ["virtual.baseline_deg: expected it with layout a only, found b; remove it"],
        ),
        (
            VIRTUAL | {"virtual": VIRTUAL["virtual"] | {"static_frames": 0}},
            ["virtual.static_frames: expected 1 or more with a walk", "found 0"],
        ),
    ],
)
def test_a_contradiction_is_one_line(root, content, parts):
    (line,) = find(root, content)
    assert [part for part in parts if part not in line] == []


OTHERS = {"pose2d": {"body25b": {"a": "a.mp4", "b": "b.mp4"}}}


@pytest.mark.parametrize(
    ("take", "override", "parts"),
    [
        (
            {"pose2d": {"spider": {"a": "a.mp4"}}},
            {},
            ["takes.t.pose2d: expected one of", "'spider'"],
        ),
        (
            {"pose2d": {"body25b": {"up": "a.mp4"}}},
            {},
            ["pose2d.body25b: expected one of ['a', 'b']"],
        ),
        ({"pose3d": {"body25b": {"p2": "a.mp4"}}}, {}, ["pose3d.body25b: expected one of ['p1']"]),
        (
            {"pose3d": {"body25b": {"p1": "no.trc"}}},
            {},
            ["pose3d.body25b.p1: expected a file", "no.trc"],
        ),
    ],
)
def test_keypoints_of_other_programs_are_checked(root, take, override, parts):
    (root / "skeletons").mkdir()
    (root / "skeletons" / "body25b.yaml").touch()
    videos = {"videos": {"a": "a.mp4", "b": "b.mp4"}}
    content = RECORDED | {"subjects": {"p1": {}}, "takes": {"t": videos | take}}
    (line,) = find(root, content | {"override": override})
    assert [part for part in parts if part not in line] == []


@pytest.mark.parametrize(
    ("name", "other", "file"),
    [
        ("d415", "d415-depth", "d.bag"),
        ("d415", "d415-rgb", "d.bag"),
        ("web", "web-rgb", "w.mp4"),
        ("suit", "suit-corrected", "s.bvh"),
    ],
)
def test_a_device_may_not_have_the_name_of_a_source_of_another(root, name, other, file):
    def said(other):
        for path in (file, "n.json"):
            (root / path).touch()
        devices = {name: {"file": file}, other: {"file": "n.json"}}
        take = {"t": {"devices": devices}}
        return find(root, RECORDED | {"subjects": {"p1": {}}, "takes": take})

    (line,) = said(other)
    assert f"expected names that no source of another device has, found {other!r}" in line
    assert said(f"{name}-nuitrack") == []


def test_a_file_of_two_persons_is_told(root):
    (root / "skeletons").mkdir()
    (root / "skeletons" / "body25b.yaml").touch()
    take = {"videos": {"a": "a.mp4", "b": "b.mp4"}, "pose3d": {"body25b": {"p1": "a.mp4"}}}
    content = RECORDED | {"subjects": {"p1": {}, "p2": {}}}
    assert find(root, content | {"takes": {"t": take}}) == []
    take["pose3d"]["body25b"]["p2"] = "a.mp4"
    (line,) = find(root, content | {"takes": {"t": take}})
    assert "takes.t.pose3d.body25b: expected a file of each person, found a.mp4 twice" in line


def test_a_take_without_the_keypoints_that_its_session_wants_is_named(root):
    (root / "skeletons").mkdir()
    (root / "skeletons" / "body25b.yaml").touch()
    videos = {"videos": {"a": "a.mp4", "b": "b.mp4"}}
    content = RECORDED | {"subjects": {"p1": {}}, "override": {"models": ["body25b"]}}
    assert find(root, content | {"takes": {"t": videos | OTHERS}}) == []
    (line,) = find(root, content | {"takes": {"t": videos | OTHERS, "u": videos}})
    assert "takes.u.pose2d: expected body25b, as override.models says, found none" in line


ALONE_2D = {"takes": {"t": OTHERS | {"rate_hz": 60}}, "override": {"models": ["body25b"]}}


def unfilmed(root, **changes):
    """Return the faults of a session of keypoints without videos, some of its keys changed."""
    (root / "skeletons").mkdir(exist_ok=True)
    (root / "skeletons" / "body25b.yaml").touch()
    session = {"court": "none", "cameras": {"a": {}, "b": {}}, "subjects": {"p1": {}}}
    return find(root, session | {"calibration": {"file": "c.toml"}} | ALONE_2D | changes)


def test_keypoints_need_no_videos(root):
    assert unfilmed(root) == []
    seen = {"p1": {"seen": {"camera": "b", "time_s": 0, "at_px": [1, 2]}}}
    assert unfilmed(root, subjects=seen) == []


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"cameras": RECORDED["cameras"] | {"all": {"static": "a.mp4"}}}, "cameras.all"),
        ({"subjects": {"all": {}}}, "subjects.all"),
        ({"views": {"all": ["a", "b"]}}, "views.all"),
    ],
)
def test_nothing_is_called_all(root, changes, key):
    (line,) = find(root, RECORDED | changes)
    assert f"{key}: expected another name, found 'all'" in line


@pytest.mark.parametrize(
    ("key", "given"),
    [
        ("court_points", "p.csv"),
        ("board", without(BOARD, "lenses")),
        ("wand", without(WAND, "lenses")),
    ],
)
def test_the_take_of_somebody_who_withdrew_tells_no_size_of_pictures(root, key, given):
    content = {"court": "badminton", "cameras": {"a": {"static": "a.mp4"}, "b": {}}, key: given}
    content |= {"takes": {"t": {"videos": AB}, "u": {"videos": AB, "subjects": ["p2"]}}}
    assert find(root, content | {"subjects": {"p1": {"consent": []}, "p2": {}}}) == []
    (line,) = find(root, content | {"subjects": {"p1": {"consent": []}, "p2": {"consent": []}}})
    assert "cameras.b: expected `static` or a video in a take" in line
    assert "found neither in takes of persons who have agreed to analysis; add one" in line


def test_bridging_images_are_not_tied_to_the_video_of_somebody_who_withdrew(root):
    taken = {"takes": {"t": {"videos": {"a": "a.mp4", "b": "late.mp4"}}}}
    content = RECORDED | taken | {"subjects": {"p1": {"consent": []}}}
    (line,) = find(root, session_files.filled(content))
    assert "cameras.a: expected `static`" in line
    assert "found none (the video of somebody who has withdrawn is none); bridging" in line


def test_clicks_of_pictures_whose_size_nothing_tells_are_named_beside_a_file_too(root):
    clicked = {"court_points": "placed.csv"}
    assert unfilmed(root, **clicked) == []
    asked = {"models": ["body25b"], "calibrations": ["file", "known"]}
    found = unfilmed(root, **clicked, override=asked)
    assert len(found) == 2 and all("which tell the size of its picture" in line for line in found)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"takes": {"t": OTHERS}}, "takes.t.rate_hz: expected the frame rate of the keypoints"),
        ({"override": {}}, "t: expected skeletons of its pose2d alone in override.models, for"),
        ({"override": {"models": ["body25b", "net"]}}, "write `override: {models: [body25b]}`"),
        (
            {"takes": {"t": {"pose2d": {"body25b": {"a": "a.mp4"}}, "rate_hz": 60}}},
            "takes.t.pose2d: expected two cameras or more, found 1",
        ),
        (
            {"takes": {"t": OTHERS | {"rate_hz": 60, "videos": {"a": "a.mp4", "b": "b.mp4"}}}},
            "takes.t.rate_hz: expected it of a take with keypoints and no videos only",
        ),
        (
            {"takes": {"t": OTHERS | {"rate_hz": 60, "clocks": {"a": {"offset_s": 1.0}}}}},
            "takes.t.clocks.a: expected no offset or drift of the first camera",
        ),
        (
            {"calibration": {"file": "c.toml"}, "cameras": {"a": {}, "b": {}, "c": {}}}
            | {"takes": {"t": {"pose2d": OTHERS["pose2d"] | {"coco17": {"c": "c.toml"}}}}}
            | {"takes": {"t": {"videos": dict.fromkeys("abc", "a.mp4"), **OTHERS}}},
            "pose2d.body25b: expected a folder of each camera of the take, found none of c",
        ),
    ],
)
def test_keypoints_without_videos_say_what_videos_would(root, changes, message):
    (line,) = unfilmed(root, **changes)
    assert message in line


def test_keypoints_without_videos_need_a_calibration_file_and_cannot_be_steadied(root):
    (root / "placed.csv").write_text("camera,x_px,y_px,x_m,y_m,z_m\n")
    content = ALONE_2D | {"court": "none"}
    content |= {"cameras": {"a": {"static": "a.mp4"}, "b": {"static": "b.mp4"}}}
    content |= {"subjects": {"p1": {}}, "court_points": "placed.csv"}
    (root / "skeletons").mkdir()
    (root / "skeletons" / "body25b.yaml").touch()
    (line,) = find(root, content)
    assert "takes.t: expected `calibration` in a session with keypoints and no videos" in line
    steady = OTHERS | {"rate_hz": 60, "steady": True}
    (line,) = find(root, content | {"calibration": {"file": "c.toml"}, "takes": {"t": steady}})
    assert "takes.t.steady: expected videos, in which shake is measured" in line


def test_court_points_may_be_clicked_later_where_there_are_pictures_to_click_on(root):
    assert find(root, RECORDED | {"court_points": "q.csv"}) == []


def test_a_session_of_devices_alone_needs_no_cameras(root):
    taken = {"t": {"devices": {"webcam": {"file": "a.mp4"}}}}
    content = {"description": "d", "court": "none", "cameras": {}, "subjects": {"p1": {}}}
    assert find(root, content | {"takes": taken}) == []


@pytest.mark.parametrize(
    ("files", "named", "n_faults"),
    [
        ({"webcam": "a.mp4", "other": "b.mp4"}, "webcam", 1),
        ({"webcam": "a.mp4", "other": "b.mp4"}, "other", 0),
        ({"suit": "s.bvh", "webcam": "a.mp4"}, "webcam", 1),  # suits are compared with others
        ({"suit": "s.bvh", "webcam": "a.mp4"}, "suit", 0),
        ({"suit": "s.bvh"}, "suit", 1),
    ],
)
def test_of_devices_alone_the_clock_of_the_first_is_the_reference(root, files, named, n_faults):
    (root / "s.bvh").touch()
    take = {"devices": {name: {"file": file} for name, file in files.items()}}
    content = {"description": "d", "court": "none", "cameras": {}, "subjects": {"p1": {}}}
    found = find(root, content | {"takes": {"t": take | {"clocks": {named: {"offset_s": 1.0}}}}})
    message = f"takes.t.clocks.{named}: expected no offset or drift of the first device"
    assert [message in line for line in found] == [True] * n_faults


@pytest.mark.parametrize("static", [{"a": {"static": "a.mp4"}, "b": {"static": "b.mp4"}}, {}])
def test_missing_points_without_a_court_are_told_once_and_no_page_is_promised(root, static):
    content = ALONE | {"court": "none", "court_points": "q.csv"}
    content |= {"cameras": ALONE["cameras"] | {"c": {}}, "takes": {"t": {"videos": AB}}}
    content |= {"cameras": static} if static else {}
    found = [line for line in find(root, content) if "court_points" in line]
    assert found == [
        f"{FILE}: court_points: expected a file, found none at q.csv; correct the path or put it "
        "there"
    ]


def test_a_path_that_is_nearly_right_is_told_with_what_is_there(root):
    (root / "Clicks").mkdir()
    (root / "Clicks" / "Points.csv").write_text("camera,x_px,y_px,x_m,y_m,z_m\n")
    found = find(root, ALONE | {"court": "none", "court_points": "clicks\\points.CSV"})
    assert [line for line in found if "court_points" in line] == [
        f"{FILE}: court_points: expected a file, found none at clicks\\points.CSV; did you mean "
        "'Clicks/Points.csv'?"
    ]


@pytest.mark.parametrize("header", ["camera;x_px;y_px;x_m;y_m;z_m", '"x_m"\t"y_m"\t"camera"'])
def test_places_between_other_characters_than_commas_are_places(root, header):
    """What is wrong with them is told where they are read."""
    (root / "placed.csv").write_text(f"{header}\n")
    assert find(root, ALONE | {"court": "none", "court_points": "placed.csv"}) == []


def test_files_of_artefacts_must_be_members(root):
    content = RECORDED | {"court_points": "results/external/pack/points.csv"}
    (line,) = find(root, content)
    assert "court_points: expected a member of external.yaml" in line


FOUND = {"gym": ("gym.yaml", VIRTUAL), "hall": ("hall.yaml", RECORDED)}
NARROW = VIRTUAL | {"virtual": VIRTUAL["virtual"] | {"layout": "a", "baseline_deg": 30}}
FOUND |= {"still": ("still.yaml", UNWALKED), "narrow": ("narrow.yaml", NARROW)}


def conditions(**content):
    condition = {"session": "gym", "vary": {"seed": [1, 2]}, **content}
    config = {"variations": ["speed"], "conditions": {"speed": condition}}
    return session_faults.conditions("config.yaml", config, FOUND)


def test_a_good_condition_has_no_fault():
    assert conditions() == []
    assert conditions(vary={"layout": ["a"], "baseline_deg": [30, 60]}) == []
    assert conditions(set={"layout": "a"}, vary={"baseline_deg": [30, 60]}) == []
    assert conditions(session="still", set={"static_frames": 0}) == []
    axes = {"speed_kmh": [1, 4], "stabiliser": [True, False], "walk_frames": [40]}
    assert conditions(vary={**axes, "seed": [1, 2], "click_seed": [1, 2]}) == []
    assert conditions(vary={**axes, "walk_frames": [40, 80], "world": [{}, {}]}) == []


@pytest.mark.parametrize(
    ("content", "parts"),
    [
        (
            {"session": "nowhere"},
            ["speed.session: expected one of ['gym', 'hall', 'narrow', 'still'], found 'nowhere'"],
        ),
        ({"session": "hall"}, ["speed.session: expected a virtual session, found 'hall'"]),
        (
            {"set": {"seed": 3}},
            ["speed: expected seed in either `set` or `vary`, found it in both"],
        ),
        (
            {"vary": {"baseline_deg": [30]}},
            ["speed.vary.baseline_deg: expected it with layout a only, found b"],
        ),
        (
            {"vary": {"layout": ["a", "b-mirror"]}, "set": {"baseline_deg": 30}},
            ["speed.set.baseline_deg: expected it with layout a only, found b-mirror"],
        ),
        (
            {"vary": {"static_frames": [0, 2], "walk_frames": [9, 12]}},
            ["speed.vary.static_frames: expected 1 or more with a walk", "found 0"],
        ),
        (
            {"vary": {"walk_frames": [1]}},
            ["speed.vary.walk_frames: expected two or more", "found 1 and walks ['walk']"],
        ),
        (
            {"vary": {"walk_frames": [0, 9], "seed": [1, 2]}},
            [
                "speed.vary.walk_frames: expected two or more with a walk",
                "found 0 and walks ['walk']",
            ],
        ),
        (
            {"session": "still", "set": {"walk_frames": 1}},
            ["speed.set.walk_frames: expected two or more with a walk", "found 1 and walks []"],
        ),
        (
            {"session": "narrow", "vary": {"layout": ["a", "b"]}},
            ["speed: virtual.baseline_deg of session narrow: expected it with layout a only"],
        ),
        (
            {"session": "still", "vary": {"zoom": [1, 2]}},
            ["speed.session: expected one with a walk, as its figure needs, found none"],
        ),
        (
            {"vary": {"size_px": [[640, 360], [640, 480]]}},
            ["speed.vary.size_px: expected widths that differ", "found [640, 640]"],
        ),
        (
            {
                "vary": {
                    key: [2, 3] for key in ("speed_kmh", "walk_frames", "seed", "static_frames")
                }
            },
            [
                "speed.vary: expected at most two keys with several values besides seeds",
                "found speed_kmh, walk_frames, static_frames; write further conditions",
            ],
        ),
    ],
)
def test_a_fault_of_a_condition_is_one_line(content, parts):
    (line,) = conditions(**content)
    assert line.startswith("config.yaml: conditions.speed")
    assert [part for part in parts if part not in line] == []


def test_unknown_variations_are_named():
    config = {"variations": ["sped"], "conditions": {"speed": {}}}
    assert session_faults.conditions("config.yaml", config, FOUND) == [
        "config.yaml: variations: expected one of ['speed'], found 'sped'; did you mean 'speed'?"
    ]


@pytest.mark.parametrize("name", ["speed", "speed-0", "speed-12"])
def test_a_session_may_not_have_the_name_of_a_variation(name):
    condition = {"session": "gym", "vary": {"seed": [1]}}
    config = {"variations": ["speed"], "conditions": {"speed": condition}}
    found = FOUND | {name: ("x.yaml", VIRTUAL), "speed-x": ("y.yaml", VIRTUAL)}
    (line,) = session_faults.conditions("config.yaml", config, found)
    assert f"expected a name that no session has, found session '{name}'; rename it" in line


def test_conditions_that_are_not_run_are_not_checked():
    config = {"variations": [], "conditions": {"speed": {"session": "nowhere", "vary": {}}}}
    assert session_faults.conditions("config.yaml", config, FOUND) == []


def test_a_name_that_no_disk_takes_is_a_file_that_is_not_there(root):
    camera = {"static": "x" * 300}
    (line,) = find(root, RECORDED | {"cameras": {"a": camera, "b": {"static": "b.mp4"}}})
    assert "cameras.a.static: expected a file, found none" in line


@pytest.mark.parametrize(
    ("step", "part"),
    [
        ({"takes": {"gym/shot": "body25b"}}, "expected null, for it has a truth, found 'body25b'"),
        ({"takes": {"hall/walk": None}}, r"keypoints \['coco17'\] .* found None"),
        ({"takes": {"hall/walk": "body25b"}}, r"keypoints \['coco17'\] .* found 'body25b'"),
        ({"takes": {"hall/unseen": "coco17"}}, "expected a take with videos"),
        ({"networks": ["resnet"]}, r"expected one of \['full'\], found 'resnet'"),
        ({"skeletons": ["lite"]}, r"skeletons: expected one of \['full'\], found 'lite'"),
        ({"takes": {"gym/shot": None, "hall/walk": "coco17", "elsewhere/shot": None}}, None),
    ],
)
def test_networks_are_compared_with_a_truth_or_with_keypoints_that_are_there(step, part):
    keypoints = {"pose2d": {"coco17": {"a": "json"}}}
    walk = {**keypoints, "videos": {"a": "a.mp4"}}
    hall = {"takes": {"walk": walk, "unseen": keypoints, "empty": {}}}
    found = {"gym": ("gym.yaml", PLAYERS), "hall": ("hall.yaml", hall)}
    step = {"takes": {}, "networks": ["full"], "skeletons": []} | step
    lines = list(take_faults.evaluated("config.yaml", step, ["full"], found))
    assert len(lines) == (part is not None)
    assert all(re.search(part, line) and line.startswith("config.yaml: ") for line in lines)


@pytest.mark.parametrize(
    ("session", "useless"),
    [
        (RECORDED, ["name_in_calibration", "crop_px", "scale"]),
        (BOARDED, ["crop_px", "scale"]),
        (
            BOARDED | {"board": without(BOARD, "lenses")},
            ["name_in_calibration", "crop_px", "scale"],
        ),
        (without(RECORDED, "walks") | {"calibration": {"file": "c.toml"}}, []),
    ],
)
def test_keys_of_cameras_that_a_session_does_not_use_are_told(root, session, useless):
    keys = {"name_in_calibration": "A", "crop_px": [0, 0, 9, 9], "scale": 0.5}
    cameras = {name: said | keys for name, said in session["cameras"].items()}
    found = find(root, session | {"cameras": cameras})
    assert [line.split(": ")[1] for line in found] == [
        f"cameras.{name}.{key}" for name in cameras for key in useless
    ]
    assert all("expected it with a `calibration` file" in line for line in found)
