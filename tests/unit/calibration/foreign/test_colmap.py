"""COLMAP's models: written by hand, by pycolmap, and by ourselves for pycolmap."""

from dataclasses import replace

import numpy as np
import pycolmap
import pytest

from courtside.calibration import file_formats
from courtside.calibration.foreign import colmap
from courtside.geometry import camera as cameras
from courtside.study.errors import InputError
from fixtures.cameras import foreign_files as theirs

POSE = np.column_stack([theirs.ROTATION, theirs.TRANSLATION])
OURS = cameras.Camera("left", theirs.SIZE, theirs.K, theirs.DIST, POSE)
LENSES = {
    "SIMPLE_PINHOLE": ([1500, 950, 545], np.zeros(5)),
    "PINHOLE": ([1500, 1490, 950, 545], np.zeros(5)),
    "SIMPLE_RADIAL": ([1500, 950, 545, -0.1], [-0.1, 0, 0, 0, 0]),
    "RADIAL": ([1500, 950, 545, -0.1, 0.02], [-0.1, 0.02, 0, 0, 0]),
    "OPENCV": ([1500, 1490, 950, 545, *theirs.DIST[:4]], [*theirs.DIST[:4], 0]),
    "FULL_OPENCV": ([1500, 1490, 950, 545, *theirs.DIST, 0, 0, 0], theirs.DIST),
}


def model(name, parameters):
    """Return a reconstruction of two pictures of one camera, by pycolmap."""
    made = pycolmap.Reconstruction()
    lens = pycolmap.Camera(
        model=name, width=theirs.SIZE[0], height=theirs.SIZE[1], params=parameters, camera_id=1
    )
    made.add_camera_with_trivial_rig(lens)
    for number, file in ((1, "left.png"), (2, "right.png")):
        image = pycolmap.Image(name=file, camera_id=1, image_id=number)
        image.points2D = pycolmap.Point2DList([pycolmap.Point2D([1.0, 2.0])] * number)
        made.add_image_with_trivial_frame(image, pycolmap.Rigid3d(POSE))
    return made


@pytest.mark.parametrize("name", LENSES)
def test_models_by_pycolmap_project_to_the_same_px(tmp_path, name):
    parameters, dist = LENSES[name]
    made = model(name, parameters)
    for folder, write in (("text", made.write_text), ("binary", made.write_binary)):
        (tmp_path / folder).mkdir()
        write(str(tmp_path / folder))
        left, right = file_formats.read(tmp_path / folder, "m")
        assert (left.name, right.name, left.size) == ("left", "right", theirs.SIZE)
        np.testing.assert_allclose(left.dist, dist)
        xy = cameras.project(right, theirs.POINTS)
        # COLMAP's own projection has the first pixel's centre at (0.5, 0.5).
        colmaps = made.cameras[1].img_from_cam(theirs.in_camera())
        np.testing.assert_allclose(xy, np.asarray(colmaps) - 0.5, atol=1e-6)


@pytest.mark.parametrize(
    ("name", "more"),
    [
        ("FULL_OPENCV", [-0.2, 0.09, 0.001, -0.0007, -0.02, 0.05, 0.01, -0.003]),
        ("OPENCV_FISHEYE", [-0.03, 0.01, -0.004, 0.0008]),
    ],
)
def test_other_lenses_by_pycolmap_are_followed_by_five_coefficients(tmp_path, name, more):
    made = model(name, [3400, 3404, 950, 545, *more])
    made.write_text(str(tmp_path))
    left, _ = file_formats.read(tmp_path, "m")
    rng = np.random.default_rng(1)
    in_camera = np.column_stack([rng.uniform(-0.25, 0.25, (200, 2)) * [1, 0.6], np.ones(200)])
    colmaps = np.asarray(made.cameras[1].img_from_cam(in_camera)) - 0.5
    inside = ((colmaps >= 0) & (colmaps <= np.array(theirs.SIZE) - 1)).all(axis=1)
    assert inside.sum() > 150
    off = cameras.project(replace(left, cam_from_world=np.eye(3, 4)), in_camera) - colmaps
    assert np.abs(off[inside]).max() < 0.01


def test_pycolmap_projects_with_what_we_write(tmp_path):
    for name, text in colmap.texts([OURS]).items():
        (tmp_path / name).write_text(text)
    made = pycolmap.Reconstruction(str(tmp_path))
    (image,) = made.images.values()
    assert image.name == "left.png"
    xy = np.array([image.project_point(point) for point in theirs.POINTS])
    np.testing.assert_allclose(xy - 0.5, cameras.project(OURS, theirs.POINTS), atol=1e-6)


@pytest.mark.parametrize("given", ["", "cameras.txt", "images.txt"])
def test_the_unit_has_to_be_stated(tmp_path, given):
    theirs.colmap(tmp_path, metres=0.01)
    with pytest.raises(InputError, match=r"COLMAP model of a stated scale.*`unit: m`") as caught:
        file_formats.read(tmp_path / given)
    assert "\n" not in str(caught.value)
    (camera,) = file_formats.read(tmp_path / given, "cm")
    np.testing.assert_allclose(camera.cam_from_world, POSE)
    np.testing.assert_allclose(
        cameras.project(camera, theirs.POINTS), cameras.project(OURS, theirs.POINTS), atol=1e-6
    )


@pytest.mark.parametrize("name", ["right.png", "from the right.png"])
def test_images_without_their_second_lines_are_refused(tmp_path, name):
    for file, text in colmap.texts([OURS, replace(OURS, name="right")]).items():
        text = text.replace("right.png", name)
        (tmp_path / file).write_text(text)
    assert len(file_formats.read(tmp_path, "m")) == 2
    images = (tmp_path / "images.txt").read_text()
    (tmp_path / "images.txt").write_text(images.replace("\n\n", "\n"))
    with pytest.raises(
        InputError, match=r"found: no line, empty or of points, behind left\.png in"
    ):
        file_formats.read(tmp_path, "m")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("FULL_OPENCV", "FOV", "camera left: expected a lens of .* found FOV with 12"),
        ("4 FULL_OPENCV", "5 FULL_OPENCV", "camera left: expected its lens as camera 4 .*found 5"),
        ("1920 1080", "wide 1080", "expected a COLMAP model, found: could not"),
        (" 0.0\n", "\n", "camera left: .*with 11 parameters"),
    ],
)
def test_malformed_is_one_line_to_mend(tmp_path, old, new, message):
    theirs.colmap(tmp_path)
    text = (tmp_path / "cameras.txt").read_text()
    assert old in text
    (tmp_path / "cameras.txt").write_text(text.replace(old, new))
    with pytest.raises(InputError, match=message) as caught:
        file_formats.read(tmp_path, "m")
    assert "\n" not in str(caught.value)
