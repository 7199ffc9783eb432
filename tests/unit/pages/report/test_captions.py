"""Captions: what a rule says of a figure comes out as text, and nothing else gets through."""

from pathlib import Path

import pytest

from courtside.pages.report import captions

CAPTIONS = sorted((Path(__file__).parents[4] / "workflow" / "report").glob("draw_*.rst"))


def test_wildcards_and_parameters_are_put_in():
    source = (
        "Take {{ snakemake.wildcards.take }}, {{ snakemake.params.step.n_frames }} frames, ``x_m``."
    )
    html = captions.render(source, {"take": "smash1"}, {"step": {"n_frames": 17}})
    assert html.startswith("<p>Take smash1, 17 frames, ")
    assert "x_m" in html and "``" not in html


def test_text_that_depends_on_a_parameter_is_left_out_without_it():
    source = "A.{% if snakemake.params.blur_faces %} Faces are hidden.{% endif %}"
    assert "Faces" in captions.render(source, {}, {"blur_faces": True})
    assert "Faces" not in captions.render(source, {}, {"blur_faces": False})


def test_paragraphs_stay_apart():
    assert captions.render("One.\n\nTwo.").count("<p>") == 2


def test_html_in_a_caption_is_escaped():
    html = captions.render("a < b & <script>alert(1)</script>")
    assert "<script" not in html
    assert "a &lt; b &amp; &lt;script&gt;" in html


@pytest.mark.parametrize(
    "source",
    [".. raw:: html\n\n   <script>alert(1)</script>\n", ".. include:: /etc/hostname\n"],
)
def test_captions_include_no_raw_html_and_no_files(source):
    hostname = Path("/etc/hostname")
    html = captions.render(source)
    assert "<script" not in html
    if hostname.is_file() and hostname.read_text().strip():
        assert hostname.read_text().strip() not in html


@pytest.mark.parametrize(
    "source", ["{{ snakemake.params.step.n }}", "{{ snakemake.wildcards.take }}", "{% if"]
)
def test_an_unknown_value_in_a_caption_is_an_error(source):
    with pytest.raises(ValueError, match="caption: "):
        captions.render(source)


@pytest.mark.parametrize("path", CAPTIONS, ids=lambda path: path.stem)
def test_every_caption_of_the_study_is_text(path):
    wildcards = dict.fromkeys(("session", "take", "model", "calibration", "plan", "mapper"), "word")
    step = {"n_frames": 17, "n_instants": 3, "limit_torso": 0.1}
    params = {"networks": ["one", "two"], "source": "mocopi", "blur_faces": True, "step": step}
    html = captions.render(path.read_text(), wildcards, params)
    assert html.count("<p>") >= 1
    assert "problematic" not in html and "system-message" not in html and "{{" not in html
    assert "mailto:" not in html
