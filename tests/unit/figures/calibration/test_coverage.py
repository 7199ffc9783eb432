"""Coverage drawn is the mean of the trials' own, in per cent."""

import pandas as pd
import pytest

from courtside.evaluation.tables import calibration
from courtside.figures.calibration import coverage
from fixtures.cameras import trials_made

SFM, FEW = ("sfm", 18, True), ("sfm", 8, True)


@pytest.fixture(scope="module")
def numbers():
    first = trials_made.structure({SFM: [1.0, 3.0], FEW: [9.0, 9.0]})
    second = trials_made.structure({SFM: [5.0, 5.0]}, offset=1)
    second["coverage90"] = 1.0
    parts = [first, second, trials_made.structure(2, offset=2)]
    parts += [trials_made.structure({SFM: [1.0]}, session="rich-a", n_bridging=40)]
    parts += [trials_made.structure({SFM: [50.0]}, mapper="incremental")]
    return coverage.table(calibration.tidy(pd.concat(parts)))


def test_shares_are_means_over_trials(numbers):
    found = calibration.pick(numbers, session="plain-a").squeeze()
    assert (found.n, found.n_failed, found.n_clicks) == (4, 2, 18)
    assert found.coverage50 == pytest.approx(40)
    assert found.coverage90 == pytest.approx(90)
    assert found.volume_rms_cm_median == 4.0
    assert found.predicted_volume_cm_median == 2.0


def test_each_session_has_its_column(numbers):
    drawing = coverage.draw(numbers)
    shown = [axis for axis in drawing.axes if axis.get_visible()]
    assert [axis.get_title().split("\n")[0] for axis in shown[:2]] == ["plain-a", "rich-a"]
    assert len(shown) == 4
    assert "2 of 6 failed" in shown[0].get_title()


def test_more_sessions_take_more_rows():
    parts = [trials_made.structure({SFM: [1.0]}, session=f"s{n}") for n in range(6)]
    drawing = coverage.draw(coverage.table(calibration.tidy(pd.concat(parts))))
    assert sum(axis.get_visible() for axis in drawing.axes) == 12
