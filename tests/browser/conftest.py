"""Opens pages in headless Chromium; a console error or a request off the page fails the test."""

import shutil
from pathlib import Path

import pytest

from browser.waiting import ready

INSIDE = ("file:", "data:", "blob:", "about:")
NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")


@pytest.fixture(scope="session")
def browser():
    api = pytest.importorskip("playwright.sync_api", reason="needs `pip install playwright`")
    found = next(filter(None, map(shutil.which, NAMES)), None)
    if not found:
        pytest.skip(f"needs one of {', '.join(NAMES)} on the PATH")
    with api.sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=found, args=["--no-sandbox"])
        yield chromium
        chromium.close()


@pytest.fixture
def open_page(browser):
    """Return `open(path, width=1280, height=900, **context)`: a playwright page of a file.

    Faults are collected until the test ends; `page.faults` holds them so far.
    """
    contexts, faults = [], []

    def request(wanted):
        if not wanted.url.startswith(INSIDE):
            faults.append(f"request to {wanted.url[:200]}")

    def note_error(message):
        if message.type == "error":
            faults.append(f"console: {message.text}")

    def opened(path, width=1280, height=900, **options):
        viewport = {"width": width, "height": height}
        context = browser.new_context(viewport=viewport, accept_downloads=True, **options)
        contexts.append(context)
        page = context.new_page()
        page.set_default_timeout(15_000)
        page.faults = faults
        page.on("console", note_error)
        page.on("pageerror", lambda error: faults.append(f"error: {error}"))
        page.on("request", request)
        page.goto(Path(path).resolve().as_uri())
        return ready(page)

    yield opened
    for context in contexts:
        context.close()
    assert faults == []
