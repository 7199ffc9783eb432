"""What the files of a folder are, and the program that drafts a session of them."""

import json
import runpy
import shutil
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest
import yaml

from courtside.drafting import survey
from courtside.study.configuration import schemas
from courtside.study.errors import InputError
from fixtures.recordings import video_files
from fixtures.recordings.real_data import REAL, needs_real

PROGRAM = schemas.SCHEMAS.parents[1] / "workflow" / "draft_session.py"
CONFIG = PROGRAM.parents[1] / "config"


@pytest.fixture(scope="module")
def gym(tmp_path_factory):
    """A folder as users have them: spaces, capitals, photos, other files, one broken video."""
    root = tmp_path_factory.mktemp("root")
    folder = root / "data" / "My Gym"
    (folder / "board left").mkdir(parents=True)
    (folder / ".trash").mkdir()
    video_files.write(str(folder / "left.mp4"), n=20, rate=10)
    for name in ("Serve left.MP4", "Serve right.MP4", "walk.mp4", ".trash/old.mp4"):
        shutil.copy(folder / "left.mp4", folder / name)
    (folder / "left.mp4").rename(folder / "left empty.mp4")
    (folder / "cut right.mp4").write_bytes((folder / "walk.mp4").read_bytes()[:900])
    for number in range(3):
        cv2.imwrite(
            str(folder / "board left" / f"{number}.png"), video_files.draw(number, (160, 120))
        )
    cv2.imwrite(str(folder / "right empty.png"), video_files.draw(3, (160, 120)))
    (folder / "clicks.csv").write_text("camera,point,frame_idx,x_px,y_px\nleft,p01,0,1,2\n")
    (folder / "ends.csv").write_text("take,camera,frame_idx,end,x_px,y_px\n")
    (folder / "notes.csv").write_text("who,what\n")
    (folder / "notes.txt").write_text("Remember the net.\n")
    (folder / "Serve.bvh").write_text("HIERARCHY\n")
    return root


def test_every_kind_is_found(gym):
    found = {r.path: r for r in survey.survey(gym / "data" / "My Gym", root=gym)}
    kinds = {path.removeprefix("data/My Gym/"): r.kind for path, r in found.items()}
    assert kinds == {
        "Serve left.MP4": "video",
        "Serve right.MP4": "video",
        "left empty.mp4": "video",
        "walk.mp4": "video",
        "cut right.mp4": "unusable",
        "board left": "photos",
        "right empty.png": "photo",
        "clicks.csv": "court_points",
        "ends.csv": "racket",
        "Serve.bvh": "bvh",
    }
    walk = found["data/My Gym/walk.mp4"]
    assert walk.rate_hz == pytest.approx(10)
    assert walk.duration_s == pytest.approx(2)
    assert walk.parts == ("walk",)
    board = found["data/My Gym/board left"]
    assert (board.size, board.n_photos) == ((160, 120), 3)
    assert found["data/My Gym/cut right.mp4"].note.startswith("expected a video")


def test_numbers_in_names_are_in_order_of_their_values(tmp_path):
    names = ["cam 2/clip (9).mp4", "cam 2/clip (10).mp4", "cam 10/clip (1).mp4"]
    for name in names:
        (tmp_path / name).parent.mkdir(exist_ok=True)
        video_files.write(str(tmp_path / name), n=2, rate=10)
    assert [r.path for r in survey.survey(tmp_path, root=tmp_path)] == names


def test_a_table_of_named_persons_is_known_by_its_columns(tmp_path):
    (tmp_path / "who.csv").write_text("take,subject,camera,time_s,x_px,y_px,from_s,to_s\n")
    (found,) = survey.survey(tmp_path, root=tmp_path)
    assert (found.kind, found.note) == ("people", "")


@pytest.mark.parametrize(
    ("header", "kind"),
    [
        ("camera;point;frame_idx;x_px;y_px\r\n", "court_points"),
        ("point;camera;x_px;y_px;x_m;y_m;z_m\r\nTür;left;1,5;2;0;0;0\r\n", "own_points"),
        ('"camera"\t"point"\t"frame_idx"\t"x_px"\t"y_px"\n', "court_points"),
        ("\ufefftake;subject;camera;time_s;x_px;y_px\r\nKür;p1;left;0,5;1;2\r\n", "people"),
    ],
)
@pytest.mark.parametrize("encoding", ["utf-8", "cp1252"])
def test_a_table_is_known_whatever_a_spreadsheet_writes_between_its_cells(
    tmp_path, header, kind, encoding
):
    (tmp_path / "table.csv").write_bytes(header.encode(encoding, errors="ignore"))
    (found,) = survey.survey(tmp_path, root=tmp_path)
    assert (found.kind, found.note) == (kind, "")


@pytest.mark.parametrize("kind", ["court_points", "people"])
def test_a_table_of_the_name_that_a_draft_gives_is_not_left_out(tmp_path, kind):
    """The check of the session says what is wrong with it; a draft took it for one to come."""
    (tmp_path / f"{kind}.csv").write_text("cam,x,y\nleft,1,2\n")
    (tmp_path / "notes.csv").write_text("cam,x,y\nleft,1,2\n")
    (found,) = survey.survey(tmp_path, root=tmp_path)
    assert (found.path, found.kind) == (f"{kind}.csv", kind)


@pytest.mark.parametrize(
    ("columns", "key"),
    [
        ("picture,camera,corner,x_px,y_px", "board: corners"),
        ("camera,frame,marker,x_px,y_px", "wand: points"),
    ],
)
def test_a_table_of_another_key_is_told_with_the_key(tmp_path, columns, key):
    (tmp_path / "table.csv").write_text(f"{columns}\n")
    (found,) = survey.survey(tmp_path, root=tmp_path)
    note = f"by its columns the table of the key `{key}`; name it there in the session"
    assert (found.kind, found.note) == ("unusable", note)


def test_folders_that_cameras_make_on_their_cards_say_nothing(tmp_path):
    said = "20260503/101SMITH/left.mp4"
    for path in ("A/DCIM/100GOPRO/GX010034.MP4", "B/PRIVATE/M4ROOT/CLIP/C0001.MP4", said):
        (tmp_path / path).parent.mkdir(parents=True)
        (tmp_path / path).write_bytes(b"")
    found = survey.survey(tmp_path, root=tmp_path)
    assert sorted(r.parts for r in found) == [
        ("20260503", "101SMITH", "left"),
        ("A", "GX010034"),
        ("B", "C0001"),
    ]


def test_folders_of_keypoints_are_found(tmp_path):
    for name, count in (("cam1_json", 26), ("odd_json", 7), ("nobody_json", 0)):
        (tmp_path / "pose" / name).mkdir(parents=True)
        for at in range(3):
            people = [{"pose_keypoints_2d": [5.0, 9.0, 0.8] * count}] * bool(count)
            file = tmp_path / "pose" / name / f"cam1_{at:06d}.json"
            file.write_text(json.dumps({"version": 1.3, "people": people}))
    (tmp_path / "pose" / "cam1_json" / "._cam1_000000.json").write_bytes(b"\x00\x05")  # of macOS
    (tmp_path / "other").mkdir()
    for at in range(3):
        (tmp_path / "other" / f"{at}.json").write_text("{}")
    found = {r.path: r for r in survey.survey(tmp_path, root=tmp_path)}
    assert sorted(found) == ["pose/cam1_json", "pose/nobody_json", "pose/odd_json"]
    one = found["pose/cam1_json"]
    assert (one.kind, one.n_frames, one.skeleton) == ("keypoints", 3, (26, ("halpe26",)))
    assert one.parts == ("pose", "cam1_json")
    assert "points, found 7;" in found["pose/odd_json"].note
    assert "points, found nobody;" in found["pose/nobody_json"].note


def test_a_folder_of_depth_is_one_recording(tmp_path):
    folder = tmp_path / "room" / "claps_depth"
    (folder / "depth").mkdir(parents=True)
    cv2.imwrite(str(folder / "depth" / "0.png"), np.zeros((4, 4), np.uint16))
    video_files.write(str(folder / "colour.mp4"), n=5, rate=10)
    (folder / "cameras.toml").write_text("[colour]\n[depth]\n")
    (one,) = survey.survey(tmp_path / "room", root=tmp_path)
    assert (one.path, one.kind, one.parts) == ("room/claps_depth", "depth", ("claps_depth",))
    (one,) = survey.survey(folder, root=tmp_path)
    assert (one.path, one.kind, one.parts) == ("room/claps_depth", "depth", ("claps_depth",))


@pytest.mark.parametrize("steps", [3000, 30000], ids=["1 mm a step", "0.1 mm a step"])
def test_pictures_of_depth_are_no_walk(tmp_path, steps):
    for name, image in (
        ("rgb", np.full((48, 64, 3), 120, np.uint8)),
        ("depth", np.full((48, 64), steps, np.uint16)),
    ):
        (tmp_path / "kinect" / name).mkdir(parents=True)
        for k in range(3):
            cv2.imwrite(str(tmp_path / "kinect" / name / f"{k:06}.png"), image)
    depth, colour = survey.survey(tmp_path, root=tmp_path)
    assert (depth.kind, colour.kind) == ("unusable", "photos")
    assert "pictures of depth" in depth.note and "cameras.toml" in depth.note


def test_an_empty_folder_is_told(tmp_path):
    """Of keypoints, it is one camera less; here nothing was copied."""
    for name in ("pose/cam1_json", "pose/cam2_json", ".hidden"):
        (tmp_path / name).mkdir(parents=True)
    for at in range(3):
        (tmp_path / "pose" / "cam1_json" / f"{at}.json").write_text('{"people": []}')
    found = {r.path: r for r in survey.survey(tmp_path, root=tmp_path)}
    assert sorted(found) == ["pose/cam1_json", "pose/cam2_json"]
    assert found["pose/cam2_json"].kind == "unusable"
    assert found["pose/cam2_json"].note.startswith("an empty folder; copy")
    assert survey.survey(tmp_path / "pose" / "cam2_json", root=tmp_path) == []


@pytest.mark.parametrize("beside", [None, "left.mp4", "more"])
def test_photos_in_the_folder_itself_are_a_walk_if_nothing_else_is_there(tmp_path, beside):
    folder = tmp_path / "data" / "door"
    folder.mkdir(parents=True)
    for number in range(3):
        cv2.imwrite(str(folder / f"IMG_{number}.png"), video_files.draw(number, (160, 120)))
    if beside == "left.mp4":
        video_files.write(str(folder / beside), n=5, rate=10)
    elif beside:
        (folder / beside).mkdir()
    found = survey.survey(folder, root=tmp_path)
    if beside is None:
        (photos,) = found
        assert (photos.kind, photos.n_photos, photos.path) == ("photos", 3, "data/door")
        assert photos.parts == ("door",)
    else:
        assert [one.kind for one in found if one.kind not in ("video", "unusable")] == ["photo"] * 3


def test_a_folder_elsewhere_gives_absolute_paths(gym, tmp_path):
    found = survey.survey(gym / "data" / "My Gym", root=tmp_path)
    assert all(
        Path(recording.path).is_file() or Path(recording.path).is_dir() for recording in found
    )


def test_a_path_other_than_a_folder_is_refused(gym):
    with pytest.raises(InputError, match="found none"):
        survey.survey(gym / "nowhere", root=gym)
    with pytest.raises(InputError, match="found a file"):
        survey.survey(gym / "data" / "My Gym" / "notes.txt", root=gym)


def test_keypoints_of_all_frames_in_one_file_are_told_with_what_to_do(tmp_path):
    (tmp_path / "left_json").mkdir()
    (tmp_path / "left_json" / "alphapose-results.json").write_text('[{"image_id": "0.jpg"}]')
    (tmp_path / "notes.json").write_text("[]")
    (found,) = survey.survey(tmp_path, root=tmp_path)
    assert (found.path, found.kind) == ("left_json/alphapose-results.json", "unusable")
    assert "`AlphaPose_to_OpenPose` of Pose2Sim writes one of each frame from it" in found.note


def test_a_path_with_braces_is_unusable(tmp_path):
    """Snakemake takes what is in them for a wildcard."""
    (tmp_path / "hall {A}").mkdir()
    (tmp_path / "hall {A}" / "suit.bvh").touch()
    (found,) = survey.survey(tmp_path / "hall {A}", root=tmp_path)
    assert (found.kind, found.note) == ("unusable", "braces in its path; rename it")


def test_a_name_with_control_characters_is_unusable(tmp_path):
    (tmp_path / "a\nb.bvh").write_text("HIERARCHY\n")
    (found,) = survey.survey(tmp_path, root=tmp_path)
    assert (found.kind, "rename" in found.note) == ("unusable", True)


@needs_real
def test_real_calibrations_are_told_from_other_text():
    found = survey.survey(REAL / "walk-4cams" / "calibration", root=REAL)
    calibrations = [r for r in found if r.kind == "calibration"]
    assert calibrations[0].path == "walk-4cams/calibration/Calib.qca.txt"
    assert calibrations[0].cameras["cam01"] == (1088, 1920)


def run(root, *arguments):
    command = [sys.executable, str(PROGRAM), *arguments, "--sessions", str(root / "sessions")]
    return subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)


def refused(gym, monkeypatch, *words):
    """Return the one line with which the program refuses some words."""
    (gym / "sessions").mkdir(exist_ok=True)
    monkeypatch.chdir(gym)
    monkeypatch.setattr(sys, "argv", [str(PROGRAM), *words, "--sessions", str(gym / "sessions")])
    with pytest.raises(SystemExit) as ended:
        runpy.run_path(str(PROGRAM), run_name="__main__")
    said = ended.value.code  # a text: the exit status is 1
    assert len(said.splitlines()) == 1
    return said


@pytest.mark.parametrize("court", ["Badminton", "curling", "../courts/badminton"])
def test_an_unknown_court_is_refused_with_those_that_there_are(gym, court, monkeypatch):
    words = ["data/My Gym", "--court", court, "--name", "with-court"]
    known = "none, badminton, basketball, futsal, rectangle-10x5, sports-hall, tennis, volleyball"
    said = refused(gym, monkeypatch, *words)
    assert said.startswith(f"Error: --court: expected one of {known}, found {court}; ")
    assert not list((gym / "sessions").glob("with-court*"))


STUDIES = {path.stem for path in (CONFIG / "sessions").glob("*.yaml")}  # of one session each
OF_CONFIG = {path.stem for path in CONFIG.glob("*.yaml")} - STUDIES


@pytest.mark.parametrize("name", [*sorted(OF_CONFIG), "figures"])
def test_a_session_is_not_called_like_a_file_of_the_configuration(gym, name, monkeypatch):
    said = refused(gym, monkeypatch, "data/My Gym", "--name", name)
    assert said.startswith("Error: --name: expected another name than config, ")
    assert said.endswith(f"found {name}; give the session another name")
    assert not (gym / "sessions" / f"{name}.yaml").exists()


def test_a_folder_called_like_a_file_of_the_configuration_is_refused(gym, monkeypatch):
    (gym / "data" / "Models").mkdir()
    assert "found models; give" in refused(gym, monkeypatch, "data/Models")


def test_a_folder_of_sessions_that_is_not_there_is_told_in_one_line(gym):
    done = run(gym / "data", str(gym / "data" / "My Gym"))
    assert done.returncode == 1
    assert done.stderr.startswith("Error: ") and done.stderr.count("\n") == 1
    assert "--sessions: expected a folder of the files of sessions, found none at" in done.stderr
    assert "sessions; make it, or correct the path" in done.stderr


def test_the_program_drafts_once(gym):
    (gym / "sessions").mkdir(exist_ok=True)
    done = run(gym, "data/My Gym")
    assert done.returncode == 0, done.stderr
    assert "my_gym.yaml" in done.stdout
    content = yaml.safe_load((gym / "sessions" / "my_gym.yaml").read_text())
    assert content["cameras"] == {
        "left": {
            "static": "data/My Gym/left empty.mp4",
            "chessboard": {
                "images": "data/My Gym/board left",
                "inner_corners": [7, 4],
                "square_m": 0.06,
            },
        },
        "right": {"static": "data/My Gym/right empty.png"},
    }
    assert content["walks"] == {"walk": {"video": "data/My Gym/walk.mp4"}}
    assert content["court_points"] == "data/My Gym/clicks.csv"
    assert list(content["takes"]) == ["serve"]
    again = run(gym, "data/My Gym")
    assert again.returncode == 1
    assert again.stderr.count("\n") == 1
    assert again.stderr.startswith("Error: ")
    shorter = {**content, "takes": {}}
    (gym / "sessions" / "my_gym.yaml").write_text(yaml.safe_dump(shorter))
    more = run(gym, "data/My Gym")
    assert (more.returncode, more.stderr) == (0, "")
    assert "\n  serve:\n" in more.stdout
    assert yaml.safe_load((gym / "sessions" / "my_gym.yaml").read_text()) == shorter


def test_the_program_says_when_there_is_nothing(tmp_path):
    (tmp_path / "data").mkdir()
    done = run(tmp_path, "data")
    assert (done.returncode, done.stdout) == (1, "")
    assert "found none" in done.stderr


def linked(link, target):
    try:
        link.symlink_to(target)
    except OSError:
        pytest.skip("this system lets only administrators make links")


def test_folders_on_another_disk_are_followed_but_not_back(tmp_path):
    for camera in ("left", "right"):
        (tmp_path / "disk" / camera).mkdir(parents=True)
        (tmp_path / "disk" / camera / "serve.bvh").write_bytes(b"")
    gym = tmp_path / "gym"
    gym.mkdir()
    for name, target in (("left", "../disk/left"), ("right", "../disk/right"), ("all", "..")):
        linked(gym / name, target)
    linked(tmp_path / "disk" / "left" / "up", "..")
    found = survey.survey(gym, root=gym)
    assert [r.path for r in found] == ["left/serve.bvh", "right/serve.bvh"]


def test_a_link_to_a_disk_that_is_not_there_is_told(tmp_path):
    linked(tmp_path / "left.mp4", "/no such disk/left.mp4")
    linked(tmp_path / "right", "/no such disk/right")
    found = survey.survey(tmp_path, root=tmp_path)
    assert [(r.path, r.kind) for r in found] == [("left.mp4", "unusable"), ("right", "unusable")]
    assert found[0].note == (
        "a link to /no such disk/left.mp4, where nothing is; connect that disk, or copy the "
        "recording here"
    )


@pytest.fixture
def studies(tmp_path):
    """Return a folder of studies, with the program, and one of recordings outside it."""
    home, elsewhere = tmp_path / "my studies", tmp_path / "serves"
    (home / "workflow").mkdir(parents=True)
    (home / "config" / "sessions").mkdir(parents=True)
    shutil.copytree(CONFIG / "courts", home / "config" / "courts")
    shutil.copy(PROGRAM, home / "workflow")
    for name in ("lib", "schemas"):
        (home / "workflow" / name).symlink_to(PROGRAM.parent / name)
    elsewhere.mkdir()
    video_files.write(str(elsewhere / "left.mp4"), n=20, rate=10)
    return home, elsewhere


@pytest.mark.parametrize(("at", "told"), [("home", "`"), ("elsewhere", "In {home}: `")])
def test_the_program_may_be_called_from_the_folder_of_recordings(studies, at, told):
    home, elsewhere = studies
    cwd, folder = (home, elsewhere) if at == "home" else (elsewhere, ".")
    command = [sys.executable, str(home / "workflow" / PROGRAM.name), str(folder)]
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    last = done.stdout.splitlines()[-1]
    assert last == f"{told.format(home=home)}snakemake --configfile config/serves.yaml` makes it."
    content = yaml.safe_load((home / "config" / "sessions" / "serves.yaml").read_text())
    assert content["walks"]["left"]["video"] == str(elsewhere / "left.mp4")


@pytest.mark.parametrize(("given", "name"), [("north/", "north"), (".", "here"), ("a/..", "here")])
def test_a_session_is_called_as_its_folder_or_the_link_to_it(tmp_path, given, name):
    here = tmp_path / "here"
    for folder in (here / "sessions", here / "a"):
        folder.mkdir(parents=True)
    (here / "a" / "serve.bvh").write_bytes(b"")
    linked(here / "north", "a")
    done = run(here, given)
    assert (done.returncode, done.stderr) == (0, "")
    content = yaml.safe_load((here / "sessions" / f"{name}.yaml").read_text())
    assert content["description"] == name
