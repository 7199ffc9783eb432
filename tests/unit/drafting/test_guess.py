"""Which camera, walk and take recordings belong to, by the words of their names alone."""

from pathlib import PurePosixPath

import pytest

from courtside.drafting import guess as session_guess
from courtside.drafting.recordings import Recording
from courtside.study.configuration import configuration


def recordings(*paths, **kinds):
    """Return recordings of a folder `gym`: videos, but where a suffix says otherwise."""
    by_suffix = {
        ".jpg": "photo",
        ".bvh": "bvh",
        ".bag": "bag",
        ".csv": "court_points",
        "": "photos",
    }
    found = []
    for path in map(PurePosixPath, paths):
        kind = kinds.get(path.stem, by_suffix.get(path.suffix, "video"))
        parts = (*path.parts[:-1], path.stem)
        found.append(Recording(f"gym/{path}", parts, kind, (64, 48), 30.0, 5.0))
    return found


def guess(*paths, **kinds):
    given = recordings(*paths, **kinds)
    found = session_guess.guess(given)
    placed = [*found.walks.values(), *found.boards.values()]
    placed += found.static.values()
    placed += [r for take in found.takes.values() for r in take.values()]
    placed += [r for r, _ in found.unused] + [r for *_, r in found.devices]
    placed += [r for r in (found.court_points, found.calibration) if r]
    filmed = [r for take in found.takes.values() for r in take.values()]
    placed += [r for t in found.keypoints.values() for r in t.values() if r not in filmed]
    assert sorted(r.path for r in placed) == sorted(r.path for r in given)  # each exactly once
    return found


def paths(by_name):
    return {name: recording.path.removeprefix("gym/") for name, recording in by_name.items()}


def test_names_as_in_the_manual_are_understood():
    found = guess(
        "centre_empty.mp4",
        "left_empty.mp4",
        "smash1_centre.mp4",
        "smash1_left.mp4",
        "smash2_centre.mp4",
        "smash2_left.mp4",
        "walk1.mp4",
        "board_left",
        "court_points.csv",
        "smash2.bvh",
    )
    assert found.cameras == ["centre", "left"]
    assert paths(found.static) == {"centre": "centre_empty.mp4", "left": "left_empty.mp4"}
    assert paths(found.takes["smash1"]) == {
        "centre": "smash1_centre.mp4",
        "left": "smash1_left.mp4",
    }
    assert list(found.takes) == ["smash1", "smash2"]
    assert paths(found.walks) == {"walk1": "walk1.mp4"}
    assert paths(found.boards) == {"left": "board_left"}
    assert found.court_points.path == "gym/court_points.csv"
    assert [(take, device) for take, device, _ in found.devices] == [("smash2", "mocopi")]
    assert not found.unused


def test_odd_cases_spaces_and_accents():
    found = guess("Übung 2 Kamera 01.MOV", "Übung 2 Kamera 2.MOV", "Gehen walk.mov")
    assert found.cameras == ["kamera01", "kamera2"]
    assert list(found.takes) == ["ubung2"]
    assert list(found.walks) == ["gehen_walk"]


def test_what_all_names_share_names_neither_cameras_nor_takes():
    found = guess(*(f"north_{take}_{camera}.mp4" for take in "ab" for camera in ("left", "right")))
    assert found.cameras == ["left", "right"]
    assert list(found.takes) == ["a", "b"]


def test_a_single_take_keeps_its_name():
    assert list(guess("smash_left.mp4", "smash_right.mp4").takes) == ["smash"]
    assert list(guess("left.mp4", "right.mp4").takes) == ["take1"]


def test_cameras_without_known_words_are_told_by_what_differs():
    found = guess("a.mp4", "b.mp4", "c.mp4")
    assert found.cameras == ["a", "b", "c"]
    found = guess("serve_x.mp4", "serve_y.mp4", "lob_x.mp4", "lob_y.mp4")
    assert (found.cameras, list(found.takes)) == (["x", "y"], ["serve", "lob"])


def test_folders_for_cameras_and_folders_for_takes():
    found = guess("cam1/serve.mp4", "cam1/lob.mp4", "cam2/serve.mp4", "cam2/lob.mp4")
    assert paths(found.takes["lob"]) == {"cam1": "cam1/lob.mp4", "cam2": "cam2/lob.mp4"}
    found = guess("serve/cam1.mp4", "serve/cam2.mp4", "lob/cam1.mp4", "lob/cam2.mp4")
    assert paths(found.takes["lob"]) == {"cam1": "lob/cam1.mp4", "cam2": "lob/cam2.mp4"}


def test_numbers_that_each_camera_counts_for_itself():
    names = ("left/GX010034", "left/GX010035", "right/GX010107", "right/GX010108")
    found = guess(*(f"{name}.MP4" for name in names))
    assert list(found.takes) == ["take1", "take2"]
    assert paths(found.takes["take2"]) == {
        "left": "left/GX010035.MP4",
        "right": "right/GX010108.MP4",
    }


@pytest.mark.parametrize("numbers", [(1, 2, 7, 8), (1, 2, 1, 2)])
def test_sony_counts_in_the_folder_of_each_camera(numbers):
    folders = ("left", "left", "right", "right")
    names = [f"{f}/C{number:04d}.MP4" for f, number in zip(folders, numbers, strict=True)]
    found = guess(*names)
    assert found.cameras == ["left", "right"]
    takes = [paths(take) for take in found.takes.values()]
    assert takes == [{"left": names[k], "right": names[k + 2]} for k in range(2)]


def test_a_walk_that_players_walk_is_a_take():
    found = guess("walk01_cam1.mp4", "walk01_cam2.mp4")
    assert list(found.takes) == ["walk01"]
    assert not found.walks


def test_photos_alone_are_a_walk():
    found = guess("photos")
    assert (paths(found.walks), found.cameras) == ({"photos": "photos"}, [])
    found = guess(
        "left_empty.jpg", "right_empty.jpg", "serve_left.mp4", "serve_right.mp4", "photos"
    )
    assert paths(found.walks) == {"photos": "photos"}


def test_photos_of_the_empty_court_are_static():
    found = guess("left_empty.jpg", "a_left.mp4", "a_right.mp4", "right_empty.jpg")
    assert paths(found.static) == {"left": "left_empty.jpg", "right": "right_empty.jpg"}
    found = guess("tall_empty.jpg", "serve_tall.mp4", "serve_low.mp4", "low_empty.jpg")
    assert set(found.static) == {"tall", "low"}


def test_pictures_of_the_empty_court_may_be_counted():
    found = guess(
        "left_empty_01.mp4", "right_empty_01.mp4", "right_empty_02.mp4", "a_left.mp4", "a_right.mp4"
    )
    assert paths(found.static) == {"left": "left_empty_01.mp4", "right": "right_empty_01.mp4"}
    assert paths(found.takes["a"]) == {"left": "a_left.mp4", "right": "a_right.mp4"}
    assert [r.path for r, _ in found.unused] == ["gym/right_empty_02.mp4"]
    assert not found.walks


def test_what_fits_nowhere_is_told():
    found = guess("cam1_a.mp4", "cam2_a.mp4", "cam1_b.mp4", "chess", "more.csv", "court.csv")
    told = {recording.path: why for recording, why in found.unused}
    assert set(told) == {"gym/cam1_b.mp4", "gym/chess", "gym/court.csv"}
    assert "cam1" in told["gym/cam1_b.mp4"]
    assert "another" in told["gym/court.csv"]


def test_one_video_is_a_walk_and_nothing_is_nothing():
    assert paths(guess("IMG_0007.mov").walks) == {"img0007": "IMG_0007.mov"}
    found = guess()
    assert not (found.cameras or found.walks or found.takes)


def test_files_of_devices_without_a_name_go_to_the_only_take():
    found = guess("a_cam1.mp4", "a_cam2.mp4", "recording.bvh", "20260501.bag")
    assert [(take, device) for take, device, _ in found.devices] == [
        ("a", "mocopi"),
        ("a", "realsense"),
    ]
    found = guess("a_cam1.mp4", "a_cam2.mp4", "b_cam1.mp4", "b_cam2.mp4", "x.bvh")
    assert [take for take, *_ in found.devices] == [""]


def test_hyphens_and_underscores_of_names_stay():
    found = guess(
        *(f"{take}_cam_{k}.mp4" for take in ("serve-1", "serve-2") for k in (0, 1)),
        "cam_0_empty.mp4",
        "cam_1_empty.mp4",
        "walk_1.mp4",
    )
    assert found.cameras == ["cam_0", "cam_1"]
    assert list(found.takes) == ["serve-1", "serve-2"]
    assert paths(found.static) == {"cam_0": "cam_0_empty.mp4", "cam_1": "cam_1_empty.mp4"}
    assert list(found.walks) == ["walk_1"]
    folders = [f"cam-{k}/GX01003{k}.MP4" for k in (1, 2)]
    assert guess(*folders).cameras == ["cam-1", "cam-2"]


def test_qualisys_names_take_camera_and_serial_number():
    found = guess(
        *(f"{take}_Miqus_{n}_{23086 + n}.avi" for take in ("Serve 1", "Lob") for n in (1, 2)),
    )
    assert found.cameras == ["miqus1", "miqus2"]
    assert found.serials == {"miqus1": "23087", "miqus2": "23088"}
    assert paths(found.takes["serve1"]) == {
        "miqus1": "Serve 1_Miqus_1_23087.avi",
        "miqus2": "Serve 1_Miqus_2_23088.avi",
    }
    assert list(found.takes) == ["lob", "serve1"] or list(found.takes) == ["serve1", "lob"]
    assert list(guess("Serve_Miqus_1_23087.avi", "Serve_Miqus_2_23088.avi").takes) == ["serve"]


def test_gopro_counts_for_itself_and_cuts_up_recordings():
    found = guess(
        "left/GX010034.MP4",
        "left/GX020034.MP4",
        "right/GX010107.MP4",
        "left/GOPR0001.MP4",
        "left/GP010001.MP4",
        "right/GOPR0002.MP4",
    )
    assert found.cameras == ["left", "right"]
    assert len(found.takes) == 2
    told = {r.path: why for r, why in found.unused}
    assert sorted(told) == ["gym/left/GP010001.MP4", "gym/left/GX020034.MP4"]
    assert all(
        why.startswith("chapter 2 of a recording")
        and "join the chapters by `python workflow/join_chapters.py`" in why
        for why in told.values()
    )


@pytest.mark.parametrize(
    "names",
    [
        ("cam1_GX010034.MP4", "cam2_GX010107.MP4"),
        ("cam1/IMG_1234.MOV", "cam2/IMG_0007.MOV"),
        ("cam1/VID_20240102_101112.mp4", "cam2/PXL_20240102_101115123.mp4"),
        ("cam1/2024-01-02 10-11-12.mkv", "cam2/2024-01-02 10-11-14.mkv"),
    ],
)
def test_counters_and_moments_are_no_names(names):
    found = guess(*names)
    assert (found.cameras, list(found.takes)) == (["cam1", "cam2"], ["take1"])
    assert not found.unused


def test_recordings_of_one_time_are_one_take():
    found = guess(
        "a/VID_20240102_101112.mp4",
        "a/VID_20240102_102000.mp4",
        "a/VID_20240102_103000.mp4",
        "b/PXL_20240102_101115123.mp4",
        "b/PXL_20240102_103005001.mp4",
    )
    assert [paths(take) for take in found.takes.values()] == [
        {"a": "a/VID_20240102_101112.mp4", "b": "b/PXL_20240102_101115123.mp4"},
        {"a": "a/VID_20240102_103000.mp4", "b": "b/PXL_20240102_103005001.mp4"},
    ]
    ((alone, why),) = found.unused
    assert alone.path == "gym/a/VID_20240102_102000.mp4"
    assert "only recording of its take, by camera a" in why


@pytest.mark.parametrize(
    "names",
    [
        ("IMG_1234.MOV", "IMG_0007.MOV"),
        ("VID_20240102_101112.mp4", "PXL_20240102_101115123.mp4", "20240102_101120.mp4"),
        ("2024-01-02 10-11-12.mkv", "2024-01-02 10-11-14.mkv"),
        ("GX010034.MP4", "GX010107.MP4"),
    ],
)
def test_cameras_that_no_name_tells_are_numbered(names):
    found = guess(*names)
    assert found.cameras == found.numbered == [f"cam{k + 1}" for k in range(len(names))]
    assert list(found.takes) == ["take1"]


def test_recordings_of_several_times_need_folders():
    found = guess("VID_20240102_101112.mp4", "VID_20240102_101115.mp4", "VID_20240102_120000.mp4")
    assert not found.takes
    assert all("into a folder named after it" in why for _, why in found.unused)


def test_japanese_names_become_names_of_the_study():
    found = guess(
        "左カメラ_スマッシュ.mp4",
        "右カメラ_スマッシュ.mp4",
        "左カメラ_無人.mp4",
        "右カメラ_無人.mp4",
    )
    assert found.cameras == ["right", "left"] or found.cameras == ["left", "right"]
    assert list(found.takes) == ["sumatusiyu"] or list(found.takes) == ["sumatusiyu", "take2"]
    assert set(found.static) == {"left", "right"}
    names = [*found.cameras, *found.takes]
    assert all(configuration.NAME.fullmatch(one) for one in names)


def test_words_without_a_spelling_are_numbered():
    found = guess("東_試合.mp4", "西_試合.mp4", "東_練習.mp4", "西_練習.mp4")
    assert found.cameras == ["cam1", "cam2"]
    assert list(found.takes) == ["take1", "take2"]
    assert not found.numbered


def test_files_of_devices_alone_are_takes():
    found = guess("jump.bvh", "arm raise.bvh")
    assert found.takes == {"arm_raise": {}, "jump": {}} or found.takes == {
        "jump": {},
        "arm_raise": {},
    }
    assert sorted((take, device) for take, device, _ in found.devices) == [
        ("arm_raise", "mocopi"),
        ("jump", "mocopi"),
    ]


def test_takes_of_devices_are_spelled_as_their_files():
    found = guess("single_depth_color_640x480.bag", "jump-2.bvh")
    assert list(found.takes) == ["single_depth_color_640x480", "jump-2"]


def devices(found):
    """Return the devices of each take, as their files are called."""
    return {
        take: {device: r.path.removeprefix("gym/") for of, device, r in found.devices if of == take}
        for take in found.takes
    }


def test_one_video_beside_files_of_devices_is_a_device_of_their_take():
    names = {"webcam": "balance_webcam.mp4", "mocopi": "balance_mocopi.bvh"}
    found = guess(*names.values())
    assert devices(found) == {"balance": names}
    assert not (found.walks or found.cameras or found.static)
    names = {"webcam": "IMG_0007.mov", "mocopi": "arm-raise.bvh", "rgbd": "arm-raise_depth"}
    assert devices(guess(*names.values(), **{"arm-raise_depth": "depth"})) == {"arm-raise": names}
    assert devices(guess("IMG_0007.mov", "mocopi.bvh")) == {
        "take1": {"webcam": "IMG_0007.mov", "mocopi": "mocopi.bvh"}
    }


@pytest.mark.parametrize("model", ["d415", "D435i", "l515"])
def test_the_model_of_a_depth_camera_names_no_take(model):
    names = {"mocopi": "claps_mocopi.bvh", "realsense": f"claps_{model}.bag"}
    assert devices(guess(*names.values())) == {"claps": names}


def test_videos_that_say_that_they_are_of_a_webcam_are_takes():
    names = [
        f"{take}/{take}_{ending}"
        for take in ("jump", "sit")
        for ending in ("webcam.mp4", "mocopi.bvh")
    ]
    assert devices(guess(*names)) == {
        take: {"webcam": f"{take}/{take}_webcam.mp4", "mocopi": f"{take}/{take}_mocopi.bvh"}
        for take in ("jump", "sit")
    }
    folders = [f"{take}/{name}" for take in ("jump", "sit") for name in ("webcam.mp4", "suit.bvh")]
    assert set(devices(guess(*folders, "jump/mocopi.bvh"))) == {"jump", "sit", "suit"}


@pytest.mark.parametrize("other", ["walk.mp4", "hall", "left_empty.jpg", "cam2_balance.mp4"])
def test_a_video_beside_those_of_a_session_is_no_device(other):
    found = guess("cam1_balance.mp4", "balance.bvh", other)
    assert [device for _, device, _ in found.devices] == ["mocopi"]


def test_a_folder_of_depth_goes_to_the_take_of_its_name():
    films = [f"{take}_cam{k}.mp4" for take in ("serve", "lob") for k in (1, 2)]
    found = guess(*films, "lob_depth", lob_depth="depth")
    assert [(take, device) for take, device, _ in found.devices] == [("lob", "rgbd")]


@pytest.mark.parametrize(
    "takes",
    [
        ("P01_smash_1", "P01_smash_2", "P02_smash_1", "P02_smash_2"),
        ("P01/trial1", "P01/trial2", "P02/trial1", "P02/trial2"),
        ("smash_slow", "smash_fast", "lob_slow", "lob_fast", "smash"),
    ],
)
def test_a_file_of_a_device_goes_to_the_take_that_shares_most_words_with_it(takes):
    films = [f"{take}_cam{k}.mp4" for take in takes for k in (1, 2)]
    found = guess(*films, *(f"{take}.bvh" for take in takes))
    assert {film["cam1"].path: name for name, film in found.takes.items()} == {
        r.path.replace(".bvh", "_cam1.mp4"): take for take, _, r in found.devices
    }


def test_a_file_of_a_device_that_two_takes_may_have_goes_to_none():
    films = [f"{take}_cam{k}.mp4" for take in ("slow_smash", "slow_lob", "drive") for k in (1, 2)]
    assert [take for take, *_ in guess(*films, "slow.bvh").devices] == [""]


def keypoints(*paths):
    """Return the kinds of recordings: folders of keypoints of these names."""
    return dict.fromkeys((PurePosixPath(path).name for path in paths), "keypoints")


def test_keypoints_alone_are_takes():
    folders = ("openpose/serve/cam1_json", "openpose/serve/cam2_json", "openpose/lob/cam1_json")
    folders += ("openpose/lob/cam2_json",)
    found = guess(*folders, **keypoints(*folders))
    assert found.cameras == ["cam1", "cam2"]
    assert sorted(found.takes) == ["lob", "serve"]
    assert found.keypoints == found.takes
    assert paths(found.takes["lob"]) == {n: f"openpose/lob/{n}_json" for n in ("cam1", "cam2")}


def test_keypoints_lie_beside_the_videos_that_they_were_made_from():
    folders = [f"{take}/pose/cam0{k}_json" for take in ("serve", "lob") for k in (1, 2)]
    films = [f"{take}/videos/cam0{k}.mp4" for take in ("serve", "lob") for k in (1, 2)]
    found = guess(*films, *folders, "lob/pose/cam07_json", **keypoints(*folders, "cam07_json"))
    assert paths(found.keypoints["serve"]) == {
        "cam01": "serve/pose/cam01_json",
        "cam02": "serve/pose/cam02_json",
    }
    assert paths(found.takes["serve"])["cam01"] == "serve/videos/cam01.mp4"
    assert [(r.path, why) for r, why in found.unused] == [
        ("gym/lob/pose/cam07_json", "keypoints of no camera and take found")
    ]


def test_keypoints_go_to_the_take_that_has_no_other_words():
    takes = ("lob slow", "serve slow", "serve")
    folders = [f"{take}/pose/cam{k}_json" for take in takes for k in (1, 2)]
    films = [f"{take}/cam{k}.mp4" for take in takes for k in (1, 2)]
    found = guess(*films, *folders, **keypoints(*folders))
    assert paths(found.keypoints["serve"]) == {f"cam{k}": f"serve/pose/cam{k}_json" for k in (1, 2)}
    assert len(found.keypoints) == 3


def test_keypoints_of_some_cameras_only_and_those_changed_by_another_program_are_left_out():
    films = [f"videos/cam{k}.mp4" for k in (1, 2)]
    folders = ["pose/cam1_json", "pose-associated/cam1_json", "pose-sync/cam2_json"]
    found = guess(*films, *folders, **keypoints(*folders))
    assert found.keypoints == {}
    why = {r.path.removeprefix("gym/"): reason for r, reason in found.unused}
    assert why["pose/cam1_json"] == "keypoints of some cameras of take take1 only"
    assert "changed" in why["pose-associated/cam1_json"]
    assert "changed" in why["pose-sync/cam2_json"]


@pytest.mark.parametrize("drawn", ["cam{k}_pose.mp4", "cam{k}_img"])
def test_pictures_with_keypoints_drawn_in_are_left_out(drawn):
    films = [f"{take}/videos/cam{k}.mp4" for take in ("T1", "T2") for k in (1, 2)]
    folders = [f"{take}/pose/cam{k}_json" for take in ("T1", "T2") for k in (1, 2)]
    others = [f"{take}/pose/{drawn.format(k=k)}" for take in ("T1", "T2") for k in (1, 2)]
    found = guess(*others, *folders, *films, **keypoints(*folders))
    assert paths(found.takes["t1"]) == {f"cam{k}": f"T1/videos/cam{k}.mp4" for k in (1, 2)}
    assert len(found.keypoints) == 2
    assert not found.walks
    told = {r.path.removeprefix("gym/"): why for r, why in found.unused}
    assert sorted(told) == sorted(others)
    assert all("the study needs the recording itself" in why for why in told.values())


def test_recordings_in_folders_of_keypoints_that_do_not_say_that_they_are_drawn_are_takes():
    assert len(guess("pose/cam1.mp4", "pose/cam2.mp4").takes["take1"]) == 2
    assert len(guess("pose/GX010034.mp4", "pose/GX010107.mp4").takes["take1"]) == 2


@pytest.mark.parametrize(
    "other",
    ["cam1_chessboard.mp4", "intrinsics/cam1.mp4", "calibration/calib.mp4", "cam1_board.jpg"],
)
def test_a_video_of_a_chessboard_is_left_out(other):
    films = [f"serve_cam{k}.mp4" for k in (1, 2)]
    found = guess(*films, other, "calibration/walk.mp4", "calibration/cam2_empty.mp4")
    assert paths(found.takes["serve"]) == {"cam1": films[0], "cam2": films[1]}
    assert [paths(found.walks), paths(found.static)] == [
        {"calibration_walk": "calibration/walk.mp4"},
        {"cam2": "calibration/cam2_empty.mp4"},
    ]
    ((left_out, why),) = found.unused
    assert left_out.path == f"gym/{other}"
    assert "chessboard" in why


def test_copies_that_an_iphone_edited_are_no_takes_beside_the_recordings():
    names = ["left/IMG_0004.MOV", "left/IMG_0005.MOV", "right/IMG_0071.MOV", "right/IMG_0072.MOV"]
    found = guess(*names, "left/IMG_E0004.MOV")
    assert paths(found.takes["take1"]) == {"left": names[0], "right": names[2]}
    assert paths(found.takes["take2"]) == {"left": names[1], "right": names[3]}
    ((copy, why),) = found.unused
    assert copy.path == "gym/left/IMG_E0004.MOV"
    assert why.startswith("an edited copy of IMG_0004, by its name: ")
    alone = guess("left/IMG_E0004.MOV", "left/IMG_0005.MOV", *names[2:])
    assert paths(alone.takes["take1"]) == {"left": "left/IMG_E0004.MOV", "right": names[2]}
    assert not alone.unused


def test_small_pictures_on_cards_of_sony_are_no_walks_and_no_pictures_of_the_empty_court():
    films = [f"{camera}/C000{k}.MP4" for camera in ("left", "right") for k in (1, 2)]
    found = guess(*films, "left/THMBNL", "right/THMBNL/C0001T01.jpg")
    assert len(found.takes) == 2
    assert not found.walks and not found.static
    assert len(found.unused) == 2


def test_a_walk_may_be_in_a_folder_called_calibration():
    found = guess("match/left.mp4", "match/right.mp4", "calibration/phone.mp4")
    assert paths(found.walks) == {"calibration_phone": "calibration/phone.mp4"}
    found = guess("calibration_day/left_rally.mp4", "calibration_day/right_rally.mp4")
    assert found.cameras == ["left", "right"]
    found = guess("match/left.mp4", "match/right.mp4", "calibration/left.mp4")
    assert [r.path for r, _ in found.unused] == ["gym/calibration/left.mp4"]
