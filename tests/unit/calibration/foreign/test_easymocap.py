"""EasyMocap's two files, written by OpenCV's FileStorage and by ourselves."""

import cv2
import numpy as np
import pytest

from courtside.calibration import file_formats
from courtside.calibration.foreign import easymocap
from courtside.geometry import camera as cameras
from courtside.study.errors import InputError
from fixtures.cameras import foreign_files as theirs


def seen_by_opencv(points):
    rotation = cv2.Rodrigues(theirs.ROTATION)[0]
    return cv2.projectPoints(points, rotation, theirs.TRANSLATION, theirs.K, theirs.DIST)[0][:, 0]


@pytest.mark.parametrize("given", ["", "intri.yml", "extri.yml"])
def test_the_folder_or_either_file_gives_the_cameras(tmp_path, given):
    theirs.easymocap(tmp_path)
    found = file_formats.read(tmp_path / given)
    assert [(camera.name, camera.size) for camera in found] == [
        ("01", (1920, 1080)),
        ("02", (1920, 1080)),
    ]
    xy = cameras.project(found[1], theirs.POINTS)
    np.testing.assert_allclose(xy, seen_by_opencv(theirs.POINTS), atol=1e-6)


def test_serial_numbers_keep_all_digits_without_quotation_marks(tmp_path):
    theirs.easymocap(tmp_path, names=("21418299", "2"))
    text = (tmp_path / "intri.yml").read_text()
    (tmp_path / "intri.yml").write_text(text.replace('"21418299"', "21418299").replace('"2"', "2"))
    assert [camera.name for camera in file_formats.read(tmp_path)] == ["21418299", "2"]


def test_what_we_write_is_what_opencv_reads(tmp_path):
    pose = np.column_stack([theirs.ROTATION, theirs.TRANSLATION])
    ours = cameras.Camera("left", theirs.SIZE, theirs.K, theirs.DIST, pose)
    for name, text in easymocap.texts([ours]).items():
        (tmp_path / name).write_text(text)
    lenses, places = (
        cv2.FileStorage(str(tmp_path / name), cv2.FILE_STORAGE_READ) for name in easymocap.FILES
    )
    assert lenses.getNode("names").at(0).string() == "left"
    assert (lenses.getNode("W_left").real(), lenses.getNode("H_left").real()) == (1920, 1080)
    points = cv2.projectPoints(
        theirs.POINTS, places.getNode("R_left").mat(), places.getNode("T_left").mat(),
        lenses.getNode("K_left").mat(), lenses.getNode("dist_left").mat(),
    )[0][:, 0]  # fmt: skip
    np.testing.assert_allclose(points, cameras.project(ours, theirs.POINTS), atol=1e-6)
    (again,) = file_formats.read(tmp_path)
    np.testing.assert_allclose(again.cam_from_world, pose, atol=1e-14)


def test_a_file_without_sizes_says_which_lines_to_add(tmp_path):
    theirs.easymocap(tmp_path, sized=False)
    with pytest.raises(InputError, match=r"camera 01: .*add two lines such as `W_01: 1920`") as one:
        file_formats.read(tmp_path)
    assert "\n" not in str(one.value)


def test_half_a_calibration_is_refused(tmp_path):
    theirs.easymocap(tmp_path)
    (tmp_path / "extri.yml").rename(tmp_path / "kept.yml")
    for given in (tmp_path, tmp_path / "intri.yml"):
        with pytest.raises(
            InputError, match=r": expected extri\.yml beside intri\.yml, found none"
        ):
            file_formats.read(given)
    (tmp_path / "intri.yml").rename(tmp_path / "other.yml")
    (tmp_path / "kept.yml").rename(tmp_path / "extri.yml")
    with pytest.raises(InputError, match=r": expected intri\.yml beside extri\.yml, found none"):
        file_formats.read(tmp_path)
    (tmp_path / "other.yml").rename(tmp_path / "intri.yml")
    (tmp_path / "extri.yml").write_text("%YAML:1.0\n---\nnames: 3\n")
    with pytest.raises(InputError, match=r"camera 01: expected rotation .* found nothing"):
        file_formats.read(tmp_path)
    (tmp_path / "intri.yml").write_text("%YAML:1.0\n---\nnames: 3\n")
    with pytest.raises(InputError, match=r"intri\.yml: expected names of cameras"):
        file_formats.read(tmp_path)


@pytest.mark.parametrize("text", ["<!DOCTYPE html>\n", ""])
def test_a_file_that_opencv_does_not_read_is_shown(tmp_path, text):
    theirs.easymocap(tmp_path)
    (tmp_path / "extri.yml").write_text(text)
    said = rf"extri\.yml: .* found: a text that begins with '{text.strip()}'; check it"
    with pytest.raises(InputError, match=said):
        file_formats.read(tmp_path)
