"""A model as a network: the same views as COLMAP's, in the project's pixels."""

import numpy as np
import pycolmap
import pytest

from courtside.calibration.bundle import problem as networks
from courtside.sfm import model
from fixtures.cameras import sfm_made


@pytest.fixture(scope="module")
def truth(tmp_path_factory):
    return sfm_made.synthetic(tmp_path_factory.mktemp("model") / "m.db", n_points=40)


def test_the_network_sees_what_colmap_sees(truth, tmp_path):
    rng = np.random.default_rng(0)
    for point in truth.points3D.values():
        point.xyz = point.xyz + 0.02 * rng.normal(size=3)  # that there are errors to compare
    truth.write_binary(str(tmp_path))
    found, names, sizes = model.read(tmp_path)
    assert names == [f"camera000001_frame{at:06d}.png" for at in range(6)] and sizes == [(640, 480)]
    images = {image.name: image for image in truth.images.values()}
    ours = networks.residuals(found)
    keys = sorted(truth.points3D)
    assert len(ours) == 6 * 40
    for at in range(len(ours)):
        image, key = images[names[found.image_idx[at]]], keys[found.point_idx[at]]
        (place,) = [p for p in image.points2D if p.has_point3D() and p.point3D_id == key]
        np.testing.assert_allclose(found.xy[at], place.xy - 0.5)
        expected = image.project_point(truth.points3D[key].xyz) - place.xy
        np.testing.assert_allclose(ours[at], expected, atol=1e-7)


def test_images_without_a_place_are_left_out(truth, tmp_path):
    truth.deregister_frame(truth.images[2].frame_id)
    truth.write_binary(str(tmp_path))
    found, names, _ = model.read(tmp_path)
    assert names == [f"camera000001_frame{at:06d}.png" for at in (0, 2, 3, 4, 5)]
    assert found.cam_from_world.shape == (5, 3, 4) and found.image_idx.max() == 4
    np.testing.assert_allclose(found.cam_from_world[1], truth.images[3].cam_from_world().matrix())


def test_each_camera_has_its_lens(tmp_path):
    made = pycolmap.Reconstruction()
    for k, width in ((7, 640), (3, 320)):
        params = [500.0 + k, 510.0, width / 2, 120, 0.01 * k, 0, 0, 0]
        made.add_camera_with_trivial_rig(
            pycolmap.Camera(model="OPENCV", width=width, height=240, params=params, camera_id=k)
        )
    for image_id, k in ((1, 7), (2, 3), (5, 7)):
        image = pycolmap.Image(
            name=f"{image_id}", keypoints=np.zeros((0, 2)), camera_id=k, image_id=image_id
        )
        made.add_image_with_trivial_frame(image, pycolmap.Rigid3d())
    made.write_binary(str(tmp_path))
    found, names, sizes = model.read(tmp_path)
    assert names == ["1", "2", "5"] and sizes == [(320, 240), (640, 240)]
    assert found.lens_of_image.tolist() == [1, 0, 1]
    np.testing.assert_allclose(found.lens[1], [510, 507 / 510, 319.5, 119.5, 0.07, 0, 0, 0])
    assert len(found.xy) == len(found.xyz) == 0


def test_an_empty_model_is_an_empty_network(tmp_path):
    pycolmap.Reconstruction().write_binary(str(tmp_path))
    found, names, sizes = model.read(tmp_path)
    assert names == [] and sizes == []
    assert found.cam_from_world.shape == (0, 3, 4) and found.lens.shape == (0, 8)
    assert found.n_columns == 0 and found.xy.shape == (0, 2) and found.xyz.shape == (0, 3)


def test_what_is_known_of_a_lens_follows_its_picture():
    mean, sigma = model.lens_prior([(1280, 720), (640, 480), (720, 1280)])
    np.testing.assert_array_equal(mean[:, 2:4], [[639.5, 359.5], [319.5, 239.5], [359.5, 639.5]])
    np.testing.assert_allclose(sigma[:, 2:4], [[25.6, 25.6], [12.8, 12.8], [25.6, 25.6]])
    assert np.isinf(sigma[:, 0]).all() and (mean[:, 1] == 1).all()
    assert [values.shape for values in model.lens_prior([])] == [(0, 8), (0, 8)]
