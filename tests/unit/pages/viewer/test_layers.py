"""Layers say of every joint what the records say; devices are put where the cameras see them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from courtside.pages.viewer import layers
from courtside.records.devices import device_motion
from courtside.records.devices.clocks import Clock
from courtside.records.keypoints import keypoints
from courtside.study.errors import InputError
from fixtures.people import walker
from fixtures.study.unpacking import size_of, unpacked


@pytest.fixture
def record():
    return walker.points(n_frames=40, n_persons=2)


def device(n_frames=40, rate_hz=50):
    """Return a device that shows the walker, after a first frame that nobody performed."""
    xyz = walker.body(n_frames)
    return device_motion.DeviceMotion(
        source="mocopi",
        kind="inertial",
        joints=np.array(walker.SKELETON.joints),
        time_s=np.arange(n_frames) / rate_hz,
        xyz=xyz,
        reason=np.zeros(xyz.shape[:2], np.uint8),
        performed=np.arange(n_frames) > 0,
    )


def test_covariances_add_up_and_name_their_parts(record):
    alone = layers.of_points("raw", record, walker.SKELETON)
    np.testing.assert_array_equal(alone.covariance, record.covariance_2d)
    assert alone.covers == "keypoints only, cameras taken as exact"
    known = replace(record, covariance_camera=2 * record.covariance_2d)
    both = layers.of_points("raw", known, walker.SKELETON)
    np.testing.assert_allclose(both.covariance, 3 * record.covariance_2d)
    assert both.covers == "keypoints and cameras"
    network = replace(known, covariance_network=3 * record.covariance_2d)
    every = layers.of_points("raw", replace(network, offset=0.1 + 0 * record.xyz), walker.SKELETON)
    np.testing.assert_allclose(every.covariance, 6 * record.covariance_2d + 0.01)
    assert every.covers == "keypoints, network, offset and cameras"


def test_the_reprojection_error_is_that_of_views_used(record):
    layer = layers.of_points("raw", record, walker.SKELETON)
    used = record.reproj_error_px[0, 5, 7, [0, 2]]  # c1 is rejected there
    assert layer.error_px[0, 5, 7] == pytest.approx(np.sqrt((used**2).mean()))
    assert np.isnan(layer.error_px[0, 3, 4])


def test_the_packed_layer_holds_the_records_numbers(record):
    layer = layers.of_points("raw", record, walker.SKELETON)
    content = layers.packed(layer, np.zeros(3), every=2)
    shape = (2, 33, 20)
    assert content["time_s"] == record.time_s[::2].tolist()
    assert content["bones"][0] == [11, 12]  # both shoulders in BlazePose's order
    known = unpacked(content["known"], shape)
    assert known.all()  # frame 3, where a joint is missing, is not kept
    sigma = size_of(unpacked(content["ellipsoid"], (2, 33, 6, 20))[:, :, :3])
    np.testing.assert_allclose(sigma[0, 0, :, 0], [0.01, 0.02, 0.03], rtol=0.028)
    error_px = size_of(unpacked(content["error_px"], shape)) / layers.PX
    np.testing.assert_allclose(
        error_px, np.moveaxis(layer.error_px[:, ::2], 1, 2), rtol=0.03, equal_nan=True
    )
    assert unpacked(content["n_views"], shape)[0, 0, 0] == 3


def test_missing_joints_keep_their_reason(record):
    record.xyz[0, 6, 2] = np.nan  # called ok all the same
    layer = layers.of_points("raw", record, walker.SKELETON)
    content = layers.packed(layer, np.zeros(3))
    reason = unpacked(content["reason"], (2, 33, 40))
    assert reason[0, 4, 3] == record.reason[0, 3, 4] == 4
    assert reason[0, 2, 6] == 255
    assert (reason > 0).sum() == 3  # and the other person's joint 4 in frame 3


def test_files_of_points_and_devices_are_recognised(tmp_path, record):
    keypoints.write_3d(tmp_path / "points.npz", record)
    device_motion.write(tmp_path / "device.npz", device())
    read = layers.read(tmp_path / "points.npz", "raw", walker.SKELETON)
    assert read.person_id == ("p1", "p2")
    clock = Clock(offset_s=1.0, drift_ppm=100.0)
    read = layers.read(tmp_path / "device.npz", "mocopi", walker.SKELETON, person="p1", clock=clock)
    assert (read.person_id, len(read.time_s)) == (("p1",), 39)
    assert read.time_s[0] == pytest.approx((0.02 - 1) / 1.0001)
    (tmp_path / "other.npz").write_bytes(b"nothing")
    with pytest.raises(InputError, match=r"other\.npz.*expected"):
        layers.read(tmp_path / "other.npz", "x", walker.SKELETON)


def test_a_device_without_a_performed_frame_is_named():
    still = replace(device(), performed=np.zeros(40, dtype=bool))
    with pytest.raises(InputError, match=r"layer mocopi: expected frames .* found none"):
        layers.of_device("mocopi", still, walker.SKELETON, "p1")


def test_a_device_is_put_where_the_person_is(record):
    turn = Rotation.from_euler("z", 70, degrees=True).as_matrix()
    moved = replace(device(), xyz=device().xyz @ turn.T + [5, -3, 0.2])
    layer = layers.of_device("mocopi", moved, walker.SKELETON, "p1")
    onto = layers.of_points("raw", record, walker.SKELETON)
    found = layers.placed(layer, onto)
    np.testing.assert_allclose(found.xyz[0], device().xyz[1:], atol=1e-9)
    with pytest.raises(InputError, match="found 0 persons"):
        layers.placed(replace(layer, person_id=("p9",)), onto)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"xyz": np.zeros((1, 2, 3, 3))}, "xyz"),
        ({"time_s": np.zeros(40)}, "increase"),
        ({"bones": (("nose", "tail"),)}, "tail"),
    ],
)
def test_inconsistent_layers_are_refused(record, change, word):
    layer = layers.of_points("raw", record, walker.SKELETON)
    with pytest.raises(ValueError, match=word):
        replace(layer, **change)
