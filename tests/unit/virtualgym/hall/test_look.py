"""Looks of halls: within their limits, none without strength."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from courtside.calibration.court import court as court_files
from virtualgym.hall import hall, look
from virtualgym.presets import PLAIN

COURT = court_files.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")


def test_without_strength_the_look_is_the_usual_one():
    assert look.draw(0.0, np.random.default_rng(0)) is look.USUAL


@pytest.mark.parametrize("strength", [1.0, 2.0])
def test_looks_differ_within_their_limits(strength):
    drawn = [look.draw(strength, np.random.default_rng(seed)) for seed in range(200)]
    wide, deep, tall = np.transpose([each.room for each in drawn])
    for side in (wide, deep):
        assert 1 <= side.min() < 1.03 and side.max() > 1 + 0.24 * strength
        assert side.max() <= 1 + look.LARGER * strength
    assert np.abs(tall - 1).max() <= look.HEIGHT * strength
    tints = np.array([[*each.floor, *each.wall, *each.panel] for each in drawn])
    assert 0.9 * look.TINT * strength < np.abs(tints).max() <= look.TINT * strength
    sizes = np.log([[each.plank, each.panels, each.windows] for each in drawn])
    assert 0.9 * look.PATTERN * strength < np.abs(sizes).max() <= look.PATTERN * strength


def test_a_hall_has_the_size_and_colours_of_its_look():
    own = dataclasses.replace(look.USUAL, room=(1.2, 1.1, 0.8), floor=(30.0, 0.0, -30.0))
    usual, made = (
        hall.build(PLAIN, COURT, 3, floor_texel_m=0.1, look=each) for each in (look.USUAL, own)
    )
    np.testing.assert_allclose(np.ptp(made.room_m, axis=0) / np.ptp(usual.room_m, axis=0), own.room)
    change = [np.median(s.quads[0].texture, axis=(0, 1)) for s in (usual, made)]
    np.testing.assert_allclose(change[1] - change[0], own.floor, atol=4)
    np.testing.assert_array_equal(usual.court_xyz, made.court_xyz)
