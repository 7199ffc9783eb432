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
    scale.check(CAMERAS, seen(), stick_figures.NAMES, "file")
    lengths = scale.trunks(CAMERAS, seen(), stick_figures.NAMES)
    assert len(lengths) > 100
    assert 0.4 < np.median(lengths) < 0.65


@pytest.mark.parametrize("unit", [name for name in METRES if name != "m"])
@pytest.mark.parametrize("places", [((0.4, 0.2),), ((-1.0, 0.5), (1.0, -0.6))])
def test_another_unit_is_named(unit, places):
    message = rf"cameras c0, c1, c2: expected people with trunks .*likely in {unit} \(0\.[45]"
    with pytest.raises(InputError, match=message) as caught:
        scale.check(in_unit(METRES[unit]), seen(places=places), stick_figures.NAMES, "file-people")
    assert f"`unit: {unit}`" in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("stated", "unit"), [("ft", "m"), ("cm", "mm"), ("mm", "m")])
def test_a_wrong_unit_that_the_session_states_is_named(stated, unit):
    cameras = in_unit(METRES[unit] / METRES[stated])
    message = rf"likely in {unit} \(0\.[45]\d m\): write `unit: {unit}` instead of `unit: {stated}`"
    with pytest.raises(InputError, match=message):
        scale.check(cameras, seen(), stick_figures.NAMES, "file", stated)
    assert scale.apart(cameras, "file", stated).endswith(
        f"correct `unit: {stated}` under calibration"
    )


def test_a_stated_unit_is_not_that_of_other_lengths():
    with pytest.raises(
        InputError, match=r"correct `square_m` of the board, about .*, as if in ft$"
    ):
        scale.check(in_unit(METRES["ft"]), seen(), stick_figures.NAMES, "board", "cm")


@pytest.mark.parametrize("way", ["file", None])
def test_a_scale_of_no_unit_asks_for_a_known_length(way):
    with pytest.raises(InputError, match="calibrate again with a known length"):
        scale.check(in_unit(0.1), seen(), stick_figures.NAMES, way)


@pytest.mark.parametrize(
    ("way", "metres", "advice"),
    [
        ("board", 0.1, "correct `square_m` of the board, about 1{} times too large$"),
        ("wand-people", 20, "correct `length_m` of the wand, about [12]{} times too small$"),
        ("known", 0.001, r"correct the places of the points \(x_m, .*\), about 1.*, as if in mm$"),
        ("people", 0.3048, "correct `height_m` of the subjects, or `known_lengths`, .* in ft$"),
        ("sfm-n40-lines", 0.001, "correct the places of the points in the court's file, about 1"),
    ],
)
def test_what_a_calibration_has_its_scale_from_is_to_be_corrected(way, metres, advice):
    message = "the scale of the calibration is wrong: " + advice.replace("{}", r"\d(\.\d)?")
    with pytest.raises(InputError, match=message) as caught:
        scale.check(in_unit(metres), seen(), stick_figures.NAMES, way)
    assert "unit:" not in str(caught.value)


def test_how_far_apart_cameras_stand_is_told_with_what_says_so():
    apart_m = max(np.linalg.norm(a.centre_in_world - b.centre_in_world)
                  for a in CAMERAS for b in CAMERAS)  # fmt: skip
    said = scale.apart(in_unit(0.1), "board")
    assert said == (
        f"the cameras stand up to {10 * apart_m:.1f} m apart: if that is wrong, correct `square_m` "
        "of the board"
    )
    assert scale.apart(CAMERAS, "file").endswith("correct their unit")


def test_views_that_agree_on_nobody_say_nothing():
    nothing = [np.full_like(view, np.nan) for view in seen()]
    scale.check(in_unit(0.3048), nothing, stick_figures.NAMES, "file")
    assert len(scale.trunks(CAMERAS, [view[:0] for view in nothing], stick_figures.NAMES)) == 0
