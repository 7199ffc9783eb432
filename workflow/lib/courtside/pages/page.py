"""One self-contained HTML file: style, scripts, data and pictures inside; no request leaves it."""

import base64
import html
import json
import math
import re
from pathlib import Path

import numpy as np

from courtside.study.execution.files import atomic

ASSETS = Path(__file__).with_name("assets")
ALWAYS = "page"  # page.css and page.js are in every page
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]*")
PICTURE = re.compile(r'src="image:([^"]*)"')
PNG = "image/png"
# The browser itself refuses whatever is not inside the file.
POLICY = (
    "default-src 'none'; img-src data: blob:; media-src data: blob:; font-src data:; "
    "connect-src data: blob:; worker-src blob:; style-src 'unsafe-inline'; "
    "script-src 'unsafe-inline'{evaluation}; base-uri 'none'; form-action 'none'"
)
TEMPLATE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title}</title>
<link rel="icon" href="data:,">
{styles}
</head>
<body>
{body}
{stores}
{scripts}
</body>
</html>
"""


def build(title, body_html, *, css=(), js=(), data=None, images=None, evaluates=False):
    """Put a page together.

    Parameters
    ----------
    title : str
        Of the window; any text.
    body_html : str
        Trusted HTML: pass whatever comes from users through `text` first. A picture is shown by
        `<img src="image:NAME" alt="...">` with NAME of `images`.
    css, js : sequence of str or Path
        Names of files in `pages/assets`, or paths of other files (a plotting library). `page.css` and
        `page.js` come first of themselves. Scripts run after the body, in the given order.
    data : dict of str to object, optional
        What scripts get by `courtside.data(name)`: plain values, lists, dictionaries, numpy arrays; what is
        not finite becomes null.
    images : dict of str to bytes or (bytes, str), optional
        Picture and its MIME type, "image/png" where left out. Those that `body_html` shows are put there;
        scripts get the others by `courtside.image(name)`, as a data address.
    evaluates : bool
        Whether a script makes code from text, as some plotting libraries do.

    Returns
    -------
    page : str
        The file's content, to be written by `write`.

    Raises
    ------
    ValueError
        If a name is no plain word, or a picture shown is not given.
    """
    data, images = dict(data or {}), dict(images or {})
    for name in [*data, *images]:
        if not NAME.fullmatch(name):
            raise ValueError(f"expected a name of letters, digits, _ . and -, found {name!r}")
    addresses = {name: data_uri(*_with_type(picture)) for name, picture in images.items()}
    shown = set(PICTURE.findall(body_html))
    if shown - set(addresses):
        raise ValueError(f"pictures shown but not given: {', '.join(sorted(shown - set(images)))}")
    rest = {name: uri for name, uri in addresses.items() if name not in shown}
    stores = [_store(f"data-{name}", value) for name, value in data.items()]
    return TEMPLATE.format(
        policy=POLICY.format(evaluation=" 'unsafe-eval'" if evaluates else ""),
        title=text(title),
        styles="\n".join(_style(_read(item)) for item in [f"{ALWAYS}.css", *css]),
        body=PICTURE.sub(lambda match: f'src="{addresses[match.group(1)]}"', body_html),
        stores="\n".join([*stores, _store("images", rest)]),
        scripts="\n".join(_script(_read(item)) for item in [f"{ALWAYS}.js", *js]),
    )


def write(path, page):
    """Write a page as UTF-8, whole or not at all.

    Parameters
    ----------
    path : str or Path
    page : str
        As `build` returns it.
    """
    with atomic(path) as temporary:
        temporary.write_text(page, encoding="utf-8", newline="\n")


def text(value):
    """Return any value as text that is safe in HTML, between tags and within quoted attributes."""
    return html.escape(str(value), quote=True)


def data_uri(content, mime=PNG):
    """Return bytes as an address that holds them.

    Parameters
    ----------
    content : bytes
    mime : str
    """
    return f"data:{mime};base64,{base64.b64encode(content).decode('ascii')}"


def _with_type(picture):
    return (picture, PNG) if isinstance(picture, bytes) else picture


def _read(item):
    path = item if isinstance(item, Path) else ASSETS / item
    return path.read_text(encoding="utf-8")


def _style(css):
    safe = css.replace("</", "<\\/")
    return f"<style>\n{safe}\n</style>"


def _script(js):
    """Return a script element; inside strings and patterns the escapes mean the same."""
    safe = re.sub(r"<(/script|script|!--)", lambda m: "<\\" + m.group(1), js, flags=re.I)
    return f"<script>\n{safe}\n</script>"


def _store(identity, value):
    """Return an element that holds JSON and cannot end before its end."""
    held = json.dumps(_plain(value), allow_nan=False, ensure_ascii=False, separators=(",", ":"))
    for char in "<>&\u2028\u2029":
        held = held.replace(char, f"\\u{ord(char):04x}")
    return f'<script type="application/json" id="{identity}">{held}</script>'


def _plain(value):
    """Return a value as JSON has it: numpy unwrapped, what is not finite as None."""
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
