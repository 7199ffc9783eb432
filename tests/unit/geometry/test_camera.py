"""The camera model against OpenCV, COLMAP and real calibrations; its file as peers read it."""

import tomllib
from dataclasses import replace

import cv2
import numpy as np
import pycolmap
import pytest

from courtside.calibration import file_formats
from courtside.geometry import camera as cameras
from courtside.study.errors import InputError
from fixtures.cameras import scene
from fixtures.recordings.real_data import REAL, needs_real

ROTATION_VECTOR = np.array([1.2, -0.7, 0.4])
TRANSLATION = np.array([0.3, -0.5, 6.0])
K = np.array([[1500.0, 0.0, 950.0], [0.0, 1490.0, 545.0], [0.0, 0.0, 1.0]])
DIST = np.array([-0.21, 0.06, 0.0011, -0.0023, 0.013])
BARREL = np.array([-0.4, 0.0, 0.0, 0.0, 0.0])  # folds back at r = sqrt(1 / 1.2)


def make(**changes):
    pose = np.column_stack([cv2.Rodrigues(ROTATION_VECTOR)[0], TRANSLATION])
    camera = cameras.Camera("left", (1920, 1080), K, DIST, pose)
    return replace(camera, **changes)


def points(count=200, seed=1):
    return np.random.default_rng(seed).uniform(-1.5, 1.5, (count, 3))


def on_ray(camera, xy_normalised, depth_m):
    in_cam = np.concatenate([xy_normalised, np.ones_like(xy_normalised[..., :1])], -1) * depth_m
    return (in_cam - camera.cam_from_world[:, 3]) @ camera.cam_from_world[:, :3]


def pixels(camera, columns=65, rows=37):
    width, height = camera.size
    grid = np.meshgrid(
        np.linspace(-0.5, width - 0.5, columns), np.linspace(-0.5, height - 0.5, rows)
    )
    return np.stack(grid, axis=-1)


def test_projection_is_opencvs():
    expected = cv2.projectPoints(points(), ROTATION_VECTOR, TRANSLATION, K, DIST)[0][:, 0]
    np.testing.assert_allclose(cameras.project(make(), points()), expected, atol=1e-9)


def test_a_turned_camera_is_opencvs_with_both_rotations():
    turn = np.array([0.02, -0.03, 0.05])
    vector, translation = cv2.composeRT(ROTATION_VECTOR, TRANSLATION, turn, np.zeros(3))[:2]
    expected = cv2.projectPoints(points(), vector, translation, K, DIST)[0][:, 0]
    found = cameras.turned(make(), turn)
    np.testing.assert_allclose(cameras.project(found, points()), expected, atol=1e-9)
    np.testing.assert_allclose(found.centre_in_world, make().centre_in_world, atol=1e-9)


def test_projection_is_colmaps_half_a_pixel_apart():
    parameters = [*np.diag(K)[:2], *(K[:2, 2] + 0.5), *DIST[:4]]
    theirs = pycolmap.Camera(model="OPENCV", width=1920, height=1080, params=parameters)
    camera = make(dist=[*DIST[:4], 0.0])
    in_cam = points() @ camera.cam_from_world[:, :3].T + camera.cam_from_world[:, 3]
    expected = theirs.img_from_cam(in_cam) - 0.5
    np.testing.assert_allclose(cameras.project(camera, points()), expected, atol=1e-9)


def test_jacobian_is_opencvs():
    # OpenCV differentiates by the translation, which lies in the camera's axes.
    both = cv2.projectPoints(points(), ROTATION_VECTOR, TRANSLATION, K, DIST)[1]
    expected = both[:, 3:6].reshape(-1, 2, 3) @ cv2.Rodrigues(ROTATION_VECTOR)[0]
    np.testing.assert_allclose(projection_jacobian(make(), points()), expected, atol=1e-8)


def projection_jacobian(camera, xyz):
    """The derivative of `project`, by the library's derivative in the camera's own frame."""
    rotation, shift = camera.cam_from_world[:, :3], camera.cam_from_world[:, 3]
    in_cam = xyz @ rotation.T + shift
    normalised = in_cam[..., :2] / in_cam[..., 2:]
    by_place = cameras.jacobian_by_place(camera.dist, normalised, in_cam[..., 2:])
    return np.diag(camera.K)[:2, np.newaxis] * (by_place @ rotation)


def test_jacobian_is_the_central_difference():
    step = 1e-5
    moved = points()[:, np.newaxis] + step * np.concatenate([np.eye(3), -np.eye(3)])
    xy = cameras.project(make(), moved)
    expected = np.swapaxes(xy[:, :3] - xy[:, 3:], 1, 2) / (2 * step)
    np.testing.assert_allclose(projection_jacobian(make(), points()), expected, atol=1e-4)


def test_projection_takes_any_leading_shape():
    camera, xyz = make(), points(24)
    one_by_one = np.stack([cameras.project(camera, point) for point in xyz])
    many = cameras.project(camera, xyz.reshape(2, 3, 4, 3))
    np.testing.assert_allclose(many.reshape(24, 2), one_by_one, rtol=1e-14)
    assert cameras.undistort(camera, many).shape == (2, 3, 4, 2)
    assert projection_jacobian(camera, xyz.reshape(2, 3, 4, 3)).shape == (2, 3, 4, 2, 3)
    empty = np.zeros((0, 3))
    assert cameras.undistort(camera, cameras.project(camera, empty)).shape == (0, 2)


def test_points_missing_or_behind_the_camera_have_no_pixel():
    camera = make()
    seen = points(1)[0]
    behind = 2 * camera.centre_in_world - seen
    xyz = np.stack([seen, behind, [np.nan, 0.0, 0.0]])
    missing = [False, True, True]
    assert np.isnan(cameras.project(camera, xyz)).all(axis=-1).tolist() == missing
    xy = np.array([[10.0, 20.0], [np.nan, 20.0], [np.inf, 20.0]])
    assert np.isnan(cameras.undistort(camera, xy)).all(axis=-1).tolist() == [False, True, True]


def test_undistorting_gives_the_direction_back():
    camera = make()
    xy = pixels(camera)
    normalised = cameras.undistort(camera, xy)
    np.testing.assert_allclose(
        cameras.project(camera, on_ray(camera, normalised, 4.0)), xy, atol=1e-8
    )
    criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 500, 1e-14)
    expected = cv2.undistortPoints(xy.reshape(-1, 1, 2), K, DIST, criteria=criteria)
    np.testing.assert_allclose(normalised.reshape(-1, 2), expected[:, 0], atol=1e-9)


def test_undistorting_works_far_outside_the_picture():
    camera = make(dist=np.zeros(5))
    xy = np.array([[1e6, -3e5], [0.0, 0.0]])
    expected = (xy - K[:2, 2]) / np.diag(K)[:2]
    np.testing.assert_allclose(cameras.undistort(camera, xy), expected, rtol=1e-12)


def test_beyond_the_fold_is_missing():
    camera = make(dist=BARREL)
    fold = np.sqrt(1 / 1.2)
    assert camera.fold_radius == pytest.approx(fold, rel=1e-12)
    radii = np.array([0.5, 0.999, 1.001, 1.5]) * fold
    xy = cameras.project(camera, on_ray(camera, np.stack([radii, 0 * radii], axis=-1), 3.0))
    assert np.isnan(xy).any(axis=-1).tolist() == [False, False, True, True]
    largest = fold * (1 - 0.4 * fold**2)
    seen = np.array([0.5, 0.999, 1.001, 3.0])[:, np.newaxis] * [largest * K[0, 0], 0.0] + K[:2, 2]
    normalised = cameras.undistort(camera, seen)
    assert np.isnan(normalised).any(axis=-1).tolist() == [False, False, True, True]
    assert (normalised[:2, 0] < fold).all()


def test_a_model_that_rises_again_is_not_used_there():
    # Falls from r = 1, where it shows 0.6, to sqrt(2).
    camera = make(dist=[-0.5, 0.1, 0.0, 0.0, 0.0])
    assert camera.fold_radius == pytest.approx(1.0, rel=1e-12)
    shown = np.concatenate([np.linspace(0.01, 0.59, 50), np.linspace(0.601, 3.0, 500)])
    xy = np.stack([shown * K[0, 0], 0 * shown], axis=-1) + K[:2, 2]
    normalised = cameras.undistort(camera, xy)
    assert np.isnan(normalised).any(axis=-1).tolist() == [False] * 50 + [True] * 500
    x = normalised[:50, 0]
    np.testing.assert_allclose(x - 0.5 * x**3 + 0.1 * x**5, shown[:50], atol=1e-12)


@needs_real
def test_real_lenses_round_trip_within_their_pictures():
    for camera in file_formats.read(REAL / "charuco-4cams" / "camera_array.toml"):
        xy = pixels(camera)
        normalised = cameras.undistort(camera, xy)
        again = cameras.project(camera, on_ray(camera, normalised, 2.0))
        np.testing.assert_allclose(again, xy, atol=1e-6)


@needs_real
def test_real_points_project_to_where_they_were_seen():
    folder = REAL / "charuco-4cams" / "calibration" / "extrinsic" / "CHARUCO"
    xyz = np.genfromtxt(folder / "xyz_CHARUCO.csv", delimiter=",", names=True)
    xy = np.genfromtxt(folder / "xy_CHARUCO.csv", delimiter=",", names=True)
    known = {tuple(row)[:3]: list(row)[3:6] for row in xyz}
    for index, camera in enumerate(file_formats.read(REAL / "charuco-4cams" / "camera_array.toml")):
        seen = [row for row in xy[xy["cam_id"] == index] if (row[0], row[2], row[3]) in known]
        there = cameras.project(camera, np.array([known[row[0], row[2], row[3]] for row in seen]))
        off_px = np.linalg.norm(there - np.array([list(row)[4:6] for row in seen]), axis=-1)
        assert len(seen) > 300
        assert np.median(off_px) < 1.6


def test_a_cut_out_shows_the_same_points_elsewhere():
    part = cameras.crop(make(), [120, 40, 1000, 900])
    assert part.size == (1000, 900)
    expected = cameras.project(make(), points()) - [120, 40]
    np.testing.assert_allclose(cameras.project(part, points()), expected, atol=1e-10)


@pytest.mark.parametrize(
    "crop_px", [[-1, 0, 100, 100], [0, 0, 1921, 1080], [900, 0, 1080, 1080], [0, 0, 0, 10]]
)
def test_a_cut_out_lies_inside(crop_px):
    with pytest.raises(InputError, match=r"camera left: expected crop_px .* inside .*1920x1080"):
        cameras.crop(make(), crop_px)


def test_a_video_of_another_size_is_explained():
    camera = make(size=(1088, 1920))
    with pytest.raises(InputError) as caught:
        cameras.check_size(camera, (1080, 1920), "cam01.mp4")
    for word in ("cam01.mp4", "left", "1088x1920", "1080x1920", "`crop_px: [x, y, 1080, 1920]`"):
        assert word in str(caught.value)
    cameras.check_size(cameras.crop(camera, [0, 0, 1080, 1920]), (1080, 1920), "cam01.mp4")


def test_the_centre_is_where_the_camera_is():
    camera = make()
    in_cam = camera.cam_from_world[:, :3] @ camera.centre_in_world + camera.cam_from_world[:, 3]
    np.testing.assert_allclose(in_cam, 0, atol=1e-14)


def mirrored():
    return np.column_stack([np.diag([1.0, 1.0, -1.0]), TRANSLATION])


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"K": np.eye(4)}, "expected K as"),
        ({"K": np.diag([0.0, 1.0, 1.0])}, "expected a matrix of positive focal lengths"),
        ({"K": np.where(np.arange(9).reshape(3, 3) == 1, 1.0, K)}, "expected a matrix .* no skew"),
        ({"K": K.T}, "expected a matrix .* no skew"),
        ({"dist": np.zeros(4)}, "expected dist as"),
        ({"dist": [0, 0, np.nan, 0, 0]}, "expected dist as"),
        ({"cam_from_world": np.eye(3)}, "expected cam_from_world as"),
        ({"cam_from_world": mirrored()}, "expected a right-handed rotation"),
        ({"cam_from_world": np.eye(3, 4) * 1.00001}, "expected .* orthonormal"),
        ({"cam_from_world": np.full((3, 4), np.inf)}, "expected cam_from_world as"),
        ({"size": (1920.5, 1080)}, "expected size as"),
        ({"size": (0, 1080)}, "expected size as"),
        ({"size": (1920, 1080, 3)}, "expected size as"),
    ],
)
def test_impossible_cameras_are_refused(changes, message):
    with pytest.raises(ValueError, match=message):
        make(**changes)


def test_a_camera_does_not_change():
    matrix = K.copy()
    camera = make(K=matrix)
    matrix[0, 0] = 1.0
    assert camera.K[0, 0] == 1500.0
    with pytest.raises(ValueError, match="read-only"):
        camera.K[0, 0] = 1.0


def test_file_gives_the_cameras_back(tmp_path):
    many = [make(name=f"c{index}", K=K + np.diag([index / 3, 0, 0])) for index in range(12)]
    cameras.write_toml(tmp_path / "cameras.toml", many, source='a "quoted" source')
    again = cameras.read_toml(tmp_path / "cameras.toml")
    assert [camera.name for camera in again] == [camera.name for camera in many]
    for ours, theirs in zip(many, again, strict=True):
        assert ours.size == theirs.size
        np.testing.assert_array_equal(ours.K, theirs.K)
        np.testing.assert_array_equal(ours.dist, theirs.dist)
        np.testing.assert_allclose(ours.cam_from_world, theirs.cam_from_world, atol=1e-15)
    assert [path.name for path in tmp_path.iterdir()] == ["cameras.toml"]


def test_file_is_as_peers_read_it(tmp_path):
    """Pose2Sim reads every table but `metadata` in file order, aniposelib in order of names."""
    many = [make(name=f"c{index}") for index in range(11)]
    cameras.write_toml(tmp_path / "cameras.toml", many, source="test")
    content = tomllib.loads((tmp_path / "cameras.toml").read_text(encoding="utf-8"))
    assert content.pop("metadata") == {
        "adjusted": False,
        "error": 0.0,
        "unit": "m",
        "source": "test",
    }
    assert list(content) == sorted(content)
    for index, table in enumerate(content.values()):
        assert table["name"] == f"c{index}"
        assert table["size"] == [1920, 1080]
        assert table["fisheye"] is False
        rotation = cv2.Rodrigues(np.array(table["rotation"]))[0]
        np.testing.assert_allclose(rotation, cv2.Rodrigues(ROTATION_VECTOR)[0], atol=1e-12)
        xy = cv2.projectPoints(
            points(), np.array(table["rotation"]), np.array(table["translation"]),
            np.array(table["matrix"]), np.array(table["distortions"]),
        )[0][:, 0]  # fmt: skip
        np.testing.assert_allclose(xy, cameras.project(many[index], points()), atol=1e-9)


def test_the_same_cameras_make_the_same_file(tmp_path):
    for name in ("a.toml", "b.toml"):
        cameras.write_toml(tmp_path / name, [make()], source="test")
    assert (tmp_path / "a.toml").read_bytes() == (tmp_path / "b.toml").read_bytes()


TABLE = """
[cam_0]
name = "left"
size = [1920.0, 1080.0]
matrix = [[1500.0, 0.0, 950.0], [0.0, 1490.0, 545.0], [0.0, 0.0, 1.0]]
distortions = [-0.2, 0.1, 0.0, 0.0]
rotation = [0.1, 0.2, 0.3]
translation = [100.0, 200.0, 300.0]
fisheye = false
"""


@pytest.mark.parametrize(
    ("metadata", "metres"),
    [("", 1.0), ("[metadata]\nerror = 0.0", 1.0), ('[metadata]\nunit = "mm"', 0.001),
     ('[metadata]\nunit = "cm"', 0.01)],
)  # fmt: skip
def test_lengths_are_read_in_the_unit_of_the_file(tmp_path, metadata, metres):
    (tmp_path / "c.toml").write_text(TABLE + metadata, encoding="utf-8")
    (camera,) = cameras.read_toml(tmp_path / "c.toml")
    np.testing.assert_allclose(camera.cam_from_world[:, 3], np.array([100, 200, 300]) * metres)
    assert camera.size == (1920, 1080)
    np.testing.assert_array_equal(camera.dist, [-0.2, 0.1, 0, 0, 0])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("rotation = [0.1, 0.2, 0.3]", "", "camera left: expected rotation .* found nothing"),
        ("[0.1, 0.2, 0.3]", '["a", "b", "c"]', "camera left: expected rotation as 3"),
        ("[0.1, 0.2, 0.3]", "[nan, 0.2, 0.3]", "camera left: expected rotation"),
        ("[0.1, 0.2, 0.3]", "[57.3, 14.2, -3.0]", r"left: expected [^:]* found 59\.11, as in"),
        ("[0.1, 0.2, 0.3]", "[[1.0, 0, 0], [0, 1, 0], [0, 0, -1]]", "left: .*right-handed"),
        ("[0.1, 0.2, 0.3]", "[[1.0, 0, 0], [0, 1, 0], [0, 0, 2]]", "left: .*orthonormal"),
        ("[100.0, 200.0, 300.0]", "[1.0, 2.0]", "left: expected translation as 3"),
        ("[1500.0, 0.0, 950.0]", "[0.0, 0.0, 950.0]", "left: .*positive focal"),
        ("[1500.0, 0.0, 950.0]", "[1500.0, 950.0]", "left: expected matrix as 3x3"),
        ("[-0.2, 0.1, 0.0, 0.0]", "[-0.2]", "left: expected distortions"),
        ("[-0.2, 0.1, 0.0, 0.0]", "[0, 0, 0, 0, 0, 1, 0, 0]", "left: .*five coefficients"),
        ("1920.0, 1080.0", "1920.5, 1080.0", "left: expected size"),
        ("1920.0, 1080.0", "-1920, 1080", "left: expected size"),
        ("fisheye = false", "fisheye = true", "left: .*fisheye = true"),
        ("fisheye = false", '[metadata]\nunit = "inch"', "expected unit as one of m, cm, mm"),
        ("fisheye = false", "[metadata]\nunit = 3", "expected unit as one of m, cm, mm"),
        ("fisheye = false", "fisheye = fal", "expected TOML"),
        ("[cam_0]", "[metadata]", "expected cameras, found none; export"),
    ],
)
def test_malformed_files_are_one_line_to_mend(tmp_path, old, new, message):
    (tmp_path / "c.toml").write_text(TABLE.replace(old, new), encoding="utf-8")
    with pytest.raises(InputError, match=message) as caught:
        cameras.read_toml(tmp_path / "c.toml")
    assert "c.toml" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_two_cameras_of_one_name_are_refused(tmp_path):
    (tmp_path / "c.toml").write_text(TABLE + TABLE.replace("cam_0", "cam_1"), encoding="utf-8")
    with pytest.raises(InputError, match="different names"):
        cameras.read_toml(tmp_path / "c.toml")
    with pytest.raises(InputError, match="different names"):
        cameras.write_toml(tmp_path / "d.toml", [make(), make()], source="test")


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(InputError, match=r"none\.toml"):
        cameras.read_toml(tmp_path / "none.toml")


def test_a_plain_camera_looks_along_z_through_the_centre_of_its_picture():
    camera = cameras.plain("left", (1920, 1080), 1.2)
    assert camera.K[0, 0] == camera.K[1, 1] == pytest.approx(2304.0)
    np.testing.assert_allclose(cameras.project(camera, [0.0, 0.0, 2.0]), [959.5, 539.5])


def test_a_camera_looks_at_its_aim_and_roll_turns_it_about_its_axis():
    level, rolled = (cameras.look_at([0, -5, 1], [0, 0, 1], np.radians(roll)) for roll in (0, -10))
    np.testing.assert_allclose(level[:, :3], [[1, 0, 0], [0, 0, -1], [0, 1, 0]], atol=1e-12)
    # Turned clockwise, the camera sees what is straight below to the right of its middle.
    down = rolled[:, :3] @ [0, 0, -1.0]
    np.testing.assert_allclose(
        down, [np.sin(np.radians(10)), np.cos(np.radians(10)), 0], atol=1e-12
    )
    np.testing.assert_allclose(rolled[:, :3] @ [0, -5, 1] + rolled[:, 3], 0, atol=1e-12)


def test_slopes_of_the_picture_are_differences_and_never_flat():
    lens = scene.ring(1, dist=(-0.25, 0.07, 1e-3, -5e-4, -0.007))[0]
    places = np.random.default_rng(0).uniform(-0.8, 0.8, (50, 2))

    def seen(plane):
        in_cam = np.column_stack([plane, np.ones(len(plane))])
        at_origin = replace(lens, cam_from_world=np.eye(3, 4))
        return cameras.project(at_origin, in_cam)

    steps = 1e-6 * np.eye(2)
    expected = np.stack([(seen(places + d) - seen(places - d)) / 2e-6 for d in steps], axis=-1)
    np.testing.assert_allclose(cameras.picture_slopes(lens, places), expected, atol=1e-3)
    at_fold = np.array([[lens.fold_radius, 0.0]])
    slopes = np.linalg.svd(cameras.picture_slopes(lens, at_fold)[0], compute_uv=False)
    assert slopes.min() == pytest.approx(cameras.LEAST_SLOPE * lens.K[0, 0])
