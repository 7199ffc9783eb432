"""What is known of cameras before: stated numbers, and a covariance turned into a `Quadratic`."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.calibration.bundle import conversion
from courtside.calibration.people import prior, world_frame
from courtside.calibration.records import covariance
from courtside.geometry.similarity import Sim3
from fixtures.cameras import corner_cameras

CAMERAS = corner_cameras.four_cameras()


def test_stated_numbers_are_standard_deviations_with_units():
    found = prior.stated(CAMERAS, **corner_cameras.STATED)
    sigma = np.sqrt(np.diag(found.covariance)).reshape(4, -1)
    expected = [*[np.radians(0.3)] * 3, *[0.03] * 3, 7.0, 0, 5.76, 5.76, 0.01, 0, 0, 0]
    np.testing.assert_allclose(sigma, [expected] * 4)
    turned = prior.stated([replace(c, size=c.size[::-1]) for c in CAMERAS], **corner_cameras.STATED)
    np.testing.assert_allclose(turned.covariance, found.covariance)


def test_knowledge_is_the_inverse_of_what_is_not_fixed():
    known = prior.stated(CAMERAS, **corner_cameras.STATED)
    mixed = np.random.default_rng(0).normal(size=(len(known.covariance),) * 2) * 0.1
    mixed += np.eye(len(mixed))
    whole = mixed @ known.covariance @ mixed.T
    fixed = np.diag(known.covariance) == 0
    whole[fixed], whole[:, fixed] = 0.0, 0.0
    given = type(known)(known.cameras, whole)
    quadratic = prior.knowledge(CAMERAS, given)
    columns, free = given.of_columns(), np.diag(quadratic.information) > 0
    assert free.sum() == (~fixed).sum()
    product = quadratic.information[np.ix_(free, free)] @ columns[np.ix_(free, free)]
    np.testing.assert_allclose(product, np.eye(free.sum()), atol=1e-6)
    assert not quadratic.gradient.any()
    free_lens = np.isinf(prior.lens_sigma(quadratic))
    assert free_lens.tolist() == [[True, False, True, True, True, False, False, False]] * 4


def test_a_datum_that_does_not_vary_is_known():
    known = prior.stated(CAMERAS, **corner_cameras.STATED)
    places = np.random.default_rng(0).uniform([-3, -3, 0], [3, 3, 2], (200, 3))
    shape = world_frame.of_shape(CAMERAS, known.of_columns(), places, None)
    given = covariance.of_network(known.cameras, shape)
    quadratic = prior.knowledge(CAMERAS, given)
    network = conversion.network_of(CAMERAS)
    shift = Sim3(1.0, np.eye(3), np.array([0.03, 0.0, 0.0]))
    moved = conversion.network_of([shift.camera(camera) for camera in CAMERAS]).difference(network)
    sigmas = np.sqrt(moved @ quadratic.information @ moved)
    assert sigmas > 100


def test_cameras_are_taken_by_name():
    known = prior.stated(CAMERAS, **corner_cameras.STATED)
    with pytest.raises(ValueError, match="c9"):
        known.of(["c9"])
    turned = prior.knowledge(CAMERAS[::-1], known)
    assert turned.reference.cam_from_world[0] == pytest.approx(CAMERAS[3].cam_from_world)
