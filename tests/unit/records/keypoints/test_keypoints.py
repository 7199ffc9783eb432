"""Records of keypoints survive their files."""

import tracemalloc
from dataclasses import fields, replace

import numpy as np
import pytest

from courtside.records.keypoints import keypoints
from courtside.study.errors import InputError
from fixtures.cameras import scene
from fixtures.people import walker


def equal(one, other):
    for field in fields(one):
        np.testing.assert_array_equal(getattr(one, field.name), getattr(other, field.name))


def test_3d_keypoints_are_read_as_written(tmp_path):
    record = walker.points(n_persons=2)
    keypoints.write_3d(tmp_path / "f.npz", record)
    found = keypoints.read_3d(tmp_path / "f.npz")
    equal(found, record)
    assert isinstance(found.model, str)


def test_2d_keypoints_are_read_as_written(tmp_path):
    record = walker.views(walker.points(), scene.ring(1))[0]
    keypoints.write_2d(tmp_path / "f.npz", record)
    equal(keypoints.read_2d(tmp_path / "f.npz"), record)


def test_one_kind_is_not_read_as_the_other(tmp_path):
    keypoints.write_3d(tmp_path / "f.npz", walker.points())
    with pytest.raises(InputError, match="keypoints2d"):
        keypoints.read_2d(tmp_path / "f.npz")


def test_the_rate_is_frames_per_second():
    assert walker.points().rate_hz == pytest.approx(50)
    assert np.isnan(replace(walker.points(), time_s=np.zeros(1)).rate_hz)


def test_a_wrong_shape_is_not_written(tmp_path):
    with pytest.raises(ValueError, match="n_views"):
        keypoints.write_3d(
            tmp_path / "f.npz", replace(walker.points(), n_views=np.zeros((1, 2, 3), int))
        )


@pytest.mark.parametrize("name", [field.name for field in fields(keypoints.Keypoints3D)])
def test_every_field_is_checked(tmp_path, name):
    wrong = replace(walker.points(), **{name: np.zeros((7, 7, 7, 7, 7, 7), complex)})
    with pytest.raises(ValueError, match=f"{name}: expected"):
        keypoints.write_3d(tmp_path / "f.npz", wrong)
    assert list(tmp_path.iterdir()) == []


def test_the_same_record_gives_the_same_bytes(tmp_path):
    for name in ("a.npz", "b.npz"):
        keypoints.write_3d(tmp_path / name, walker.points())
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_a_cut_off_or_missing_file_is_named(tmp_path):
    path = tmp_path / "f.npz"
    with pytest.raises(InputError, match=r"f\.npz: expected an npz file"):
        keypoints.read_3d(path)
    keypoints.write_3d(path, walker.points())
    path.write_bytes(path.read_bytes()[:-100])
    with pytest.raises(InputError, match=r"f\.npz: expected an npz file"):
        keypoints.read_3d(path)


def test_errors_that_are_not_known_need_no_memory(tmp_path):
    record = walker.points(n_frames=3000)
    unknown = keypoints.unknown_errors(record.xyz)
    for name in ("covariance_camera", "covariance_network"):
        assert unknown[name].shape == (*record.xyz.shape, 3)
        assert np.isnan(unknown[name]).all()
    path = tmp_path / "long.npz"
    keypoints.write_3d(path, replace(record, **unknown))
    lost = np.zeros(record.xyz.shape[:-1], bool)
    lost[0, 7, 3] = True
    tracemalloc.start()
    found = keypoints.read_3d(path).without(lost)
    kept = tracemalloc.get_traced_memory()[0]
    tracemalloc.stop()
    assert kept < 3 * record.xyz.nbytes  # three covariances alone have nine times as much
    for name, values in unknown.items():
        np.testing.assert_array_equal(getattr(found, name), values)


def test_errors_that_are_left_out_are_unknown_and_need_no_memory(tmp_path):
    record, path = walker.points(n_frames=3000), tmp_path / "long.npz"
    keypoints.write_3d(path, record)
    keypoints.read_3d(path)  # imports
    tracemalloc.start()
    found = keypoints.read_3d(path, left_out=("covariance_2d", "offset"))
    kept = tracemalloc.get_traced_memory()[0]
    tracemalloc.stop()
    assert kept < 3 * record.xyz.nbytes  # this covariance alone has three times as much
    assert np.isnan(found.covariance_2d).all() and np.isnan(found.offset).all()
    assert np.isfinite(record.covariance_2d).any()
    assert found.covariance_2d.shape == record.covariance_2d.shape
    np.testing.assert_array_equal(found.xyz, record.xyz)


def test_what_is_known_of_the_errors_of_some_points_is_read_and_left_out_with_them(tmp_path):
    record = walker.points()
    record.covariance_2d[0, 5:] = np.nan
    path = tmp_path / "some.npz"
    keypoints.write_3d(path, record)
    lost = np.zeros(record.xyz.shape[:-1], bool)
    lost[0, 2, 3] = True
    found = keypoints.read_3d(path).without(lost).covariance_2d
    assert np.isnan(found[0, 2, 3]).all() and np.isnan(found[0, 5:]).all()
    np.testing.assert_array_equal(found[0, :2], record.covariance_2d[0, :2])


def test_a_person_is_there_from_the_first_to_the_last_frame_seen():
    seen = np.array([[0, 1, 0, 1, 0], [0, 0, 0, 0, 0], [1, 0, 0, 0, 1]], bool)
    there = keypoints.while_there(seen).astype(int).tolist()
    assert there == [[0, 1, 1, 1, 0], [1, 1, 1, 1, 1], [1, 1, 1, 1, 1]]
