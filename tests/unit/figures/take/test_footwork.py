"""The figure of footwork draws the stances."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from courtside.calibration.court import court
from courtside.figures.take import footwork as drawing
from courtside.footwork import feet
from fixtures.people import walking_feet

CONFIG = Path(__file__).parents[4] / "config"


@pytest.fixture(scope="module")
def found():
    return feet.find(walking_feet.record(walking_feet.hop(), 3.0)[0], walking_feet.CUTOFFS)


def test_bars_and_marks_are_the_stances(found):
    contacts, steps, events = found
    made = drawing.draw(contacts, steps, events, court.read(CONFIG / "courts" / "badminton.yaml"))
    made.draw_without_rendering()
    plan, bars, chance = made.subfigs[0].axes
    widths = sorted(bar.get_width() for bar in bars.patches)
    start = steps.onset_s.fillna(contacts.time_s[0])
    stop = steps.end_s.fillna(contacts.time_s[-1])
    np.testing.assert_allclose(widths, sorted(stop - start))
    assert [text.get_text() for text in bars.texts] == ["split step"]
    np.testing.assert_array_equal(chance.lines[0].get_ydata(), contacts.probability[0, :, 0])
    marked = [line for line in plan.lines if line.get_marker() == "v" and len(line.get_xdata())]
    assert len(marked) == 2


def test_a_stance_that_a_gap_cuts_is_drawn_as_far_as_the_foot_is_seen(found):
    contacts, steps, events = found
    cut = steps.assign(end_s=np.nan, seen_until_s=2.5)
    made = drawing.draw(contacts, cut, events, None)
    bars = made.subfigs[0].axes[1].patches
    assert [bar.get_x() + bar.get_width() for bar in bars] == pytest.approx([2.5] * len(steps))


def test_no_court_and_no_step(found):
    contacts, steps, events = found
    made = drawing.draw(contacts, steps[:0], events[:0], None)
    made.draw_without_rendering()
    assert "landings: 0" in made.subfigs[0].axes[0].get_title()
    assert drawing.table(steps).columns.tolist()[:2] == ["person", "foot"]


def test_a_take_of_minutes_has_landings_a_minute_and_the_mean_contact(found):
    contacts, steps, events = found
    n_rounds = 50  # of three seconds
    later = 3.0 * np.arange(n_rounds)
    long = replace(
        contacts,
        time_s=np.concatenate([contacts.time_s + at for at in later]),
        probability=np.tile(contacts.probability, (1, n_rounds, 1)),
    )
    each = [steps.assign(onset_s=steps.onset_s + at) for at in later]
    made = drawing.draw(long, pd.concat(each, ignore_index=True), events, None)
    made.draw_without_rendering()
    _, landings, share = made.subfigs[0].axes
    for foot, line in zip(("left", "right"), landings.lines, strict=False):
        per_minute = 20 * steps[steps.foot == foot].onset_s.notna().sum()
        assert line.get_ydata().mean() == pytest.approx(per_minute, rel=0.02)
    assert landings.lines[2].get_label() == "lunges"
    mean = np.nanmean(contacts.probability[0], axis=0)
    drawn = [line.get_ydata().mean() for line in share.lines]
    assert drawn == pytest.approx(mean.tolist(), abs=0.02)
    assert share.get_xlabel() == "time (s): means of each 5 s"
