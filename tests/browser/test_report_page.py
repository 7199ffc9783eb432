"""The report in a browser: it asks for nothing, contents lead on, nothing overflows the window."""

import pytest

from browser.waiting import until
from courtside.pages import page as pages
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


def test_the_dark_page_is_dark(open_page, path):
    page = open_page(path, color_scheme="dark")
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(21, 24, 28)"
