"""Waiting for what a page does."""

EVERY_MS, TRIES = 100, 150
OPENING_MS = 500  # Chromium tells a page nothing of what is written in the moment in which it opens
RELOADS = 20
STORED = "() => { try { return JSON.stringify(localStorage); } catch { return null; } }"


def until(page, expression, arg=None):
    """Wait until an expression, or a function of `arg`, is true in a page.

    Not `wait_for_function`: when it asks a second time, the pages' own policy refuses it.
    """
    told(page, lambda: page.evaluate(expression, arg), expression)


def told(page, is_true, words="what a page should tell"):
    """Wait until a function is true; meanwhile messages of the page arrive."""
    for _ in range(TRIES):
        if is_true():
            return
        page.wait_for_timeout(EVERY_MS)
    raise AssertionError(f"not true after {TRIES * EVERY_MS / 1000:g} s: {words}")


def next_frames(page):
    """Wait until a page is drawn with all that it was told: it draws in the next frame."""
    page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")


def second_tab(context, address):
    """Open a page in another tab, and wait until it hears of what others write into the storage."""
    first = context.pages[0]
    first.wait_for_timeout(OPENING_MS)
    page = context.new_page()
    page.goto(address)
    _load_until_stored(page, lambda: page.evaluate(STORED) == first.evaluate(STORED))
    page.wait_for_timeout(OPENING_MS)
    return page


def reload(page):
    """Load a page again, with all that it has written into the storage."""
    written = page.evaluate(STORED)
    page.wait_for_timeout(OPENING_MS)
    page.reload()
    _load_until_stored(page, lambda: page.evaluate(STORED) in (written, None))


def _load_until_stored(page, is_stored):
    """Load a page again until it finds what was written: Chromium stores it a moment later."""
    for _ in range(RELOADS):
        if is_stored():
            return
        page.wait_for_timeout(OPENING_MS)
        page.reload()
    raise AssertionError(f"the storage is not as it was written after {RELOADS} reloads")
