"""The covariance of cameras: which column is which, written and read back."""

import numpy as np
import pytest

from courtside.calibration.bundle import problem as networks
from courtside.calibration.bundle import selection
from courtside.calibration.records import covariance
from courtside.study.errors import InputError
from fixtures.cameras import networks_made

N = len(covariance.PARAMETERS)


def symmetric(size, seed=0):
    root = np.random.default_rng(seed).normal(size=(size, size))
    return root @ root.T


def test_parameters_are_named_in_their_order():
    pose = ["rx_rad", "ry_rad", "rz_rad", "tx_m", "ty_m", "tz_m"]
    lens = ["f_px", "aspect", "cx_px", "cy_px", "k1", "k2", "p1", "p2"]
    assert list(covariance.PARAMETERS) == pose + lens


@pytest.mark.parametrize("at", range(2 * N))
def test_each_column_is_the_parameter_of_its_name(at):
    """A step along the network's column moves that camera's parameter and no other."""
    made = selection.images_only(networks_made.make(2, 5), [0, 1])
    step = np.zeros(made.n_columns)
    step[covariance.columns(2)[at]] = 1e-3
    moved = made.moved(step, np.zeros((0, 3)))
    camera, parameter = divmod(at, N)
    name = covariance.PARAMETERS[parameter]
    lens = np.zeros((2, 8))
    pose = np.zeros((2, 3))
    if name in networks.LENS:
        lens[camera, networks.LENS.index(name)] = 1e-3
    elif name.startswith("t"):
        pose[camera, networks.POSE.index(name) - 3] = 1e-3
    np.testing.assert_allclose(moved.lens - made.lens, lens, atol=1e-12)
    turned = moved.cam_from_world[:, :, :3] @ made.cam_from_world[:, :, :3].transpose(0, 2, 1)
    if name.startswith("r"):
        axis = networks.POSE.index(name)
        skew = (turned[camera] - turned[camera].T) / 2
        np.testing.assert_allclose(
            [skew[2, 1], skew[0, 2], skew[1, 0]], 1e-3 * np.eye(3)[axis], atol=1e-9
        )
        turned[camera] = np.eye(3)
    else:
        shift = moved.cam_from_world[:, :, 3] - made.cam_from_world[:, :, 3]
        np.testing.assert_allclose(shift, pose, atol=1e-12)
    np.testing.assert_allclose(turned, np.stack([np.eye(3)] * 2), atol=1e-12)


def test_flex_is_left_out_and_comes_back_as_certain():
    whole = symmetric(38)
    found = covariance.of_network(["a", "b"], whole)
    assert found.covariance.shape == (2 * N, 2 * N)
    assert found.covariance[0, 6] == whole[0, 22]  # turn of a with its focal length
    assert found.covariance[N, 6] == whole[11, 22]  # turn of b with the focal length of a
    assert found.covariance[N + 6, N + 6] == whole[30, 30]
    back = found.of_columns()
    flex = np.r_[6:11, 17:22]
    assert not back[flex].any() and not back[:, flex].any()
    others = np.setdiff1d(np.arange(38), flex)
    np.testing.assert_array_equal(back[np.ix_(others, others)], whole[np.ix_(others, others)])


def test_what_is_written_is_read(tmp_path):
    frame = np.diag([1.0, 2, 3])
    made = covariance.CameraCovariance(["side", "back"], symmetric(2 * N), frame)
    made.covariance[N:] = np.nan
    covariance.write(tmp_path / "c.npz", made)
    found = covariance.read(tmp_path / "c.npz")
    assert found.cameras == ["side", "back"]
    np.testing.assert_array_equal(found.covariance, made.covariance)
    np.testing.assert_array_equal(found.of(["back"]).frame, frame)
    with np.load(tmp_path / "c.npz") as stored:
        assert stored["parameter"].tolist() == list(covariance.PARAMETERS)


def test_a_file_that_is_none_is_refused_in_one_line(tmp_path):
    (tmp_path / "c.npz").write_bytes(b"nothing")
    with pytest.raises(InputError, match=r"c\.npz: expected") as caught:
        covariance.read(tmp_path / "c.npz")
    assert "\n" not in str(caught.value)
    assert covariance.columns(0).shape == (0,)
