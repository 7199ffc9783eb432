"""The two kinds of virtual session: which of them is the harder one, and in what."""

import dataclasses

from virtualgym.presets import PLAIN, PRESETS, RICH


def test_presets_are_found_by_name():
    assert {"rich": RICH, "plain": PLAIN} == PRESETS


def test_the_plain_hall_is_harder_in_everything_that_differs():
    less = {"posters_per_m", "n_gear", "contrast", "n_scuffs"}
    for field in dataclasses.fields(RICH):
        if field.name == "name":
            continue
        rich, plain = getattr(RICH, field.name), getattr(PLAIN, field.name)
        assert (plain <= rich) if field.name in less else (plain >= rich), field.name


def test_paint_and_clicks_do_not_depend_on_the_kind():
    for name in ("line_sigma_m", "click_sigma_px_at_3840", "click_bias_px_at_3840"):
        assert getattr(RICH, name) == getattr(PLAIN, name) > 0
