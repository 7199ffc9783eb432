"""Figures and tables of the report: headings, captions, ids, complete tables."""

import re

import pytest

from courtside.pages.report import figures as report_figures
from courtside.study.errors import InputError
from fixtures.study import report_made


@pytest.mark.parametrize(
    ("stem", "heading", "way"),
    [
        ("overlay.sfm-n40.all-robust.blazepose-full", "What the network saw", "sfm-n40.all-robust"),
        ("badminton_fig05", "Shishido & Kitahara 2020, figure 5", ""),
        ("badminton_tab01.file.blazepose-full", "Shishido & Kitahara 2020, table 1", "file."),
        ("thesis_fig3_1", "Homma 2023, figure 3.1", ""),
        ("capture_speed", "Capture speed", ""),
    ],
)
def test_headings_are_words(stem, heading, way):
    found = report_figures.title(stem)
    assert found[0].startswith(heading)
    assert found[1].startswith(way) and bool(found[1]) == bool(way)


def test_plans_have_headings_of_their_own():
    assert report_figures.title("growth") != report_figures.title("growth", planned=True)


def test_a_figure_has_its_caption_and_its_numbers(tmp_path):
    figure = report_made.study(tmp_path)["figures"][0]
    html, png = report_figures.figure(figure, "figure-3")
    assert 'src="image:figure-3"' in html and 'width="1200" height="400"' in html
    assert "Take smash: <em>n</em> is 17." in html
    assert 'href="hall/figures/overlay.csv"' in html
    assert png.startswith(b"\x89PNG")


def test_a_picture_that_is_missing_is_named(tmp_path):
    figure = report_made.study(tmp_path)["figures"][0] | {"png": str(tmp_path / "none.png")}
    with pytest.raises(InputError, match=r"none\.png: expected a PNG"):
        report_figures.figure(figure, "f")


def test_figures_stand_by_session_and_take():
    places = [("", ""), ("b", "shot"), ("a", "shot"), ("b", ""), ("planned", "")]
    figures = [{"session": session, "take": take} for session, take in places]
    found = list(report_figures.groups(figures, ["b", "a"]))
    assert found == [("b", ""), ("b", "shot"), ("a", "shot"), ("", ""), ("planned", "")]


def test_numbers_of_a_table_have_one_style(tmp_path):
    given = ["15731.0000", "10100.4", "100.0000", "98.6123", "-0.0", "0.00012345", "n/a", "nan"]
    (tmp_path / "t.csv").write_text("a,b\n" + "".join(f"x,{value}\n" for value in given))
    entry = {"file": str(tmp_path / "t.csv"), "title": "T", "words": "W.", "link": "t.csv"}
    shown = re.findall(r"<td[^>]*>([^<x]*)</td>", report_figures.table(entry))
    assert shown == ["15731", "10100", "100", "98.61", "0", "0.0001234", "n/a", "nan"]


def test_a_table_leaves_out_what_is_empty_and_escapes_the_rest(tmp_path):
    html = report_figures.table(report_made.study(tmp_path)["tables"][0])
    assert "<th scope='col'>error cm</th>" in html and ">empty<" not in html
    assert "0.1235" in html and ">99<" in html and "a &lt; b" in html
    assert "31 rows, 3 columns" in html
    assert html.count("<tr>") == 32


def test_ids_hold_only_characters_of_addresses():
    assert report_figures.identity("figures", "players-b", "shot") == "figures.players-b.shot"
    assert report_figures.identity("x", 'a"b c') == "x.a-b-c"


def test_whole_numbers_of_a_table_keep_all_their_digits(tmp_path):
    (tmp_path / "t.csv").write_text("n,person\n12345.0,01\n123456,02\n")
    entry = {"file": tmp_path / "t.csv", "title": "t", "words": "", "link": "t.csv"}
    found = re.findall(r"<td[^>]*>(.*?)</td>", report_figures.table(entry))
    assert found == ["12345", "01", "123456", "02"]


def test_names_of_a_table_stay_as_they_are(tmp_path):
    names = ["2026_03_14", "1e3", "12_1", "007", "infinity"]
    rows = "".join(f"{name},{name},2.50000,x_{name}\n" for name in names)
    (tmp_path / "t.csv").write_text(f"session,calibration,error_cm,group\n{rows}1,1,1e3,1_2\n")
    entry = {"file": tmp_path / "t.csv", "title": "t", "words": "", "link": "t.csv"}
    found = re.findall(r"<td[^>]*>(.*?)</td>", report_figures.table(entry))
    assert found[0:20:4] == found[1:20:4] == names
    assert found[2:20:4] == ["2.5"] * 5
    assert found[20:] == ["1", "1", "1000", "1_2"]


def test_text_of_a_table_stays_as_it_is(tmp_path):
    (tmp_path / "t.csv").write_text('a,b\n"x, y",\n1.50,NA\n')
    entry = {"file": tmp_path / "t.csv", "title": "t", "words": "", "link": "t.csv"}
    html = report_figures.table(entry)
    assert "<td>x, y</td>" in html and "<td>NA</td>" in html
