"""The report in a browser: it asks for nothing, contents lead on, nothing overflows the window."""

import json

import cv2
import numpy as np
import pytest

from browser.waiting import until
from courtside.pages import page as pages
from courtside.pages import quality
from courtside.pages.report import report
from fixtures.study import report_made

pytestmark = pytest.mark.browser


@pytest.fixture
def path(tmp_path):
    folder = tmp_path / "made"
    folder.mkdir()
    pages.write(tmp_path / "report.html", report.build(report_made.study(folder)))
    return tmp_path / "report.html"


@pytest.mark.parametrize("width", [400, 1280])
def test_nothing_is_wider_than_the_window(open_page, path, width):
    page = open_page(path, width=width)
    page.evaluate("document.querySelectorAll('details').forEach((item) => { item.open = true; })")
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    wide = page.evaluate(
        "[...document.querySelectorAll('main *')].filter((one) => !one.closest('.scroll')"
        " && one.getBoundingClientRect().right > innerWidth + 1)"
        ".map((one) => one.outerHTML.slice(0, 80))"
    )
    assert wide == []


def test_wide_tables_scroll_by_keys(open_page, path):
    page = open_page(path, width=400)
    table = page.locator("section#quality .scroll").nth(1)
    assert table.evaluate("(one) => one.scrollWidth > one.clientWidth")
    table.focus()
    page.keyboard.press("ArrowRight")
    until(page, "(one) => one.scrollLeft > 0", arg=table.element_handle())


@pytest.mark.parametrize("width", [400, 1280])
def test_contents_lead_to_their_places(open_page, path, width):
    page = open_page(path, width=width)
    links = page.locator("nav a")
    assert links.count() >= 8
    for number in range(links.count()):
        link = links.nth(number)
        name = link.get_attribute("href")[1:]
        page.evaluate("scrollTo({top: 0, behavior: 'instant'})")
        link.click()
        until(
            page,
            "(id) => { const top = document.getElementById(id).getBoundingClientRect().top;"
            " return top > -5"
            " && (top < 60 || scrollY + innerHeight > document.body.scrollHeight - 5); }",
            arg=name,
        )


def test_a_picture_is_shown_with_its_caption(open_page, path):
    page = open_page(path)
    assert page.evaluate("document.querySelector('figure img').naturalWidth") == 1200
    assert "Take smash: n is 17." in page.inner_text("figure figcaption")


def test_angles_unfold(open_page, path):
    page = open_page(path)
    page.click("text=Joint angles")
    assert "89.7 ± 9.4°" in page.inner_text(".take details table")


def test_an_address_with_a_place_unfolds_it(open_page, path):
    page = open_page(path)
    page.evaluate(
        "document.querySelector('.take details table').id = 'angles'; location.hash = 'angles'"
    )
    until(page, "document.querySelector('.take details').open")


def test_on_paper_no_table_is_cut_off(open_page, path):
    page = open_page(path, width=700)  # A4 without its margins
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    page.emulate_media(media="print")
    hidden = page.evaluate(
        "[...document.querySelectorAll('.scroll')].filter((one) => {"
        " const boxes = [one, one.firstElementChild].map((item) => item.getBoundingClientRect());"
        " return boxes[1].height > boxes[0].height + 1 || boxes[1].right > innerWidth + 1; })"
        ".map((one) => one.ariaLabel)"
    )
    assert hidden == []
    assert page.locator(".scroll").count() > 5
    assert page.locator("table.dense tr").last.is_visible()


def test_on_paper_a_dark_page_is_light(open_page, path):
    page = open_page(path, color_scheme="dark")
    page.emulate_media(media="print")
    assert page.evaluate("getComputedStyle(document.body).color") == "rgb(28, 31, 35)"


def test_the_page_for_quality_unfolds_before_printing(open_page, tmp_path):
    files = report_made.study(tmp_path)["sessions"][0]["files"]
    content = {**report_made.QUALITY, "remarks": ["cam03: not judged"]}
    (tmp_path / "quality.json").write_text(json.dumps(content))
    limits = {"max_shift_px": 1.0, "max_zoom_percent": 0.2}
    cameras = {"calibration": "sfm-n40", "others": [], "files": files, "limits": limits}
    pages.write(tmp_path / "quality.html", quality.build("hall", [], cameras))
    page = open_page(tmp_path / "quality.html")
    assert not page.locator("text=cam03: not judged").is_visible()
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert page.locator("text=cam03: not judged").is_visible()


def test_pictures_of_the_page_for_quality_are_in_sight_in_a_narrow_window(open_page, tmp_path):
    picture = bytes(cv2.imencode(".jpg", np.zeros((160, 320, 3), np.uint8))[1])
    lines = [quality.Line("c1", "good", "It agrees with the other cameras.", ())]
    take = {"name": "smash", "lines": lines, "pictures": {"c1": picture}, "left_out": ""}
    pages.write(tmp_path / "quality.html", quality.build("hall", [take]))
    page = open_page(tmp_path / "quality.html", width=400)
    shown, reason = (
        page.locator("img").bounding_box(),
        page.locator("tbody td").nth(1).bounding_box(),
    )
    assert shown["x"] + shown["width"] <= 400
    assert shown["y"] >= reason["y"] + reason["height"]
    page.set_viewport_size({"width": 1280, "height": 900})
    shown, reason = (
        page.locator("img").bounding_box(),
        page.locator("tbody td").nth(1).bounding_box(),
    )
    assert shown["x"] >= reason["x"] + reason["width"]


def test_the_dark_page_is_dark(open_page, path):
    page = open_page(path, color_scheme="dark")
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(21, 24, 28)"
