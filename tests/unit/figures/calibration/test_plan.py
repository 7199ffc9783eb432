"""The figure of a plan shows what was predicted, and the number of images that is enough."""

import numpy as np
import pytest

from courtside.calibration.planning.prediction import Prediction
from courtside.figures.calibration import plan


def prediction(n_images, error_cm, fault=""):
    errors = (error_cm / 2, error_cm, 2 * error_cm)
    degrees = 100 / n_images if n_images else np.nan
    return Prediction(n_images, degrees, 10 * n_images, 3 * n_images, errors, fault=fault)


@pytest.fixture
def rows():
    found = [prediction(40, 0.7), prediction(0, 1.2), prediction(20, 0.75), prediction(75, 0.69)]
    return plan.table(found, found[2])


def test_the_table_is_in_order_and_marks_what_is_enough(rows):
    assert rows["n_images"].tolist() == [0, 20, 40, 75]
    assert rows["enough"].tolist() == [0, 1, 1, 1]
    assert rows["error_median_cm"].tolist() == [1.2, 0.75, 0.7, 0.69]
    assert rows["error_p05_cm"].tolist() == [0.6, 0.375, 0.35, 0.345]
    assert rows["error_p95_cm"].tolist() == [2.4, 1.5, 1.4, 1.38]
    assert rows["least_ties"].tolist() == [0, 60, 120, 225]
    assert plan.table([prediction(20, 1)], None)["enough"].tolist() == [0]


def test_the_drawing_shows_the_table(rows):
    drawing = plan.draw(rows, "title", min_points=20, widest_deg=6.0, target_cm=0.8)
    above, angle, ties = drawing.axes
    lines = {line.get_label(): line for line in above.get_lines()}
    median = lines["median; band: 90 % of sessions"]
    assert median.get_xydata().tolist() == [[20, 0.75], [40, 0.7], [75, 0.69]]
    assert lines["court points alone"].get_ydata() == pytest.approx([1.2, 1.2])
    assert lines["wanted"].get_ydata() == pytest.approx([0.8, 0.8])
    assert lines["enough: 20 images"].get_xydata().tolist() == [[20, 0.75]]
    assert angle.get_lines()[1].get_ydata() == pytest.approx([6, 6])
    assert ties.get_lines()[0].get_ydata() == pytest.approx([60, 120, 225])
    assert above.get_ylim()[1] > 2.4


def test_a_plan_without_an_answer_or_a_prediction_is_drawn(tmp_path):
    found = [prediction(5, 0.9), prediction(10, np.nan, fault="camera side: expected matches")]
    rows = plan.table(found, None)
    drawing = plan.draw(rows, "title", min_points=20, widest_deg=6.0)
    labels = [line.get_label() for line in drawing.axes[0].get_lines()]
    assert labels == ["median; band: 90 % of sessions"]
    drawing.savefig(tmp_path / "x.png")
    assert rows["fault"].tolist() == ["", "camera side: expected matches"]


def test_a_plan_without_a_walk_shows_its_error_alone(tmp_path):
    drawing = plan.draw(
        plan.table([prediction(0, 1.2)], None), "title", min_points=20, widest_deg=6
    )
    (axis,) = drawing.axes
    (bars,) = axis.containers
    assert bars.lines[0].get_xydata().tolist() == [[1.2, 0]]
    (bar,) = bars.lines[2]
    assert bar.get_segments()[0][:, 0] == pytest.approx([0.6, 2.4])
    assert axis.get_xlabel() == "expected RMS 3D error over the court (cm)"
    drawing.savefig(tmp_path / "x.png")
