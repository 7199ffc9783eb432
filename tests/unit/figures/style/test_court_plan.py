"""A court's plan is the court."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from courtside.calibration.court import court
from courtside.figures.style import court_plan, style

COURT = court.read(Path(__file__).parents[4] / "config" / "courts" / "badminton.yaml")


def test_lines_have_their_true_width_and_place():
    axis = style.figure(60).subplots()
    court_plan.draw(axis, COURT)
    drawn = np.array([patch.get_bbox().extents for patch in axis.patches])
    np.testing.assert_allclose(drawn, COURT.lines_m)
    assert axis.get_aspect() == 1
    np.testing.assert_allclose(axis.lines[0].get_xydata(), [[0, 6.7], [6.1, 6.7]])


def test_a_court_may_have_no_net():
    axis = style.figure(60).subplots()
    court_plan.draw(axis, replace(COURT, net=None), least_pt=0.5)
    assert len(axis.lines) == 0
    assert {patch.get_linewidth() for patch in axis.patches} == {0.5}
