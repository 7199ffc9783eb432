"""Smoothness against accuracy: one mark per source and take, in millimetres."""

import numpy as np
import pandas as pd
import pytest

from courtside.figures.devices import smoothness_accuracy
from courtside.figures.style import source_styles
from fixtures.people import swung_arms

LABELS = {"session": "gym", "take": "1"}
_, DISTORTION = swung_arms.tables(
    [swung_arms.body(), swung_arms.body("d415-rgb", "rgb", depth=0.6, unit_m=0.8)]
)
DISTORTION = DISTORTION.assign(sparc=[-1.5, -1.7, -2.0, -2.4], **LABELS)


def errors(take="1"):
    about = {"session": "gym", "take": take, "joint": "all", "n": 9}
    return pd.DataFrame(
        [
            {**about, "source": "mocopi", "alignment": "body_frame", "median_mm": 80.0},
            {**about, "source": "mocopi", "alignment": "procrustes_frame", "median_mm": 20.0},
            {**about, "source": "d415-rgb", "alignment": "body_frame", "median_mm": 50.0},
            {
                **about,
                "source": "d415-rgb",
                "alignment": "body_frame",
                "joint": "nose",
                "median_mm": 9,
            },
        ]
    )


def test_both_wrists_make_one_mark_in_millimetres():
    rows = smoothness_accuracy.table(DISTORTION, errors()).set_index("source")
    assert rows["sparc"].to_dict() == pytest.approx({"mocopi": -1.6, "d415-rgb": -2.2})
    assert rows.loc["d415-rgb", ["sparc_low", "sparc_high"]].tolist() == [-2.4, -2.0]
    assert rows["median_error_mm"].to_dict() == {"mocopi": 80.0, "d415-rgb": 50.0}
    own = DISTORTION[DISTORTION["source"] == "d415-rgb"]["mean_distance"].mean()
    assert rows.loc["d415-rgb", "distortion_mm"] == pytest.approx(800 * own)
    assert rows.loc["mocopi", "distortion_mm"] == pytest.approx(0, abs=1e-9)
    assert rows["sparc_true"].isna().all()


def test_two_takes_are_read_and_only_one_has_a_truth(tmp_path):
    DISTORTION.drop(columns=list(LABELS)).to_csv(tmp_path / "d.csv", index=False)
    errors("2").to_csv(tmp_path / "e.csv", index=False)
    DISTORTION.assign(take="2", sparc=-1.55).to_csv(tmp_path / "t.csv", index=False)
    labels = [{**LABELS, "take": take} for take in "12"]
    files = [tmp_path / "d.csv"] * 2, labels, [tmp_path / "e.csv"], [tmp_path / "t.csv"]
    rows = smoothness_accuracy.read(*files)
    assert len(rows) == 4
    known = rows.groupby("take")[["median_error_mm", "sparc_true"]].count()
    assert known.loc["1"].tolist() == [0, 0] and known.loc["2"].tolist() == [2, 2]
    np.testing.assert_allclose(rows.loc[rows["take"] == "2", "sparc_true"], -1.55)


def marks(axis, source):
    look = source_styles.looks([source])[source]
    drawn = [a for a in axis.lines if a.get_color() == look.colour and a.get_marker() == "o"]
    return np.concatenate([line.get_xydata() for line in drawn])


def test_marks_stand_at_error_and_smoothness():
    truth = DISTORTION.assign(sparc=-1.55)
    drawing = smoothness_accuracy.draw(smoothness_accuracy.table(DISTORTION, errors(), truth))
    drawing.draw_without_rendering()
    left, right = drawing.axes
    np.testing.assert_allclose(marks(left, "mocopi"), [[80, -1.6]])
    np.testing.assert_allclose(marks(right, "mocopi"), [[0, -1.6]], atol=1e-9)
    dashes = [a.get_xydata()[0] for a in left.lines if a.get_marker() == "_"]
    assert sorted(map(tuple, dashes)) == [(50, -1.55), (80, -1.55)]
    assert left.get_ylim() == right.get_ylim()


def test_without_any_truth_one_panel_is_left():
    drawing = smoothness_accuracy.draw(smoothness_accuracy.table(DISTORTION))
    (axis,) = drawing.axes
    assert axis.get_xlabel() == smoothness_accuracy.PANELS["distortion_mm"]
    labels = [text.get_text() for text in drawing.legends[0].get_texts()]
    assert labels == ["mocopi", "d415-rgb", "one minimum-jerk reach"]
