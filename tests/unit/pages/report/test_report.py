"""The whole report, read by a parser: nothing outside, links have targets, text is escaped."""

import json
from html.parser import HTMLParser

import pytest

from courtside.pages.report import report
from fixtures.study import report_made


class Read(HTMLParser):
    """Collects places, links, pictures and headings."""

    def __init__(self, page):
        super().__init__()
        self.places, self.links, self.pictures, self.tags = [], [], [], []
        self.feed(page)

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.tags.append(tag)
        self.places += [attrs["id"]] if "id" in attrs else []
        self.links += [attrs["href"]] if tag == "a" else []
        self.pictures += [attrs] if tag == "img" else []


@pytest.fixture
def study(tmp_path):
    return report_made.study(tmp_path)


def test_every_link_within_leads_somewhere(study):
    read = Read(report.build(study))
    inside = [link[1:] for link in read.links if link.startswith("#")]
    assert len(inside) >= 9
    assert [link for link in inside if link not in read.places] == []
    assert len(set(read.places)) == len(read.places)


def test_the_page_requests_nothing_from_outside(study):
    page = report.build(study)
    read = Read(page)
    outside = [link for link in read.links if not link.startswith("#")]
    assert sorted(set(outside)) == [
        "calibration.csv",
        "hall/figures/overlay.csv",
        "hall/pages/quality.html",
        "hall/takes/smash/viewer.html",
    ]
    assert [one["src"][:22] for one in read.pictures] == ["data:image/png;base64,"] * 2
    assert "http://" not in page and "https://" not in page
    assert all(one["alt"] for one in read.pictures)


def test_the_page_opens_with_what_was_measured(study):
    page = report.build(study)
    parts = [
        "What was measured",
        "29.33 &plusmn; 0.34 m",
        "Take smash:",
        "How far to trust it",
        "Methods",
    ]
    places = [page.index(part, page.index("<main>")) for part in parts]
    assert places == sorted(places)
    assert Read(page).tags.count("h1") == Read(page).tags.count("nav") == 1


def test_a_take_and_the_cameras_of_its_session_have_marks_of_their_own(study, tmp_path):
    def marks():
        page = report.build(study)
        row = page[page.index("<tbody>", page.index("class='glance'")) :].partition("</tr>")[0]
        return [cell.partition("</span> ")[2].partition("<")[0] for cell in row.split("<td>")[1:3]]

    take, cameras = marks()
    assert cameras == "good"
    bad = report_made.QUALITY | {"expected_volume_rms_cm": 6.0}
    (tmp_path / "quality.json").write_text(json.dumps(bad))
    assert marks() == [take, "failed"] and take != "failed"


def test_text_of_users_is_escaped(tmp_path):
    made = report_made.study(tmp_path, name=report_made.ROGUE, description=report_made.ROGUE)
    page = report.build(made | {"title": report_made.ROGUE})
    assert "https://example.invalid" in page  # as text
    assert all(one["src"].startswith("data:") for one in Read(page).pictures)
    assert Read(page).tags.count("img") == 2


def test_a_session_of_devices_says_nothing_of_cameras(study):
    assert report.build(study).count("Cameras</span>") == 2
    study["sessions"][0] |= {"files": {}, "calibration": None, "mapper": None}
    page = report.build(study)
    assert "Cameras</span>" not in page
    assert '<span class="light' not in page[page.index('id="quality"') :].partition("<details")[0]


def test_what_is_for_information_only_has_no_mark(study, tmp_path):
    content = report_made.QUALITY | {"remarks": ["cam03: not judged"], "warnings": ["cam01 moved"]}
    (tmp_path / "quality.json").write_text(json.dumps(content))
    page = report.build(study)
    assert "<li>Calibration: cam03: not judged.</li>" in page
    assert "doubtful</span> Calibration: cam01 moved.</li>" in page


def test_a_study_without_takes_has_a_report(study):
    study["sessions"][0]["takes"] = []
    study["figures"], study["tables"] = [], []
    page = report.build(study)
    assert "How far to trust it" in page and "What was measured" not in page


def test_the_report_states_what_lacks_consent(study):
    session = study["sessions"][0]
    assert "Left out" not in report.build(study)
    session["withheld"] = ["nothing is made of take rally: p2 has not agreed to analysis"]
    session["takes"] = []
    page = report.build({**study, "figures": []})
    assert "Left out: nothing is made of take rally: p2 has not agreed to analysis." in page
    assert 'href="#session.hall"' in page


def test_methods_tell_of_clicks_as_the_quality_of_the_cameras_does(study, tmp_path):
    assert "the clicked court points" in report.build(study)
    free = {key: value for key, value in report_made.QUALITY.items() if key != "left_out"}
    (tmp_path / "free.json").write_text(json.dumps(free))
    study["sessions"][0]["files"]["quality"] = {"sfm-n40": str(tmp_path / "free.json")}
    assert "clicked court points" not in report.build(study)


def test_a_report_without_takes_promises_no_error_bars(study):
    assert "Numbers have 90 % error bars" in report.build(study)
    study["sessions"][0]["takes"] = []
    assert "error bar" not in report.build(study).partition("<main>")[0]
