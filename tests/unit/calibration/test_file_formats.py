"""Calibration files by other programs, against their converters, OpenCV, real chessboards."""

import re
from dataclasses import replace

import cv2
import numpy as np
import pytest
import tomli_w

from courtside.calibration import file_formats
from courtside.calibration.boards import chessboard
from courtside.geometry import camera as cameras
from courtside.study.errors import InputError
from fixtures.recordings.real_data import REAL, needs_real

WALK = REAL / "walk-4cams" / "calibration"
CHARUCO = REAL / "charuco-4cams"
ROTATION = cv2.Rodrigues(np.array([1.2, -0.7, 0.4]))[0]
TRANSLATION = np.array([0.3, -0.5, 6.0])
K = np.array([[1500.0, 0.0, 950.0], [0.0, 1490.0, 545.0], [0.0, 0.0, 1.0]])
DIST = np.array([-0.21, 0.06, 0.0011, -0.0023, 0.013])

QUALISYS = """<?xml version="1.0" encoding="UTF-8"?>
<calibration source="x"><results std-dev="1.0"/><cameras>
<camera active="1" calibrated="true" serial="26580" model="Miqus Video" viewrotation="90">
<fov_video left="8" top="4" right="1919" bottom="1087"/>
<transform x="4000.0" y="2000.0" z="1500.0" r11="0.000000" r12="1.000000" r13="0.000000"
 r21="0.000000" r22="0.000000" r23="1.000000" r31="1.000000" r32="0.000000" r33="0.000000"/>
<intrinsic focallength="9.27" sensorMinU="0.0" sensorMaxU="122879.0"
 sensorMinV="0.0" sensorMaxV="69631.0"
 focalLengthU="96000.0" focalLengthV="96064.0" centerPointU="61440.0"
 centerPointV="34816.0" skew="0.0"
 radialDistortion1="-0.05" radialDistortion2="0.14" radialDistortion3="0.003"
 tangentalDistortion1="0.0006" tangentalDistortion2="-0.0004"/>
</camera>
<camera active="0" serial="switched off"/>
<camera active="1" calibrated="false" serial="not calibrated"/>
</cameras></calibration>"""


def write(path, text):
    path.write_text(text, encoding="utf-8")
    return path


def write_opencv(path, size=(1920, 1080), **values):
    known = {
        "image_width": size[0],
        "image_height": size[1],
        "camera_matrix": K,
        "distortion_coefficients": DIST.reshape(1, 5),
        "R": ROTATION,
        "T": TRANSLATION.reshape(3, 1),
    }
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
    for key, value in (known | values).items():
        if value is not None:
            storage.write(key, value)
    storage.release()
    return path


@needs_real
def test_qualisys_is_as_pose2sim_converted_it_but_for_distortion():
    ours = file_formats.read(WALK / "Calib.qca.txt")
    theirs = file_formats.read(WALK / "Calib_qualisys.toml")
    assert [camera.name for camera in ours] == ["cam01", "cam02", "cam03", "cam04"]
    for our, their in zip(ours, theirs, strict=True):
        assert our.size == their.size
        np.testing.assert_allclose(our.K, their.K, rtol=1e-14)
        np.testing.assert_allclose(our.cam_from_world, their.cam_from_world, atol=1e-14)
        np.testing.assert_allclose(our.dist, 64 * their.dist, rtol=1e-12)


@pytest.fixture(scope="module")
def corners():
    found = chessboard.find(WALK / "boards" / "int_cam2_img", (4, 7)).xy.astype(np.float32)
    assert len(found) > 4
    return list(found)


@needs_real
@pytest.mark.parametrize("at", range(4))
def test_chessboards_confirm_qualisys_distortion_without_the_64(at, corners):
    """Stills of a flat board: reprojection with the focal length and principal point left free.

    All stills show one lens of the four (test_chessboard.py); the lenses' distortions are alike.
    """
    board = np.zeros((28, 3), np.float32)
    board[:, :2] = np.mgrid[0:4, 0:7].T.reshape(-1, 2) * 0.06
    ours = file_formats.read(WALK / "Calib.qca.txt")
    theirs = file_formats.read(WALK / "Calib_qualisys.toml")
    rms_px = [board_error_px(camera, board, corners) for camera in (ours[at], theirs[at])]
    assert rms_px[0] < 0.6 * rms_px[1]


def board_error_px(camera, board, corners):
    fixed = cv2.CALIB_FIX_K1 | cv2.CALIB_FIX_K2 | cv2.CALIB_FIX_K3 | cv2.CALIB_FIX_TANGENT_DIST
    return cv2.calibrateCamera(
        [board] * len(corners), corners, camera.size, camera.K.copy(), camera.dist.copy(),
        flags=cv2.CALIB_USE_INTRINSIC_GUESS | fixed,
    )[0]  # fmt: skip


def test_qualisys_by_hand(tmp_path):
    (camera,) = file_formats.read(write(tmp_path / "Calib.qca.txt", QUALISYS))
    assert camera.name == "26580"
    assert camera.size == (1912, 1084)
    np.testing.assert_allclose(camera.K, [[1500, 0, 952], [0, 1501, 540], [0, 0, 1]])
    np.testing.assert_allclose(camera.dist, [-0.05, 0.14, 0.0006, -0.0004, 0.003])
    np.testing.assert_allclose(camera.centre_in_world, [4.0, 2.0, 1.5])
    # Qualisys' axes in the camera are right = world y, up = world z, backwards = world x.
    ahead, up, right = np.array([[-1.0, 0.0, 0.0], [0.0, 0.0, 0.1], [0.0, 0.1, 0.0]])
    xy = cameras.project(
        camera, camera.centre_in_world + np.stack([ahead, ahead + up, ahead + right])
    )
    np.testing.assert_allclose(xy[0], [952, 540])
    assert xy[1, 1] < 540
    assert xy[2, 0] > 952


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("<calibration", '<!DOCTYPE x [<!ENTITY a "b">]><calibration', "found a DOCTYPE"),
        ("</cameras></calibration>", "", "expected XML"),
        ('focalLengthU="96000.0"', "", "26580: expected intrinsic focalLengthU .* found nothing"),
        (
            'focalLengthU="96000.0"',
            'focalLengthU="wide"',
            "26580: expected intrinsic focalLengthU .* wide",
        ),
        ('focalLengthU="96000.0"', 'focalLengthU="0"', "26580: .*positive focal"),
        ('skew="0.0"', 'skew="3.0"', "26580: .*no skew"),
        ('r33="0.000000"', 'r33="nan"', "26580: expected transform r33"),
        ('r31="1.000000"', 'r31="-1.000000"', "26580: .*right-handed"),
        ('r31="1.000000"', 'r31="1.010000"', "26580: .*orthonormal"),
        ('viewrotation="90"', 'viewrotation="45"', "26580: expected viewrotation"),
        ("<fov_video", "<fov_film", "26580: expected fov_video left"),
        ('right="1919"', 'right="1"', "26580: expected size"),
        ('active="1"', 'active="0"', "expected cameras, found none"),
    ],
)
def test_malformed_qualisys_is_one_line_to_mend(tmp_path, old, new, message):
    path = write(tmp_path / "Calib.qca.txt", QUALISYS.replace(old, new))
    with pytest.raises(InputError, match=message) as caught:
        file_formats.read(path)
    assert "Calib.qca.txt" in str(caught.value)
    assert "\n" not in str(caught.value)


@needs_real
def test_both_forms_of_caliscope_are_the_same():
    new = file_formats.read(CHARUCO / "camera_array.toml")
    old = file_formats.read(CHARUCO / "config.toml")
    assert [camera.name for camera in new] == ["cam_0", "cam_1", "cam_2", "cam_3"]
    for ours, theirs in zip(new, old, strict=True):
        assert (ours.name, ours.size) == (theirs.name, theirs.size)
        np.testing.assert_array_equal(ours.cam_from_world, theirs.cam_from_world)


@needs_real
def test_caliscope_values_are_the_files():
    camera = file_formats.read(CHARUCO / "camera_array.toml")[0]
    assert camera.size == (1280, 720)
    assert camera.K[0, 0] == 903.550124089999
    assert camera.dist[4] == 0.0665682301495769
    assert camera.cam_from_world[1, 3] == -0.03234536459937444
    row = [-0.7070716153979968, 0.5639880775931625, -0.42657611165094056]
    np.testing.assert_allclose(camera.cam_from_world[0, :3], row)


@needs_real
@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("matrix = [[903.550124089999, 0.0, ", "matrix = [[0.0, 0.0, ", "cam_0: .*positive focal"),
        (
            "matrix = [[903.550124089999, 0.0, ",
            "matrix = [[903.550124089999, ",
            "cam_0: expected matrix",
        ),
        (
            "[[-0.7070716153979968",
            "[[0.7070716153979968",
            "cam_0: expected an? .*rotation|right-handed",
        ),
        ("cam_id =1", "cam_id =0", "different names"),
        ("translation = [0.17125994082321383, ", "translation = [", "cam_0: expected translation"),
        ("translation = [0.17125994082321383, ", "translation = [1e4, ", "cam_0: .*within 300 m"),
    ],
)
def test_malformed_caliscope_is_one_line_to_mend(tmp_path, old, new, message):
    text = (CHARUCO / "camera_array.toml").read_text(encoding="utf-8")
    assert old in text
    with pytest.raises(InputError, match=message) as caught:
        file_formats.read(write(tmp_path / "camera_array.toml", text.replace(old, new)))
    assert "camera_array.toml" in str(caught.value)


def assert_is_the_camera(camera, name):
    assert camera.name == name
    assert camera.size == (1920, 1080)
    np.testing.assert_allclose(camera.K, K)
    np.testing.assert_allclose(camera.dist, DIST)
    np.testing.assert_allclose(
        camera.cam_from_world, np.column_stack([ROTATION, TRANSLATION]), atol=1e-12
    )


@pytest.mark.parametrize("suffix", [".yml", ".xml"])
@pytest.mark.parametrize(
    "values",
    [
        {},
        {"camera_matrix": None, "K": K, "distortion_coefficients": None, "dist": DIST},
        {"R": None, "T": None, "rvec": np.array([1.2, -0.7, 0.4]), "tvec": TRANSLATION},
        {"T": TRANSLATION * 1000, "unit": "mm"},
        {"distortion_coefficients": np.concatenate([DIST, np.zeros(3)])},
    ],
)
def test_opencv_one_camera(tmp_path, suffix, values):
    (camera,) = file_formats.read(write_opencv(tmp_path / f"left{suffix}", **values))
    assert_is_the_camera(camera, "left")


def test_a_fisheye_lens_of_opencv_is_not_taken_for_an_ordinary_one(tmp_path):
    """OpenCV's own calibration sample writes `fisheye_model` beside k1 to k4."""
    dist = np.array([0.01, -0.002, 0.0005, -0.0001])
    values = {
        "distortion_coefficients": dist,
        "camera_matrix": K * [[3, 3, 1], [3, 3, 1], [1, 1, 1]],
    }
    long = values["camera_matrix"]
    path = write_opencv(tmp_path / "left.yml", fisheye_model=1, **values)
    (camera,) = file_formats.read(path)
    ideal = np.array([[[-0.1, 0.05], [0.12, -0.08], [0.0, 0.02]]])
    expected = cv2.fisheye.distortPoints(ideal, long, dist)[0]
    found = cv2.projectPoints(
        np.append(ideal[0], np.ones((3, 1)), 1), np.zeros(3), np.zeros(3), camera.K, camera.dist
    )
    np.testing.assert_allclose(found[0][:, 0], expected, atol=0.02)


def test_a_matrix_of_infinite_columns_is_told_in_one_line(tmp_path):
    path = write_opencv(tmp_path / "left.yml")
    path.write_text(path.read_text().replace("cols: 3", "cols: .Inf", 1))
    with pytest.raises(InputError, match="left: expected matrix"):
        file_formats.read(path)


def test_opencv_folder_has_one_camera_per_file(tmp_path):
    for name in ("right.yml", "left.xml"):
        write_opencv(tmp_path / name)
    write(tmp_path / "notes.txt", "not a camera")
    found = file_formats.read(tmp_path)
    assert_is_the_camera(found[0], "left")
    assert_is_the_camera(found[1], "right")


def test_opencv_several_cameras_in_one_file(tmp_path):
    storage = cv2.FileStorage(str(tmp_path / "all.yml"), cv2.FILE_STORAGE_WRITE)
    storage.write("unit", "cm")
    for name in ("left", "right"):
        storage.startWriteStruct(name, cv2.FILE_NODE_MAP)
        storage.write("image_width", 1920)
        storage.write("image_height", 1080)
        for key, value in (("K", K), ("dist", DIST), ("R", ROTATION), ("T", TRANSLATION * 100)):
            storage.write(key, value)
        storage.endWriteStruct()
    storage.release()
    found = file_formats.read(tmp_path / "all.yml")
    assert_is_the_camera(found[0], "left")
    assert_is_the_camera(found[1], "right")


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"R": None}, "left: expected rotation .* found nothing"),
        ({"distortion_coefficients": None}, "left: expected distortions .* found nothing"),
        ({"image_width": None}, "left: expected size"),
        ({"camera_matrix": None}, "found no camera_matrix among: image_width, image_height,"),
        ({"camera_matrix": "wide"}, "left: expected matrix .* wide"),
        ({"camera_matrix": np.eye(2)}, "left: expected matrix"),
        ({"R": np.diag([1.0, 1.0, -1.0])}, "left: .*right-handed"),
        ({"T": np.array([np.nan, 0, 0])}, "left: expected translation"),
        ({"unit": "inch"}, "left: expected unit"),
        ({"unit": 3}, "left: expected unit"),
        ({"fisheye_model": 1}, r"left: expected distortions k1 k2 k3 k4 of a fisheye lens"),
        ({"distortion_coefficients": np.arange(8.0)}, "left: .*five coefficients"),
    ],
)
def test_malformed_opencv_is_one_line_to_mend(tmp_path, values, message):
    with pytest.raises(InputError, match=message) as caught:
        file_formats.read(write_opencv(tmp_path / "left.yml", **values))
    assert "left.yml" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_files_of_other_programs_are_named_with_what_to_do(tmp_path):
    """A stereo pair, Theia3D's own form, a take of Motive and its old form are not guessed."""
    storage = cv2.FileStorage(str(tmp_path / "stereo.yml"), cv2.FILE_STORAGE_WRITE)
    for key in ("M1", "D1", "M2", "D2", "R", "T"):
        storage.write(key, K)
    storage.release()
    in_px = re.sub(r"<fov_video[^>]*>", "", QUALISYS.replace("122879.0", "1919"))
    for path, message in (
        (
            tmp_path / "stereo.yml",
            r"a stereo pair \(M1, D1, M2, D2 \.\.\.\); give each camera with its",
        ),
        (write(tmp_path / "theia.txt", in_px), r"found a calibration of Theia3D.*\.qca\.txt"),
        (write(tmp_path / "take.csv", "Format Version,1.23,Take Name,x\n"), r"Motive \(\.csv\)"),
        (write(tmp_path / "hall.cal", "x"), r"older Motive \(\.cal\).*makes an \.mcal"),
    ):
        with pytest.raises(InputError, match=message) as caught:
            file_formats.read(path)
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "text", "found"),
    [
        ("cam.json", '{"cam01": {"K": [1, 2]}}', r"a \.json file, which is none of these;"),
        ("kalibr.yaml", "cam0:\n  camera_model: pinhole\n", r"a \.yaml file, which is none of"),
        ("x.trc", "PathFileType\t4\t(X/Y/Z)\tx.trc\n", r"a \.trc file, .*, or write it as TOML, a"),
        ("a.xml", '<Cameras by="Theia3D"><Camera/></Cameras>', "XML of <Cameras> .* Theia3D"),
        ("b.xml", "<svg><path/></svg>", "XML of <svg> without cameras of these; export it"),
        ("c.xml", "<Cameras><Camera/></Cameras>", "XML of <Cameras> without cameras of"),
    ],
)  # fmt: skip
def test_files_of_no_known_form_are_told_so(tmp_path, name, text, found):
    with pytest.raises(InputError, match=f"{name}: expected Qualisys .*, found {found}") as caught:
        file_formats.read(write(tmp_path / name, text))
    assert "\n" not in str(caught.value)
    assert "Invalid" not in str(caught.value)


def test_a_fault_of_toml_is_told_with_its_line(tmp_path):
    with pytest.raises(InputError, match=r"\(read as TOML\), found: .* line 2"):
        file_formats.read(write(tmp_path / "cameras.toml", "[a]\nsize = 3 4\n"))


def test_qualisys_within_the_settings_of_a_measurement(tmp_path):
    inner = QUALISYS.partition("?>")[2]
    text = f"<QTM_Parameters_Ver_1.25>{inner}</QTM_Parameters_Ver_1.25>"
    (camera,) = file_formats.read(write(tmp_path / "settings.xml", text))
    assert (camera.name, camera.size) == ("26580", (1912, 1084))


def test_freemocap_writes_mm_and_no_unit(tmp_path):
    """As its `camera_calibration.toml`: aniposelib's tables, translations of some thousands."""
    table = {
        "name": "Cam1", "size": [1920, 1080], "matrix": K.tolist(), "distortions": DIST.tolist(),
        "rotation": [1.2, -0.7, 0.4], "translation": (1000 * TRANSLATION).tolist(),
        "world_position": [1.0, 2.0, 3.0],
    }  # fmt: skip
    content = {"cam_0": table, "metadata": {"charuco_square_size": 58.0}}
    path = write(tmp_path / "calibration.toml", tomli_w.dumps(content))
    assert_is_the_camera(file_formats.read(path)[0], "Cam1")
    (in_cm,) = file_formats.read(path, "cm")
    np.testing.assert_allclose(in_cm.cam_from_world[:, 3], 10 * TRANSLATION)


@pytest.mark.parametrize(("unit", "metres"), [("cm", 0.01), ("ft", 0.3048), ("in", 0.0254)])
def test_a_unit_is_that_of_a_file_that_states_none(tmp_path, unit, metres):
    path = write_opencv(tmp_path / "left.yml", T=TRANSLATION / metres)
    assert_is_the_camera(file_formats.read(path, unit)[0], "left")
    stated = write_opencv(tmp_path / "stated.yml", T=TRANSLATION * 1000, unit="mm")
    assert_is_the_camera(file_formats.read(stated)[0], "stated")
    for other in (stated, write(tmp_path / "a.qca.txt", QUALISYS)):
        with pytest.raises(InputError, match=r"the file or its format states it, found .*; remove"):
            file_formats.read(other, unit)
    toml = tmp_path / "ours.toml"
    cameras.write_toml(toml, named("left"), source="test")
    inline = re.sub(r"(?s)\[metadata\].*?(?=\n\[|$)", "", toml.read_text())
    short = write(tmp_path / "short.toml", f'metadata = {{unit = "m"}}\n{inline}')
    assert_is_the_camera(file_formats.read(short)[0], "left")
    for other in (toml, short):
        with pytest.raises(InputError, match=r"the file or its format states it, found .*; remove"):
            file_formats.read(other, unit)


@pytest.mark.parametrize("apart", [0.02, 400.0])
def test_cameras_an_impossible_distance_apart_are_refused(apart):
    one, other = named("left", "right")
    moved = other.cam_from_world + np.array([0, 0, 0, 1]) * (apart / np.sqrt(3))
    with pytest.raises(InputError, match=r"hall: .* 0\.1 to 150 m .* that the file states or,"):
        file_formats.check_apart("hall", [one, replace(other, cam_from_world=moved)])
    moved = other.cam_from_world + np.array([0, 0, 0, 1]) * 5
    file_formats.check_apart("hall", [one, replace(other, cam_from_world=moved)])


def whole_files(tmp_path):
    camera = cameras.Camera("left", (1920, 1080), K, DIST, np.column_stack([ROTATION, TRANSLATION]))
    cameras.write_toml(tmp_path / "whole.toml", [camera], source="test")
    write(tmp_path / "whole.qca.txt", QUALISYS)
    write_opencv(tmp_path / "whole.yml")
    write_opencv(tmp_path / "whole.xml")
    return sorted(tmp_path.glob("whole*"))


def test_truncated_files_are_refused_or_whole(tmp_path):
    """A prefix with a whole camera reads as that camera; any other is an `InputError`."""
    for path in whole_files(tmp_path):
        text = path.read_text(encoding="utf-8")
        (whole,) = file_formats.read(path)
        for length in np.linspace(0, len(text.rstrip()) - 1, 60).astype(int):
            cut = write(tmp_path / re.sub("whole", "cut", path.name), text[:length])
            try:
                found = file_formats.read(cut)
            except InputError as error:
                assert cut.name in str(error)
                assert "\n" not in str(error)
            else:
                np.testing.assert_allclose(found[0].K, whole.K)


@pytest.mark.fuzz
def test_garbled_files_are_refused_or_cameras(tmp_path):
    random = np.random.default_rng(7)
    for path in whole_files(tmp_path):
        text = path.read_bytes()
        for _ in range(2000):
            garbled = bytearray(text)
            for at in random.integers(len(text), size=3):
                garbled[at] = random.choice([*b'0-.,:[]{}<>"&!% \nx', 0, 255])
            (tmp_path / f"garbled{path.suffix}").write_bytes(garbled)
            try:
                found = file_formats.read(tmp_path / f"garbled{path.suffix}")
            except InputError as error:
                assert "\n" not in str(error)
            else:
                assert all(np.isfinite(camera.K).all() for camera in found)


@pytest.mark.parametrize("content", [b"\xff\xfe\x00binary", b"", b"{}", b"<html></html>", b"hello"])
def test_other_files_are_refused(tmp_path, content):
    (tmp_path / "other").write_bytes(content)
    with pytest.raises(InputError, match="other"):
        file_formats.read(tmp_path / "other")


@pytest.mark.parametrize(
    ("content", "found"),
    [
        (b"\0\0\0 ftypisom\xd8\0\xd8", "no text, as in a video or a picture; give the calibration"),
        ("[cam] # Größe".encode("latin-1"), "text of another encoding; save it as UTF-8"),
    ],
)
def test_files_that_are_no_text_are_told_so(tmp_path, content, found):
    (tmp_path / "cam01.mp4").write_bytes(content)
    with pytest.raises(InputError, match=f"cam01.mp4: expected Qualisys .*, found {found}"):
        file_formats.read(tmp_path / "cam01.mp4")


def test_missing_empty_and_huge_are_refused(tmp_path):
    for path in (tmp_path / "none.toml", tmp_path):
        with pytest.raises(InputError, match=re.escape(str(path))):
            file_formats.read(path)
    with (tmp_path / "film.mp4").open("wb") as stream:
        stream.truncate(1 << 30)
    with pytest.raises(InputError, match="1073741824 bytes"):
        file_formats.read(tmp_path / "film.mp4")


def named(*names):
    pose = np.column_stack([ROTATION, TRANSLATION])
    return [cameras.Camera(name, (1920, 1080), K, DIST, pose) for name in names]


def test_known_lenses_are_those_of_the_file_otherwise_of_the_study(tmp_path):
    made = [cameras.plain(name, (1920, 1080), 1.0) for name in ("Cam 1", "left")]
    for camera in made:
        cameras.write_toml(tmp_path / f"{camera.name}.toml", [camera], source="test")
    tomls = [tmp_path / "left.toml"]
    of_file = file_formats.known_lenses(tmp_path / "Cam 1.toml", {"side": "Cam 1"}, tomls)
    assert list(of_file) == ["side"] and of_file["side"].K[0, 0] == 1920.0
    assert list(file_formats.known_lenses(None, {}, tomls)) == ["left"]


def test_lenses_of_other_cameras_are_told_with_their_file_and_key(tmp_path):
    path = tmp_path / "lenses.toml"
    cameras.write_toml(path, [cameras.plain("port0", (1920, 1080), 1.0)], source="test")
    with pytest.raises(InputError) as caught:
        file_formats.known_lenses(path, {"a": "a"}, [])
    assert str(caught.value).startswith(
        f"lenses: {path}: camera a: expected 'a' in the calibration, found port0; "
    )


def test_lenses_do_not_depend_on_where_their_cameras_stood(tmp_path):
    pose = np.column_stack([np.eye(3), [0.0, 0.0, 5000.0]])
    far = replace(cameras.plain("left", (1920, 1080), 1.0), cam_from_world=pose)
    cameras.write_toml(tmp_path / "mm.toml", [far], source="test")
    with pytest.raises(InputError, match=r"within 300 m .* correct the one that the file states"):
        file_formats.read(tmp_path / "mm.toml")
    assert file_formats.known_lenses(tmp_path / "mm.toml", {"a": "left"}, [])["a"].K[0, 0] == 1920


@pytest.mark.parametrize("lenses", [False, True])
def test_a_calibration_without_cameras_is_refused(tmp_path, lenses):
    (tmp_path / "notes.md").write_text("nothing")
    (tmp_path / "empty.toml").write_text("")
    for path, message in (
        (tmp_path, r"expected Qualisys .* found a folder without them; give one"),
        (tmp_path / "empty.toml", "expected cameras, found none; export the calibration again"),
    ):
        with pytest.raises(InputError, match=message):
            if lenses:
                file_formats.known_lenses(path, {"a": "left"}, [])
            else:
                file_formats.read(path)


def test_renaming_picks_and_orders():
    picked = file_formats.rename(
        "x.toml", named("Cam 1", "Cam 2", "Cam 3"), {"left": "Cam 3", "c": "Cam 1"}
    )
    assert [camera.name for camera in picked] == ["left", "c"]
    np.testing.assert_array_equal(picked[0].K, K)


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (
            {"left": "Cam 4"},
            r"^x.toml: camera left: expected 'Cam 4' in the calibration, found Cam 1, Cam 2; ",
        ),
        (
            {"left": "Cam 1", "right": "Cam 1"},
            r"^x.toml: camera left: expected a camera",
        ),
    ],
)
def test_renaming_to_nothing_is_refused(names, message):
    with pytest.raises(InputError, match=message):
        file_formats.rename("x.toml", named("Cam 1", "Cam 2"), names)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('name = "left"', "name = 0x" + "f" * 6000),
        ("fisheye = false", "fisheye = " + "[" * 5000),
        ("fisheye = false", "fisheye = " + "9" * 5000),
        ("distortions = [", "distortions = [1e308, "),
        ("size = [", "size = [1" + "0" * 400 + ", "),
        ("translation = [", "translation = [1e200, "),
    ],
)
def test_numbers_and_brackets_without_end_are_one_line(tmp_path, old, new):
    camera = cameras.Camera("left", (1920, 1080), K, DIST, np.column_stack([ROTATION, TRANSLATION]))
    path = tmp_path / "a.toml"
    cameras.write_toml(path, [camera], source="test")
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")
    for read in (cameras.read_toml, file_formats.read):
        with pytest.raises(InputError, match=r"a\.toml: ") as caught:
            read(path)
        assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize("small", [1e-320, 1e-100, 0.0])
def test_a_coefficient_of_next_to_nothing_is_none(small):
    pose = np.column_stack([ROTATION, TRANSLATION])
    found = cameras.Camera("left", (1920, 1080), K, [-0.2, 0.01, 0, 0, small], pose)
    plain = cameras.Camera("left", (1920, 1080), K, [-0.2, 0.01, 0, 0, 0], pose)
    assert (
        found.fold_radius == pytest.approx(plain.fold_radius) == pytest.approx(np.sqrt(2))
    )  # 1 - 0.6 s + 0.05 s^2 = 0 at s = 2


def test_principal_points_are_replaced_by_name():
    found = file_formats.with_principal_points(named("left", "right"), {"right": [900.5, 531.0]})
    np.testing.assert_array_equal(found[0].K, K)
    np.testing.assert_array_equal(found[1].K[:2, 2], [900.5, 531.0])
    np.testing.assert_array_equal(found[1].K[:2, :2], np.asarray(K)[:2, :2])


@pytest.mark.parametrize("point", [[1920.0, 500.0], [900.0, 1080.0], [-1.0, 5.0]])
def test_a_principal_point_outside_the_picture_is_refused(point):
    with pytest.raises(InputError, match=r"camera left: expected principal_point_px inside .*1920"):
        file_formats.with_principal_points(named("left"), {"left": point})
