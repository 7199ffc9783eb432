"""The methods: what was configured is what is said, and what was not used is not."""

import copy

import pytest

from courtside.pages.report import methods
from fixtures.study import report_made


@pytest.fixture
def study(tmp_path):
    return copy.deepcopy(report_made.study(tmp_path))


def methods_text(study):
    return methods.paragraphs(study["parameters"], study["sessions"])


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
    ):
        assert words in html, words


def test_methods_follow_another_configuration(study):
    study["parameters"]["filter_motion"]["cutoff_hz"] = {"head": 3}
    study["parameters"]["triangulate"]["max_error_px"] = 9
    study["sessions"][0] |= {"mapper": "incremental", "n_images": 12}
    html = methods_text(study)
    assert "3 Hz (head)" in html and "within 9 px" in html and "from 12 pictures" in html
    assert "incremental, Schönberger" in html and "Global structure-from-motion" not in html


def test_only_the_methods_that_were_used_are_cited(study):
    html = methods_text(study)
    assert "Lowe" in html and "Bazarevsky" in html and "Homma" not in html
    study["sessions"][0] |= {"calibration": "file", "mapper": None}
    study["sessions"][0]["takes"][0]["files"] = {"checks": "x.csv"}
    html = methods_text(study)
    assert "made elsewhere" in html and "Homma" in html
    assert "Lowe" not in html and "Winter" not in html and "Bazarevsky" not in html


def test_settings_of_several_sessions_are_stated_once(study):
    other = {**study["sessions"][0], "name": "gym"}
    study["sessions"].append(other)
    assert methods_text(study).count("triangulate: {fade_px: 13}") == 1
    assert "in hall and gym" in methods_text(study)


def test_names_of_users_are_escaped(study):
    study["sessions"][0] |= {"name": report_made.ROGUE, "model": report_made.ROGUE}
    study["sessions"][0]["overrides"] = {report_made.ROGUE: {"x": report_made.ROGUE}}
    assert "<img" not in methods_text(study)
