"""Units by the size of a body and the rate; times that stray, repeat or begin again."""

import numpy as np
import pytest

from courtside.devices import plausible
from courtside.study.errors import InputError

STEPS = np.arange(100) / 30


@pytest.mark.parametrize(
    ("found", "unit", "likely"),
    [
        (0.016, "cm", "m (1.60 m): write `unit: m`"),
        (16.0, "cm", "mm (1.60 m): write `unit: mm`"),
        (0.6, "cm", "in (1.52 m): write `unit: in`"),
        (160.0, "m", "cm (1.60 m): write `unit: cm`"),
        (0.2, "m", "export the file again"),
    ],
)
def test_the_unit_that_fits_is_named(found, unit, likely):
    with pytest.raises(InputError) as caught:
        plausible.check_length("a.bvh", "a body", found, unit, (0.85, 2.3))
    message = str(caught.value)
    assert message.startswith("a.bvh: expected a body of 0.85 to 2.3 m, found")
    assert likely in message
    assert "\n" not in message


def test_lengths_and_rates_of_people_pass():
    plausible.check_length("a.bvh", "a body", 1.6, "cm", (0.85, 2.3))
    for rate_hz in (10, 50, 240):
        plausible.check_rate("a.bvh", np.arange(9) / rate_hz, "")
    plausible.check_rate("a.bvh", np.zeros(1), "")


def test_times_in_order_are_kept_and_repeated_ones_left_out(caplog):
    assert plausible.in_order("a", STEPS).tolist() == list(range(100))
    assert plausible.in_order("a", np.repeat(STEPS, 2)).tolist() == list(range(0, 200, 2))
    assert plausible.in_order("a", np.empty(0)).tolist() == []
    assert not caplog.records


@pytest.mark.parametrize("at", [0, 1, 50, 98])
@pytest.mark.parametrize("by_s", [3600.0, -3600.0])
def test_one_stray_time_costs_one_frame(at, by_s, caplog):
    times = STEPS + by_s * (np.arange(100) == at)
    kept = plausible.in_order("a", times)
    if (at, by_s) == (0, -3600.0):  # it is in order: nothing tells it from a late second frame
        assert kept.tolist() == list(range(100))
    else:
        assert kept.tolist() == [k for k in range(100) if k != at]
        assert "a: left out: 1 of 100 frames out of order" in caplog.text


@pytest.mark.parametrize("at", [2, 20, 50, 90])
def test_a_clock_that_begins_again_is_refused(at):
    times = np.where(np.arange(100) < at, STEPS + 500, STEPS)
    with pytest.raises(InputError, match=rf"found {100 - at} of 100 frames out of order.*was set"):
        plausible.in_order("a", times)


def test_no_more_frames_are_held_than_are_looked_at():
    read = []

    def stamped():
        for at, time_s in enumerate(STEPS.tolist()):
            read.append(at)
            yield at, time_s, None

    for at, _, _ in plausible.following("a", stamped()):
        assert len(read) - at <= plausible.IN_A_ROW + 1
    assert len(read) == len(STEPS)
