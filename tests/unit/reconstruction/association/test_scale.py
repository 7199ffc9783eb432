"""The scale of a calibration by the size of people: every unit, and what says nothing."""

from dataclasses import replace

import numpy as np
import pytest

from courtside.geometry.camera_fields import METRES
from courtside.reconstruction.association import scale
from courtside.study.errors import InputError
from fixtures.cameras import scene
from fixtures.people import stick_figures

CAMERAS = [replace(camera, name=f"c{at}") for at, camera in enumerate(scene.ring(3))]
TIME_S = np.arange(60) / 30


def seen(seed=3, noise_px=3.0, places=((-1.0, 0.5), (1.0, -0.6))):
    """Return what the cameras see of people who walk past each other."""
    rng = np.random.default_rng(seed)
    paths = [stick_figures.path(rng, TIME_S, (place, np.negative(place))) for place in places]
    bodies = np.stack([stick_figures.body(path, TIME_S, 1.0, 1.0, 0.2) for path in paths])
    return stick_figures.seen(CAMERAS, bodies, rng, noise_px=noise_px)[0]


def in_unit(metres):
    """Return the cameras as they are read in metres from a file in another unit."""
    scaled = np.array([1, 1, 1, 1 / metres])
    return [replace(one, cam_from_world=one.cam_from_world * scaled) for one in CAMERAS]


def test_people_of_their_size_pass():
    scale.check(CAMERAS, seen(), stick_figures.NAMES)
    lengths = scale.trunks(CAMERAS, seen(), stick_figures.NAMES)
    assert len(lengths) > 100
    assert 0.4 < np.median(lengths) < 0.65


@pytest.mark.parametrize("unit", [name for name in METRES if name != "m"])
@pytest.mark.parametrize("places", [((0.4, 0.2),), ((-1.0, 0.5), (1.0, -0.6))])
def test_another_unit_is_named(unit, places):
    message = rf"cameras c0, c1, c2: expected people with trunks .*likely in {unit} \(0\.[45]"
    with pytest.raises(InputError, match=message) as caught:
        scale.check(in_unit(METRES[unit]), seen(places=places), stick_figures.NAMES)
    assert f"`unit: {unit}`" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_scale_of_no_unit_asks_for_a_known_length():
    with pytest.raises(InputError, match="calibrate again with a known length"):
        scale.check(in_unit(0.1), seen(), stick_figures.NAMES)


def test_views_that_agree_on_nobody_say_nothing():
    nothing = [np.full_like(view, np.nan) for view in seen()]
    scale.check(in_unit(0.3048), nothing, stick_figures.NAMES)
    assert len(scale.trunks(CAMERAS, [view[:0] for view in nothing], stick_figures.NAMES)) == 0
