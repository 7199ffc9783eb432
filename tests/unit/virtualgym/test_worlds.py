"""Worlds: strengths from a file, and their faults."""

import pytest

from virtualgym import worlds


def test_effects_that_are_not_named_are_off():
    made = worlds.build({"lens": 1, "court": 0.5})
    assert (made.lens, made.court) == (1, 0.5)
    others = [getattr(made, name) for name in worlds.EFFECTS if name not in ("lens", "court")]
    assert others == [0.0] * 6
    assert worlds.build(made) is made


@pytest.mark.parametrize("strength", [-0.1, 2.1, "1", None, float("nan")])
def test_a_strength_beyond_two_or_no_number_is_refused(strength):
    with pytest.raises(ValueError, match=r"expected a strength of world.court in 0..2, found"):
        worlds.build({"court": strength})


def test_an_unknown_effect_is_refused():
    with pytest.raises(ValueError, match=r"expected effects of .*'lens'.*, found \['fog'\]"):
        worlds.build({"fog": 1})
