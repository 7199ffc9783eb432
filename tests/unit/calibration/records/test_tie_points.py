"""Tie-point constraints on the fixed cameras, written and read back; damaged files."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.bundle import conversion, selection, solver
from courtside.calibration.bundle import problem as networks
from courtside.calibration.court import joint_adjustment
from courtside.calibration.records import covariance, tie_points
from courtside.calibration.records.support import Support
from courtside.study.errors import InputError
from fixtures.cameras import networks_made
from fixtures.cameras.scene import opencv_projection

NAMES = ("side", "back")
SIZES = [(1280, 720), (960, 540)]
IMAGES = np.array(["static/side.png", "static/back.png", "frames/walk/000000.png"])
SUPPORT = Support(0.9, "static/back.png", 0.7, ("static/side.png", "walk/3.png"), 0.4)


def cameras():
    return [
        replace(camera, size=size)
        for camera, size in zip(
            networks_made.fixed_cameras(networks_made.make(2, 8), NAMES), SIZES, strict=True
        )
    ]


def record(**changes):
    made = networks_made.make(2, 8)
    knowledge = selection.marginalise(made, [0, 1])
    fields = {
        "outcome": "",
        "fault": "",
        "sfm_cameras": cameras(),
        "n_points_seen": [8, 5],
        "ties": joint_adjustment.Ties(NAMES, tuple(SIZES), knowledge),
        "images": IMAGES,
        "centres": np.arange(9.0).reshape(3, 3),
        "xyz": np.ones((4, 3)),
        "residual_px": 0.4,
        "n_maps": (2, 3),
        "support": SUPPORT,
        "strain": 2.5,
    }
    return tie_points.Record(**{**fields, **changes})


def through(tmp_path, made):
    tie_points.write(tmp_path / "ties.npz", made)
    return tie_points.read(tmp_path / "ties.npz")


def test_what_is_written_is_read(tmp_path):
    made = record()
    found = through(tmp_path, made)
    assert (found.outcome, found.fault, found.residual_px, found.strain) == ("", "", 0.4, 2.5)
    assert found.n_maps == (2, 3) and found.support == SUPPORT
    assert [c.name for c in found.sfm_cameras] == list(NAMES)
    assert [c.size for c in found.sfm_cameras] == SIZES
    for camera, known in zip(found.sfm_cameras, made.sfm_cameras, strict=True):
        np.testing.assert_allclose(
            opencv_projection(camera, np.array([[3.0, 6, 1]])),
            opencv_projection(known, np.array([[3.0, 6, 1]])),
            atol=1e-9,
        )
    assert (found.ties.cameras, found.ties.sizes) == (NAMES, tuple(SIZES))
    for name in ("information", "gradient"):
        expected = getattr(made.ties.knowledge, name)
        np.testing.assert_array_equal(getattr(found.ties.knowledge, name), expected)
    np.testing.assert_array_equal(found.n_points_seen, [8, 5])
    for name in ("images", "centres", "xyz"):
        np.testing.assert_array_equal(getattr(found, name), getattr(made, name))


def test_a_read_record_solves_as_the_written_one_does(tmp_path):
    """The reference network is built anew: nothing that an adjustment uses may be lost."""
    made = record()
    found = through(tmp_path, made)
    rng = np.random.default_rng(0)
    reference = made.ties.knowledge.reference
    step = 1e-3 * rng.normal(size=reference.n_columns)
    costs = [
        solver.cost(r.ties.knowledge.reference.moved(step, np.zeros((0, 3))), r.ties.knowledge)
        for r in (made, found)
    ]
    assert costs[0] > 0 and costs[1] == pytest.approx(costs[0], rel=1e-12)


def test_a_failure_is_a_record_too(tmp_path):
    nothing = {"ties": None, "residual_px": np.nan}
    found = through(tmp_path, record(fault="court points: mirrored", **nothing))
    assert (found.fault, found.ties) == ("court points: mirrored", None)
    assert np.isnan(found.residual_px) and len(found.sfm_cameras) == 2
    empty = {"sfm_cameras": [], "n_points_seen": [], "images": [], "centres": [], "xyz": []}
    found = through(tmp_path, record(outcome="walk: nothing", **nothing, **empty))
    assert (found.outcome, found.sfm_cameras, len(found.images)) == ("walk: nothing", [], 0)
    assert found.centres.shape == (0, 3) and found.xyz.shape == (0, 3)


def test_a_bare_network_holds_poses_and_lenses_only():
    made = selection.images_only(networks_made.make(2, 8), [0, 1])
    found = networks.without_points(made.cam_from_world, made.lens, [height for _, height in SIZES])
    assert networks.residuals(found).size == 0
    np.testing.assert_array_equal(found.height_px, [720, 540])
    rebuilt = conversion.cameras_of(found, NAMES, SIZES)
    for camera, known in zip(rebuilt, cameras(), strict=True):
        np.testing.assert_allclose(camera.K, known.K)
        np.testing.assert_allclose(camera.dist, known.dist)
        np.testing.assert_array_equal(camera.cam_from_world, known.cam_from_world)


def test_another_record_is_refused_in_one_line(tmp_path):
    path = tmp_path / "covariance.npz"
    covariance.write(path, covariance.CameraCovariance(["a"], np.eye(14)))
    with pytest.raises(InputError, match=r"covariance\.npz: expected") as caught:
        tie_points.read(path)
    assert "\n" not in str(caught.value)
