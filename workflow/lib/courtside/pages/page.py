"""One self-contained HTML file: styles, scripts, data and pictures inside, nothing requested."""

import base64
import json
import math
import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

import jinja2
import numpy as np
from markupsafe import Markup

from courtside.study.errors import StrPath
from courtside.study.execution.files import atomic

ASSETS = Path(__file__).with_name("assets")
ALWAYS = "page"  # page.css and page.js are in every page
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]*")
PICTURE = re.compile(r'src="image:([^"]*)"')
PNG = "image/png"
TEMPLATES = jinja2.Environment(
    loader=jinja2.FileSystemLoader(ASSETS),
    autoescape=True,
    undefined=jinja2.StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)


def build(
    title: str,
    body_html: str,
    *,
    css: Iterable[str] = (),
    js: Iterable[str] = (),
    data: Mapping[str, object] | None = None,
    images: Mapping[str, tuple[bytes, str]] | None = None,
) -> str:
    """Return the content of a page, to be written by `write`.

    title : of the window; any text
    body_html : trusted HTML, as `render` returns it; `<img src="image:NAME" alt="...">` shows a
        picture of `images`
    css, js : names of files in `pages/assets`; `page.css` and `page.js` come first; scripts run
        after the body, in this order
    data : what scripts get by `courtside.data(name)`: plain values, lists, dictionaries, numpy
        arrays; numbers that are not finite become null
    images : picture and MIME type; scripts get pictures that `body_html` does not show by
        `courtside.image(name)`, as a data address

    `ValueError` if a name has characters other than letters, digits, _ . and -, or a picture is
    missing.
    """
    data, images = dict(data or {}), dict(images or {})
    for name in [*data, *images]:
        if not NAME.fullmatch(name):
            raise ValueError(f"expected a name of letters, digits, _ . and -, found {name!r}")
    addresses = {name: _data_uri(*picture) for name, picture in images.items()}
    shown = set(PICTURE.findall(body_html))
    if shown - set(addresses):
        raise ValueError(f"pictures shown but not given: {', '.join(sorted(shown - set(images)))}")
    rest = {name: uri for name, uri in addresses.items() if name not in shown}
    stores = {f"data-{name}": value for name, value in data.items()} | {"images": rest}
    html = render(
        "page.html",
        title=title,
        styles=[Markup(_read(item).replace("</", "<\\/")) for item in [f"{ALWAYS}.css", *css]],
        body=Markup(PICTURE.sub(lambda match: f'src="{addresses[match.group(1)]}"', body_html)),
        stores={name: _safe_json(value) for name, value in stores.items()},
        scripts=[_safe_js(_read(item)) for item in [f"{ALWAYS}.js", *js]],
    )
    return str(html)


def render(template: str, **values: object) -> Markup:
    """Return a template of `pages/assets` as HTML; values are escaped unless they are `Markup`."""
    return Markup(TEMPLATES.get_template(template).render(values))


def macro(template: str, name: str) -> Callable[..., Markup]:
    """Return a macro of a template of `pages/assets`; like `render`, it escapes its arguments."""
    return getattr(TEMPLATES.get_template(template).module, name)


def write(path: StrPath, page: str) -> None:
    """Write a page as UTF-8, whole or not at all."""
    with atomic(path) as temporary:
        temporary.write_text(page, encoding="utf-8", newline="\n")


def _data_uri(content: bytes, mime: str) -> str:
    """Return bytes as an address that holds them."""
    return f"data:{mime};base64,{base64.b64encode(content).decode('ascii')}"


def _read(name: str) -> str:
    return (ASSETS / name).read_text(encoding="utf-8")


def _safe_js(js: str) -> Markup:
    """Escape what would end a script element; inside strings and patterns it means the same."""
    return Markup(re.sub(r"<(/script|script|!--)", lambda m: "<\\" + m.group(1), js, flags=re.I))


def _safe_json(value: object) -> Markup:
    """Return JSON that cannot end the element that holds it."""
    held = json.dumps(_plain(value), allow_nan=False, ensure_ascii=False, separators=(",", ":"))
    for char in "<>&\u2028\u2029":
        held = held.replace(char, f"\\u{ord(char):04x}")
    return Markup(held)


def _plain(value: object) -> object:
    """Return a value as JSON has it: numpy unwrapped, numbers that are not finite as None."""
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
