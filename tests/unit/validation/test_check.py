"""Mistakes with recordings that users make: each gives one line that names file, camera or take."""

import re
import shutil
from fractions import Fraction
from importlib import import_module
from pathlib import Path

import cv2
import numpy as np
import pytest
import yaml

from courtside.geometry import camera as geometry
from courtside.records.cameras import clicks
from courtside.study.configuration import configuration, schemas, session_faults
from courtside.study.configuration.sessions import Study
from courtside.study.errors import InputError
from courtside.validation import check
from courtside.validation.remembered import Remembered
from fixtures.recordings import rooms_filmed, video_files
from fixtures.recordings.real_data import REAL, needs_real

ROOT = Path(__file__).parents[3]
PARAMETERS = yaml.safe_load((ROOT / "config" / "config.yaml").read_text(encoding="utf-8"))


def test_recordings_as_they_should_be_say_nothing(hall):
    assert schemas.faults(hall.content, "session", "hall.yaml") == []
    assert hall.said() == ([], [])
    for camera, room in (("left", 1), ("right", 2), ("back", 3)):
        static = hall.root / f"{camera}.png"
        cv2.imwrite(str(static), rooms_filmed.background(room))
        hall.content["cameras"][camera] = {"static": str(static)}
    assert hall.said() == ([], [])


def test_a_truncated_video_is_told(hall):
    path = hall.film("left", n=200)
    with path.open("r+b") as stream:
        stream.truncate(path.stat().st_size // 2)
    assert f"{path}: expected a video, found a file without a readable header" in hall.fault()


def test_slow_motion_of_a_phone_is_told(hall):
    pictures = list(rooms_filmed.frames(1))
    tags = {"container": {"movflags": "use_metadata_tags"}}
    said = {"com.android.capture.fps": "240.0"}
    path = hall.video("left")
    video_files.write(path, images=pictures, size=rooms_filmed.SIZE, rate=10, said=said, **tags)
    assert "takes.serve: camera left: expected frames at 240 Hz" in hall.fault()


def test_pixels_that_are_not_square_need_a_calibration_file(hall):
    pictures = list(rooms_filmed.frames(1))
    path = hall.video("left")
    video_files.write(path, images=pictures, size=rooms_filmed.SIZE, rate=10, pixel=Fraction(4, 3))
    assert hall.said() == ([], [])
    hall.content.pop("calibration")
    assert "takes.serve: camera left: expected square pixels where no file" in hall.fault()


def test_a_folder_in_place_of_a_video_is_told(hall):
    folder = hall.video("left").parent
    hall.content["takes"]["serve"]["videos"]["left"] = str(folder)
    assert hall.fault() == f"{folder}: expected a video, found a folder; name the file in it"


def test_a_scaled_video_is_told_and_may_be_declared(hall):
    path = hall.film("left", size=(160, 90))
    hall.film("left", "lob", size=(160, 90))
    said = hall.fault()
    assert said.startswith(f"{path}: expected 320x180 px, the size that camera left")
    assert "found 160x90; if it is a scaled copy, declare `scale: 0.5`" in said
    hall.content["cameras"]["left"] = {"scale": 0.5}
    assert schemas.faults(hall.content, "session", "hall.yaml") == []
    assert hall.said() == ([], [])
    hall.content["cameras"]["left"] = {"scale": 0.25}
    assert "expected 80x45 px as the session file declares, found 160x90" in hall.fault()
    hall.content["cameras"] |= {"left": {"scale": 0.5}, "right": {"scale": 0.5}}
    assert "found 320x180; the video shows all of it: remove `crop_px` and" in hall.fault()


def test_a_cut_out_is_told_and_may_be_declared(hall):
    hall.calibrate(rooms_filmed.SIZE, back=(330, 180))
    said = hall.fault()
    assert "`crop_px: [x, y, 320, 180]`" in said
    assert "scale" not in said
    hall.content["cameras"]["back"] = {"crop_px": [5, 0, 320, 180]}
    assert hall.said() == ([], [])
    hall.content["cameras"]["back"] = {"crop_px": [15, 0, 320, 180]}
    assert "camera back: expected crop_px [x, y, width, height] inside the" in hall.fault()


def test_a_turned_video_is_told(hall):
    hall.calibrate(rooms_filmed.SIZE, back=(180, 320))
    assert "found 320x180; it is turned by a quarter" in hall.fault()


def test_recordings_of_a_camera_have_one_size(hall):
    hall.film("left", size=(160, 90))
    said = hall.fault()
    assert "hall.yaml: cameras.left: expected pictures of one size in all recordings" in said
    assert "160x90 px" in said and "320x180 px" in said


def test_cameras_that_the_calibration_lacks_are_named_with_those_that_it_has(hall):
    hall.content["cameras"]["left"] = {"name_in_calibration": "Links"}
    hall.content["cameras"]["back"] = {"name_in_calibration": "Hinten"}
    said = hall.fault()
    assert "cameras: expected 'Links' (camera left), 'Hinten' (camera back) in " in said
    assert "found left, right, back; give each its `name_in_calibration`" in said


def test_a_calibration_that_cannot_be_read_is_told(hall):
    (hall.root / "cameras.toml").write_text("[cam_0]\nname = 1\n")
    assert "cameras.toml: camera 1: expected size" in hall.fault()


def test_one_file_for_two_cameras_is_told(hall):
    videos = hall.content["takes"]["serve"]["videos"]
    videos["right"] = videos["left"]
    said = hall.fault()
    assert "takes.serve: cameras left and right: expected two views, found one and the same" in said


def test_a_copy_of_a_file_is_told(hall):
    shutil.copy(hall.video("left"), hall.video("back"))
    assert "cameras left and back: expected two views" in hall.fault()


@pytest.mark.parametrize(("size", "crf"), [((320, 180), 36), ((640, 360), 23), ((160, 90), 30)])
def test_a_copy_in_another_quality_and_size_is_told(hall, size, crf):
    for take in ("serve", "lob"):
        rooms_filmed.copied(hall.video("left", take), hall.video("back", take), size=size, crf=crf)
    hall.calibrate(rooms_filmed.SIZE, back=size)
    faults, _ = hall.said()
    assert len(faults) == 2
    assert all("cameras left and back: expected two views" in line for line in faults)


def test_exchanged_cameras_are_told_by_their_static_recordings(hall):
    for camera, room in (("left", 1), ("right", 2), ("back", 3)):
        static = rooms_filmed.film(hall.root / f"{camera}_empty.mp4", room, n=1)
        hall.content["cameras"][camera] = {"static": str(static)}
    hall.exchange("left", "back", takes=("serve", "lob"))
    faults, _ = hall.said()
    assert len(faults) == 2
    for take, line in zip(("serve", "lob"), faults, strict=True):
        assert f"takes.{take}: cameras left and back: expected each camera's own video" in line
        assert "in its static recording; they seem to be exchanged" in line


def test_exchanged_cameras_are_told_by_another_take(hall):
    hall.exchange("left", "right", takes=("lob",))
    assert "takes.lob: cameras left and right: expected each" in hall.fault()
    assert "shows in take serve" in hall.fault()


def test_exchanged_cameras_are_told_by_their_sizes(hall):
    for take in ("serve", "lob"):
        hall.film("back", take, size=(180, 320))
    hall.calibrate(rooms_filmed.SIZE, back=(180, 320))
    assert hall.said() == ([], [])
    hall.exchange("left", "back", takes=("serve", "lob"))
    faults, _ = hall.said()
    assert len(faults) == 2
    assert all("seem to be exchanged: exchange their videos" in line for line in faults)


def test_a_file_of_another_camera_in_another_take_is_told(hall):
    hall.content["takes"]["lob"]["videos"]["back"] = str(hall.video("left"))
    faults, _ = hall.said()
    named = "takes.lob.videos.back: expected a recording of this camera"
    assert any(named in line and "left's of take serve" in line for line in faults)


def filmed_board(hall):
    """Return the videos of a board, those of the first take, in the session."""
    videos = dict(hall.content["takes"]["serve"]["videos"])
    board = {"kind": "tags", "squares": [4, 5], "square_m": 0.1, "dictionary": "DICT_4X4_50"}
    hall.content["board"] = board | {"videos": videos}
    return videos


def test_the_videos_of_a_board_may_be_those_of_a_take(hall):
    filmed_board(hall)
    assert schemas.faults(hall.content, "session", "hall.yaml") == []
    assert hall.said() == ([], [])


def test_videos_of_a_board_that_are_exchanged_against_those_of_a_take_are_told(hall):
    videos = filmed_board(hall)
    videos["left"], videos["back"] = videos["back"], videos["left"]
    faults, _ = hall.said()
    assert len(faults) == 2
    for camera, other, line in zip(("left", "back"), ("back", "left"), faults, strict=True):
        assert f"board.videos.{camera}: expected a recording of this camera, found " in line
        assert f"which is {other}'s of take serve (takes.serve.videos.{other}); correct" in line


def test_other_videos_of_a_board_are_compared_by_what_they_show(hall):
    videos = filmed_board(hall)
    for camera, of in (("left", "right"), ("right", "left")):
        path = hall.root / f"board_{camera}.mp4"
        shutil.copy(hall.video(of, "lob"), path)
        videos[camera] = str(path)
    said = hall.fault()
    assert "board: cameras left and right: expected each camera's own video" in said
    assert "shows in take serve; they seem to be exchanged" in said
    shutil.copy(hall.root / "board_left.mp4", hall.root / "board_right.mp4")
    assert "board: cameras left and right: expected two views, found one" in hall.fault()


def test_one_file_of_a_board_or_of_the_empty_court_for_two_cameras_is_told(hall):
    videos = filmed_board(hall)
    videos["left"] = videos["right"] = str(shutil.copy(hall.video("left"), hall.root / "b.mp4"))
    assert "board.videos.right: expected a recording of this camera, found " in hall.fault()
    assert "b.mp4, which is left's of the board (board.videos.left)" in hall.fault()
    del hall.content["board"]["videos"]
    hall.content["board"]["images"] = {"left": "a", "right": "a", "back": "c"}
    assert "board.images.right: expected a recording of this camera" in hall.fault()
    del hall.content["board"]
    cv2.imwrite(str(hall.root / "empty.png"), rooms_filmed.background(1))
    for camera in ("left", "right"):
        hall.content["cameras"][camera] = {"static": str(hall.root / "empty.png")}
    faults, _ = hall.said()
    assert any("cameras.right.static: expected a recording of this" in line for line in faults)


def test_one_file_may_be_two_takes_of_its_camera(hall):
    hall.content["takes"]["lob"]["videos"] = dict(hall.content["takes"]["serve"]["videos"])
    hall.content["takes"]["lob"]["trim_s"] = [1.0, 2.0]
    assert hall.said()[0] == []
    hall.content["takes"]["serve"]["trim_s"] = [0.0, 1.0]
    assert hall.said() == ([], [])


def test_a_trim_behind_the_end_is_told(hall):
    hall.content["takes"]["lob"]["trim_s"] = [2.5, 4.0]
    faults, _ = hall.said()
    assert len(faults) == 3
    assert all("takes.lob: trim_s: expected a start within" in line for line in faults)


def test_walks_and_devices_are_looked_at(hall):
    walk = hall.root / "walk.mp4"
    walk.write_bytes(b"no video")
    hall.content["walks"] = {"walk1": {"video": str(walk)}}
    webcam = hall.root / "webcam.mp4"
    webcam.write_bytes(b"no video either")
    hall.content["takes"]["lob"]["devices"] = {"webcam": {"file": str(webcam)}}
    faults, _ = hall.said()
    assert [line.split(":")[0] for line in faults] == [str(walk), str(webcam)]


def test_files_of_suits_and_of_nuitrack_are_read_with_the_skeletons_of_the_study(hall):
    devices = {name: hall.root / f"lob.{end}" for name, end in (("suit", "bvh"), ("n", "csv"))}
    for path in devices.values():
        path.write_text("another file", encoding="utf-8")
    hall.content["takes"]["lob"]["devices"] = {n: {"file": str(p)} for n, p in devices.items()}
    suit, nuitrack = hall.said()[0]
    assert f"{devices['suit']}: line 1: expected HIERARCHY" in suit
    assert f"{devices['n']}: expected columns timestamp, id and JOINT" in nuitrack


def test_photos_of_a_walk_are_decoded(hall):
    folder = hall.root / "walk"
    folder.mkdir()
    for at in range(3):
        cv2.imwrite(str(folder / f"{at}.jpg"), rooms_filmed.background(1)[: 180 - 20 * (at == 2)])
    hall.content["walks"] = {"walk1": {"images": str(folder)}}
    first, few = hall.said()[0]
    assert f"{folder / '2.jpg'}: expected 320x180 pixels as in 0.jpg, found 320x160" in first
    assert "walks: expected 40 pictures or more, found 3" in few
    (folder / "2.jpg").write_text("no photo")
    assert f"{folder / '2.jpg'}: expected a photo, found one that is damaged" in hall.said()[0][0]
    cv2.imwrite(str(folder / "2.jpg"), rooms_filmed.background(2))
    assert hall.fault() == few


def test_what_is_not_there_yet_is_left_to_its_job(hall):
    hall.content["calibration"]["file"] = "results/external/elsewhere/cameras.toml"
    hall.content["takes"]["lob"]["videos"] = dict.fromkeys(("left", "right"), "results/none.mp4")
    assert hall.said() == ([], [])


def test_a_calibration_without_any_of_the_cameras_is_told_in_one_line(hall):
    for name in hall.content["cameras"]:
        hall.content["cameras"][name] = {"name_in_calibration": f"{name}_2"}
    faults, _ = hall.said()
    assert len(faults) == 1 and "found left, right, back; give each" in faults[0]


def test_every_fault_is_told_at_once(hall):
    hall.film("left", size=(160, 90))
    hall.film("left", "lob", size=(160, 90))
    hall.content["cameras"]["back"] = {"name_in_calibration": "Hinten"}
    hall.exchange("right", "back", takes=("lob",))
    faults, _ = hall.said()
    assert len(faults) == 3


@pytest.mark.parametrize(("n_photos", "n_cameras"), [(11, 0), (11, 3), (1, 3)])
def test_too_few_photos_are_told_with_keys_that_help(hall, n_photos, n_cameras):
    photos = hall.root / "photos"
    photos.mkdir()
    for number in range(n_photos):
        cv2.imwrite(str(photos / f"{number}.jpg"), rooms_filmed.background(number))
    cameras = {}
    for room, name in enumerate(list(hall.content["cameras"])[:n_cameras], 1):
        cameras[name] = {"static": str(hall.root / f"{name}.png")}
        cv2.imwrite(cameras[name]["static"], rooms_filmed.background(room))
    hall.content |= {"cameras": cameras, "takes": hall.content["takes"] if cameras else {}}
    hall.content["walks"] = {"door": {"images": str(photos)}}
    del hall.content["calibration"]
    said = hall.fault()
    assert f"walks: expected 40 pictures or more, found {n_photos}" in said
    (advice,) = re.findall("`(.+?)`", said)
    hall.content |= yaml.safe_load(advice)
    assert schemas.faults(hall.content, "session", "hall.yaml") == []
    found = session_faults.find(Path("config"), Path("hall.yaml"), hall.content, None, hall.root)
    session = hall.session()
    study = Study({"hall": session}, {}, {}, session.parameters)
    assert [*found, *configuration.unmeasured(study, session)] == []
    assert hall.session().calibrations() == [f"sfm-n{max(2, n_photos)}"] * bool(cameras)
    if n_photos > 1:
        faults, remarks = hall.said()
        assert faults == []
        said = "hall.yaml: court: the walk gives no metres without a court, so takes are not"
        assert [said in line for line in remarks] == [True] * bool(cameras)


@pytest.mark.parametrize(("n", "n_there"), [(38, 21), (41, 22)])
def test_filmed_walks_that_are_too_short_are_told(hall, n, n_there):
    """Of two walks at 10 Hz a frame is taken every 0.5 s, the first one too."""
    walks = {}
    for name, n_frames in (("door", n), ("window", 61)):
        walks[name] = {"video": str(rooms_filmed.film(hall.root / f"{name}.mp4", 1, n=n_frames))}
    hall.content |= {"walks": walks, "cameras": {}, "takes": {}}
    del hall.content["calibration"]
    hall.content["override"] = {"sweep": {"n_images": [n_there + 1]}}
    said = hall.fault()
    assert "hall.yaml: walks: expected " in said
    assert f"found {n_there} in videos, one every 0.5 s; film longer, or ask for fewer by" in said
    hall.content |= yaml.safe_load(re.findall("`(.+?)`", said)[0])
    assert hall.said() == ([], [])


@pytest.mark.parametrize("pair", [(), ("left", "back"), ("right", "back")])
def test_exchanged_cameras_are_told_by_points_at_rest(hall, pair):
    """Names in the calibration exchanged: each camera looks at the same points from elsewhere."""
    xyz = np.random.default_rng(3).uniform((-2, -1, 6), (2, 1, 10), (8, 3))
    cameras = hall.around()
    seen = {camera.name: geometry.project(camera, xyz) for camera in cameras}
    clicks.write(hall.root / "points.csv", seen, [f"q{k}" for k in range(len(xyz))])
    hall.content["static_points"] = str(hall.root / "points.csv")
    assert hall.said() == ([], [])
    for one, other in zip(pair, pair[::-1], strict=True):
        hall.content["cameras"][one] = {"name_in_calibration": other}
    if pair:
        assert f"cameras {pair[0]} and {pair[1]}: expected points at rest" in hall.fault()
        assert "0.0 px with these cameras exchanged" in hall.fault()


@needs_real
@pytest.mark.parametrize("pair", [("cam01", "cam02"), ("cam02", "cam04")])
def test_exchanged_real_cameras_are_told(hall, pair):
    """The file's principal points are as they are: mirrored, which is no exchange."""
    walk = REAL / "walk-4cams"
    names = [f"cam0{k}" for k in (1, 2, 3, 4)]
    videos = {name: str(walk / "videos" / f"{name}.mp4") for name in names}
    hall.content |= {
        "cameras": {name: {} for name in names},
        "calibration": {"file": str(walk / "calibration" / "Calib.qca.txt")},
        "static_points": str(ROOT / "config" / "static_points" / "walk-4cams.csv"),
        "takes": {"balancing": {"videos": videos, "synchronised": True}},
    }
    faults, _ = hall.said()
    assert [line.split("; ")[1][:38] for line in faults] == [
        "if it is a cut-out, declare `crop_px: "
    ] * 2
    for name in names[:2]:
        hall.content["cameras"][name] = {"crop_px": [0, 0, 1080, 1920]}
    assert hall.said() == ([], [])
    for one, other in zip(pair, pair[::-1], strict=True):
        hall.content["cameras"][one] |= {"name_in_calibration": other}
    faults, _ = hall.said()
    assert any(f"cameras {pair[0]} and {pair[1]}: expected points" in line for line in faults)


def test_a_calibration_in_another_unit_is_told(hall):
    hall.calibrate((320, 180), apart=1000)
    assert (
        "camera right: expected it within 300 m of the world's origin, found 1000 m" in hall.fault()
    )
    hall.calibrate((320, 180), apart=100)
    assert "expected cameras 0.1 to 150 m apart, found 200 m" in hall.fault()
    hall.calibrate((320, 180), apart=1000)
    hall.content["calibration"]["unit"] = "mm"
    assert "the file or its format states it, found 'mm'; remove it" in hall.fault()


def test_what_the_check_accepts_the_import_makes(hall, monkeypatch):
    """A video that was cut out, then scaled: the cameras imported for it have its size."""
    hall.calibrate((660, 360))
    hall.content["cameras"] = {
        name: {"crop_px": [20, 0, 640, 360], "scale": 0.5} for name in hall.content["cameras"]
    }
    assert hall.said() == ([], [])
    monkeypatch.syspath_prepend(ROOT / "workflow" / "scripts")
    session, out = hall.session(), [hall.root / name for name in ("out.toml", "quality.json")]
    import_module("import_cameras").main(
        session.calibration_file,
        *out,
        names=session.calibration_camera_names(),
        crops_px={name: camera.crop_px for name, camera in session.cameras.items()},
        scales={name: camera.scale for name, camera in session.cameras.items()},
        override={},
    )
    for camera in geometry.read_toml(out[0]):
        assert camera.size == rooms_filmed.SIZE
        assert np.allclose(camera.K[[0, 0, 1], [0, 2, 2]], [150, (330 - 20 + 0.5) / 2 - 0.5, 89.75])


def test_the_file_of_a_court_is_checked_before_anybody_has_clicked_its_points(hall):
    court = yaml.safe_load(Path("config/courts/volleyball.yaml").read_text(encoding="utf-8"))
    (hall.root / "courts").mkdir()
    hall.content["court"] = "mine"

    def said(**changes):
        (hall.root / "courts" / "mine.yaml").write_text(yaml.safe_dump(court | changes))
        study = Study({"hall": hall.session()}, {}, {}, PARAMETERS, folder=hall.root)
        try:
            return check.check(study, Remembered(hall.root / "looks.json"))
        except InputError as error:
            return error.lines

    assert said() == []
    (millimetres, _) = said(size_m=[9000, 18000])
    where = f"{hall.root}/courts/mine.yaml: "
    assert millimetres.startswith(f"{where}size_m.0: expected at most 1000 (metres above 0), found")
    (exchanged,) = said(size_m=court["size_m"][::-1])
    assert exchanged.startswith(f"{where}expected size_m as [short side, long side], found [18")
