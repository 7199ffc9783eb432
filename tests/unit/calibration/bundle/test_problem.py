"""Observations of a network against OpenCV, and their derivatives against differences."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from courtside.calibration.bundle import problem as networks
from fixtures.cameras import networks_made


def test_observations_are_opencvs():
    made = networks_made.make()
    for image in (0, 1, 4):
        f, aspect, cx, cy, *dist = made.lens[made.lens_of_image[image]]
        K = np.array([[f * aspect, 0, cx], [0, f, cy], [0, 0, 1]])
        pose = made.cam_from_world[image]
        turn = cv2.Rodrigues(pose[:, :3])[0]
        seen, _ = cv2.projectPoints(made.xyz, turn, pose[:, 3], K, np.array(dist))
        ours = (networks.residuals(made) + made.xy)[made.image_idx == image]
        np.testing.assert_allclose(ours, seen[:, 0], atol=1e-8)


def test_derivatives_are_differences():
    made = networks_made.disturbed(networks_made.make(n_points=8, flex=True))
    made.lens[:, 1] = 1.01
    _, by_camera, by_point = networks.linearised(made)
    columns = made.columns()
    step = 1e-6
    for column in range(19):
        change = np.zeros((len(made.xy), 2))
        for sign in (1, -1):
            for image in range(len(made.cam_from_world)):
                mine = made.image_idx == image
                shift = np.zeros(made.n_columns)
                shift[columns[mine][0, column]] = sign * step
                moved = networks.residuals(made.moved(shift, 0.0))
                change[mine] += sign * moved[mine] / (2 * step)
        scale = max(1.0, np.abs(change).max())
        np.testing.assert_allclose(by_camera[:, :, column], change, atol=2e-5 * scale)
    for axis in range(3):
        shift = np.zeros_like(made.xyz)
        shift[:, axis] = step
        ahead, behind = (
            networks.residuals(made.moved(np.zeros(made.n_columns), s * shift)) for s in (1, -1)
        )
        np.testing.assert_allclose(by_point[:, :, axis], (ahead - behind) / (2 * step), atol=1e-4)


def test_rolling_shutter_turns_rows_by_their_time():
    made = networks_made.make(flex=False)
    spin = np.array([0.0, 0.02, 0.0])  # the camera turns to the right while rows are read
    flexed = replace(made, flex=np.tile([*spin, 0, 0], (len(made.flex), 1)))
    moved = networks.residuals(flexed) + flexed.xy
    still = networks.residuals(made) + made.xy
    time = (made.xy[:, 1] + 0.5) / 720 - 0.5
    about = made.lens[made.lens_of_image[made.image_idx], 0] * 0.02 * time
    np.testing.assert_allclose((moved - still)[:, 0], about, rtol=0.35, atol=0.05)


def test_difference_undoes_a_step():
    made = networks_made.make(flex=True)
    step = 0.01 * np.random.default_rng(2).standard_normal(made.n_columns)
    moved = made.moved(step, 0.0)
    np.testing.assert_allclose(moved.difference(made), step, atol=1e-12)


def test_lengths_must_agree():
    made = networks_made.make()
    with pytest.raises(ValueError, match="expected sigma_px of length"):
        replace(made, sigma_px=made.sigma_px[:-1])
