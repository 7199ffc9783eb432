"""Waiting for what a page does."""

EVERY_MS, TRIES = 100, 150
OPENING_MS = 500  # Chromium tells a page nothing of what is written in the moment in which it opens


def until(page, expression, arg=None):
    """Wait until an expression, or a function of `arg`, is true in a page.

    Not `wait_for_function`: when it asks a second time, the pages' own policy refuses it.
    """
    for _ in range(TRIES):
        if page.evaluate(expression, arg):
            return
        page.wait_for_timeout(EVERY_MS)
    raise AssertionError(f"not true after {TRIES * EVERY_MS / 1000:g} s: {expression}")


def second_tab(context, address):
    """Open a page in another tab, and wait until it hears of what others write into the storage."""
    context.pages[0].wait_for_timeout(OPENING_MS)
    page = context.new_page()
    page.goto(address)
    page.wait_for_timeout(OPENING_MS)
    return page


def reload(page):
    """Load a page again, with all that it has written into the storage."""
    page.wait_for_timeout(OPENING_MS)
    page.reload()
