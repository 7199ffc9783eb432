"""A camera brought back to where it was by offsets of lines that are known exactly."""

import numpy as np
import pytest

from courtside.calibration.click_proposals import line_profiles, refine_pose
from courtside.calibration.court import line_edges
from courtside.geometry import camera as cameras
from fixtures.cameras import court_pictures


def offsets(start, true, court):
    """Return what perfect profiles would say: place, normal and offset of each stretch."""
    line, ends = line_edges.stretches(court, 1.6)
    middle = ends.mean(axis=1)
    halves = np.array([line_edges.middle_line(court, number)[1] for number in line])
    _, normal = line_profiles.tangent_and_normal(start, middle, ends[:, 1] - ends[:, 0], halves)
    off = cameras.project(true, middle) - cameras.project(start, middle)
    return middle, normal, np.sum(off * normal, axis=1)


@pytest.fixture
def court():
    return court_pictures.badminton()


def test_a_change_is_what_its_parameters_say(court):
    camera = court_pictures.pair()[0]
    np.testing.assert_allclose(
        refine_pose.moved(camera, np.zeros(8)).cam_from_world, camera.cam_from_world
    )
    change = np.array([0, 0, 0, 0.1, -0.2, 0.3, 0.01, 0.02])
    found = refine_pose.moved(camera, change)
    step = camera.cam_from_world[:, :3] @ (found.centre_in_world - camera.centre_in_world)
    np.testing.assert_allclose(step, [0.1, -0.2, 0.3], atol=1e-12)
    assert found.K[0, 0] / camera.K[0, 0] == pytest.approx(np.exp(0.01))
    assert found.dist[0] - camera.dist[0] == pytest.approx(0.02)
    turned = refine_pose.moved(camera, np.array([0, 0.01, 0, 0, 0, 0, 0, 0.0]))
    np.testing.assert_allclose(turned.centre_in_world, camera.centre_in_world, atol=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_lines_bring_the_camera_back(court, seed):
    rng = np.random.default_rng(seed)
    true = court_pictures.pair()[seed % 2]
    start = refine_pose.moved(true, rng.normal(0, 0.4, 8) * refine_pose.PRIOR_SIGMA)
    middle, normal, off = offsets(start, true, court)
    noisy = off + rng.normal(0, 0.05, len(off))
    noisy[:4] += 15  # other lines taken for these
    sigma = np.full(len(off), 0.05)
    found = refine_pose.refine(start, middle, normal, noisy, sigma)
    floor = court.xyz[court.xyz[:, 2] == 0]
    before = np.linalg.norm(cameras.project(start, floor) - cameras.project(true, floor), axis=1)
    after = np.linalg.norm(cameras.project(found, floor) - cameras.project(true, floor), axis=1)
    assert np.median(before) > 1
    assert np.median(after) < 0.15 and after.max() < 0.6
    rest = noisy - offsets(start, found, court)[2]
    assert np.abs(rest[:4]).min() > 10 and np.median(np.abs(rest[4:])) < 0.1


def test_without_offsets_nothing_moves(court):
    camera = court_pictures.pair()[0]
    middle, normal, off = offsets(camera, camera, court)
    found = refine_pose.refine(camera, middle, normal, off, np.ones(len(off)))
    np.testing.assert_allclose(found.cam_from_world, camera.cam_from_world, atol=1e-9)
