"""Waiting for what a page does."""

EVERY_MS, TRIES = 100, 150
READY = "!document.body.hasAttribute('aria-busy')"
KEPT = """new Promise(done => {
    let opening;
    try { opening = indexedDB.open('courtside', 1); } catch { done(); return; }
    opening.onsuccess = () => {
        const asked = opening.result.transaction('work').objectStore('work').count();
        asked.onsuccess = () => done(opening.result.close());
    };
})"""  # changes that a page makes come before what is asked after them
FORBIDDEN = (
    "Object.defineProperty(window, 'indexedDB', { get() { throw new Error('forbidden'); } })"
)


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


def ready(page):
    """Wait until a page has found what the browser keeps of it."""
    until(page, READY)
    return page


def second_tab(context, address):
    """Open a page in another tab."""
    page = context.new_page()
    page.goto(address)
    return ready(page)


def reload(page):
    """Load a page again when the browser has kept what the page has changed."""
    page.evaluate(KEPT)
    page.reload()
    ready(page)
