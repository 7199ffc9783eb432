"""The methods: what was configured is what is said, and what was not used is not."""

import copy
import re

import pytest

from courtside.pages.report import methods
from courtside.study.methods import Calibration
from fixtures.study import report_made


@pytest.fixture
def study(tmp_path):
    return copy.deepcopy(report_made.study(tmp_path))


def methods_text(study, used_hz=None):
    """Return the methods; court points were clicked, and covariances known as usual, if unsaid."""
    sessions = [
        {"clicked": True, "has_covariance": Calibration.parse(one["calibration"]).has_covariance}
        | one
        for one in study["sessions"]
    ]
    return methods.paragraphs(study["parameters"], sessions, used_hz or {})


def test_methods_state_the_configuration(study):
    html = methods_text(study)
    for words in (
        "from 40 pictures of the walk",
        "a ratio of 0.8",
        "a standard deviation of 0.7 px per axis",
        "network blazepose-full",
        "<code>all-robust</code>: views are weighted",
        "within 0.05 of the person's height",
        "6 Hz (head), 10 Hz (arms)",
        "nothing is filtered again",
        "less 0.35 (&plusmn; 0.5) of the length",
    ):
        assert words in html, words


def test_methods_follow_another_configuration(study):
    study["parameters"]["filter_motion"]["cutoff_hz"] = {"head": 3}
    study["parameters"]["triangulate"] |= {"max_error_px": 9, "min_views": 3}
    study["sessions"][0] |= {"mapper": "incremental", "n_images": 12}
    html = methods_text(study)
    assert "by 3 cameras or more (by all, where fewer were used) were" in html
    assert "3 Hz (head)" in html and "within 9 px" in html and "from 12 pictures" in html
    assert "incremental, Schönberger" in html and "Global structure-from-motion" not in html


def test_cut_offs_that_were_lowered_or_chosen_are_stated_with_their_takes(study):
    stated = {"head": 6.0, "arms": 10.0}
    assert "; at" not in methods_text(study, {("hall", "smash"): stated})
    slow = {"head": 2.69, "arms": 2.69}
    html = re.sub(r"\s+", " ", methods_text(study, {("hall", "smash"): slow}))
    assert (
        "6 Hz (head), 10 Hz (arms) (Winter 2009); at 2.69 Hz (head), 2.69 Hz (arms) in hall smash, "
        "as chosen or as their frame rates allow." in html
    )
    study["sessions"][0]["overrides"] = {"filter_motion": {"cutoff_hz": slow}}
    assert "; at" not in methods_text(study, {("hall", "smash"): slow})
    study["parameters"]["filter_motion"]["cutoff_hz"] = {"head": "residual", "arms": 10}
    study["sessions"][0]["overrides"] = {}
    html = methods_text(study, {("hall", "smash"): {"head": 4.2, "arms": 10.0}})
    assert "a frequency by residual analysis (head), 10 Hz (arms)" in html
    assert "; at 4.2 Hz (head) in hall smash" in html


def test_only_the_methods_that_were_used_are_cited(study):
    html = methods_text(study)
    assert "Lowe" in html and "Bazarevsky" in html and "Homma" not in html
    study["sessions"][0] |= {"calibration": "file", "mapper": None}
    study["sessions"][0]["takes"][0]["files"] = {"checks": "x.csv"}
    html = methods_text(study)
    assert "made elsewhere" in html and "Homma" in html
    assert "Lowe" not in html and "Winter" not in html and "Bazarevsky" not in html


def test_no_clicks_are_told_where_none_were_used(study):
    study["sessions"].append({**study["sessions"][0], "name": "door"})
    html = re.sub(r"\s+", " ", methods_text(study))
    assert "The cameras of hall and door were calibrated" in html
    assert "(at a longer side of 3840 px), a tie point of 2.0 robust" in html
    study["sessions"][1]["clicked"] = False
    html = re.sub(r"\s+", " ", methods_text(study))
    assert "of a walk and of the clicked court points (<code>sfm-n40</code>)" in html
    assert "The cameras of door were calibrated by one bundle adjustment" in html
    assert "of a walk alone, without a court: scale and axes are arbitrary" in html
    del study["sessions"][0]
    html = re.sub(r"\s+", " ", methods_text(study))
    assert "click" not in html
    assert "In the adjustment, a tie point has a standard deviation of 2.0 robust" in html


def test_lines_and_calibrations_used_again_are_named_in_the_methods(study):
    study["sessions"].append({**study["sessions"][0], "name": "later", "calibration": "file"})
    study["sessions"][0]["calibration"] = "sfm-n40-lines"
    study["sessions"][1]["has_covariance"] = True
    html = re.sub(r"\s+", " ", methods_text(study))
    assert "of the clicked court points and of the court&#39;s painted lines (<code>" in html
    assert "of later were taken from an earlier calibration, with its covariance" in html
    assert "not in later" not in html
    study["sessions"][1]["has_covariance"] = False
    html = methods_text(study)
    assert "made elsewhere" in html and "not in later, where the error" in html


def test_features_are_not_said_to_be_at_most_so_many(study):
    """A point with several orientations is several features."""
    html = re.sub(r"\s+", " ", methods_text(study))
    assert "the largest until a picture has 4096 points, some in several orientations" in html


def test_joints_of_another_program_are_not_said_to_be_found_by_a_network(study):
    study["sessions"][0] |= {"model": "body25b", "imported": True}
    html = methods_text(study)
    assert (
        "pictures of hall were found by another program and imported (<code>body25b</code>)" in html
    )
    assert "Bazarevsky" not in html and "by the network" not in html
    study["sessions"].append({**study["sessions"][0], "name": "gym"})
    study["sessions"][0] |= {"model": "blazepose-full", "imported": False}
    html = methods_text(study)
    assert "by the network blazepose-full (Bazarevsky et al. 2020); a" in html
    assert "pictures of gym were found by another program" in html


def test_error_bars_are_not_said_to_include_an_error_of_cameras_that_is_not_known(study):
    assert "and the calibration's; not those" in re.sub(r"\s+", " ", methods_text(study))
    study["sessions"].append({**study["sessions"][0], "name": "gym", "calibration": "file"})
    html = re.sub(r"\s+", " ", methods_text(study))
    words = "and the calibration's (not in gym, where the error of the cameras is not known); not"
    assert words in html
    study["sessions"][1]["takes"] = []
    assert "not in gym" not in methods_text(study)


def test_settings_of_several_sessions_are_stated_once(study):
    other = {**study["sessions"][0], "name": "gym"}
    study["sessions"].append(other)
    assert methods_text(study).count("triangulate: {fade_px: 13}") == 1
    assert "in hall and gym" in methods_text(study)


def test_names_of_users_are_escaped(study):
    study["sessions"][0] |= {"name": report_made.ROGUE, "model": report_made.ROGUE}
    study["sessions"][0]["overrides"] = {report_made.ROGUE: {"x": report_made.ROGUE}}
    assert "<img" not in methods_text(study)


def test_only_calibrations_that_need_a_court_are_said_to_rest_on_court_points():
    """`known` is also the way of points with places of their own."""
    words = {
        name: methods.calibrated(Calibration.parse(name), clicked=False, has_covariance=True)
        for name in ("known", "known18", "known8-board", "dlt8")
    }
    assert words.pop("known") == "calibrated from clicked points at known places alone"
    assert all("clicked court points alone" in each for each in words.values())
