"""Every page: no request leaves it, text cannot break out, and the checks themselves bite."""

import pytest

from browser.waiting import told
from courtside.pages import page as pages

pytestmark = pytest.mark.browser
PIXEL = bytes.fromhex(
    "89504e470d0a1a0a0000000d49484452000000010000000108060000001f15c4890000000d49444154789c6360"
    "f8cfc0f01f0005000101d2ab1a1c0000000049454e44ae426082"
)
ROGUE = '</script><script>document.title = "broken"</script><!-- <script>'


def built(tmp_path, body="<h1>A page</h1>", **parts):
    path = tmp_path / "page.html"
    pages.write(path, pages.build(ROGUE, body, **parts))
    return path


def test_data_and_pictures_come_out_as_they_went_in(open_page, tmp_path):
    body = '<img src="image:shown" alt="a pixel">'
    data = {"words": {"rogue": ROGUE, "list": [1, 2.5, float("nan"), "ü\u2028"]}}
    images = dict.fromkeys(("shown", "kept"), (PIXEL, "image/png"))
    page = open_page(built(tmp_path, body, data=data, images=images))
    assert page.title() == ROGUE
    found = page.evaluate("courtside.data('words')")
    assert found == {"rogue": ROGUE, "list": [1, 2.5, None, "ü\u2028"]}
    assert page.evaluate("document.querySelector('img').naturalWidth") == 1
    assert page.evaluate("courtside.image('kept')") == page.get_attribute("img", "src")


def test_a_script_that_speaks_of_scripts_is_whole(open_page, tmp_path):
    script = tmp_path / "speaks.js"
    script.write_text(f"window.message = {ROGUE!r};")
    assert open_page(built(tmp_path, js=[script])).evaluate("window.message") == ROGUE


@pytest.mark.parametrize(
    "script",
    [
        "fetch('https://example.invalid/x').catch(() => 0)",
        "document.body.append(Object.assign(new Image(), {src: 'http://example.invalid/x.png'}))",
    ],
)
def test_the_browser_refuses_what_is_outside(open_page, tmp_path, script):
    page = open_page(built(tmp_path))
    page.evaluate(f"void {script}")
    told(page, lambda: any("Content Security Policy" in fault for fault in page.faults))
    page.wait_for_timeout(200)  # whatever else the browser says of it
    page.faults.clear()


def test_a_console_error_is_seen(open_page, tmp_path):
    page = open_page(built(tmp_path))
    page.evaluate("console.error('oops'); setTimeout(() => { throw new Error('late'); })")
    told(page, lambda: len(page.faults) == 2)
    page.faults.clear()


@pytest.mark.parametrize("width", [400, 1280])
def test_nothing_is_wider_than_the_window(open_page, tmp_path, width):
    page = open_page(built(tmp_path), width=width)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
