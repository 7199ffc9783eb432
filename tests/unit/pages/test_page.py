"""Pages read by the standard library's parser: one file, nothing outside, text is escaped."""

import base64
import json
from html.parser import HTMLParser

import jinja2
import numpy as np
import pytest

from courtside.pages import page

ROGUE = '<b>"A & B"</b></script><script>alert(1)</script><!--'


class Elements(HTMLParser):
    """Collects (tag, attributes, text)."""

    def __init__(self, source):
        super().__init__()
        self.found = []
        self.feed(source)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.found.append([tag, dict(attrs), ""])

    def handle_data(self, data):
        if self.found:
            self.found[-1][2] += data

    def all(self, tag, **attributes):
        return [
            (has, text)
            for name, has, text in self.found
            if name == tag and attributes.items() <= has.items()
        ]


def test_a_title_is_text():
    read = Elements(page.build(ROGUE, "<p>here</p>"))
    assert read.all("title")[0][1].strip() == ROGUE
    assert len(read.all("script")) == 2  # the store of pictures and page.js
    assert read.all("html")[0][0] == {"lang": "en"}
    assert {"charset": "utf-8"} in [has for has, _ in read.all("meta")]


def test_data_is_json_that_cannot_end_early():
    numbers = np.array([[1.5, np.nan], [np.inf, -2]])
    given = {"rogue": ROGUE, "numbers": numbers, "one": np.int64(3), 4: ("\u2028", np.float32(0.5))}
    read = Elements(page.build("t", "", data={"all": given}))
    ((_, text),) = read.all("script", id="data-all")
    assert json.loads(text) == {
        "rogue": ROGUE,
        "numbers": [[1.5, None], [None, -2]],
        "one": 3,
        "4": ["\u2028", 0.5],
    }
    assert "<" not in text and "\u2028" not in text


def test_pictures_go_where_they_are_shown():
    body = '<img src="image:a" alt="x"><img src="image:a" alt="y">'
    made = page.build(
        "t", body, images={"a": (b"\x89PNG", page.PNG), "b.1": (b"\xff\xd8", "image/jpeg")}
    )
    read = Elements(made)
    for has, _ in read.all("img"):
        kind, _, content = has["src"].partition(";base64,")
        assert (kind, base64.b64decode(content)) == ("data:image/png", b"\x89PNG")
    ((_, held),) = read.all("script", id="images")
    held = json.loads(held)
    assert list(held) == ["b.1"]
    assert held["b.1"].startswith("data:image/jpeg;base64,")


def test_scripts_and_styles_stay_in_their_elements(tmp_path, monkeypatch):
    monkeypatch.setattr(page, "ASSETS", tmp_path)
    for name in ("page.js", "page.css"):
        (tmp_path / name).touch()
    script, style = tmp_path / "a.js", tmp_path / "a.css"
    script.write_text('const a = "</SCRIPT><script><!--";')
    style.write_text('p::after { content: "</style><b>"; }')
    read = Elements(page.build("t", "<i>end</i>", js=["a.js"], css=["a.css"]))
    assert len(read.all("script")) == 3
    assert read.all("b") == []
    assert [text.strip() for _, text in read.all("script")][-1].endswith('!--";')


def test_a_policy_forbids_all_addresses_outside():
    read = Elements(page.build("t", ""))
    (policy,) = [has["content"] for has, _ in read.all("meta") if "http-equiv" in has]
    rules = dict(rule.strip().split(" ", 1) for rule in policy.split(";"))
    assert rules["default-src"] == "'none'"
    assert not any(word in policy for word in ("http", "*", "'self'", "'unsafe-eval'"))


@pytest.mark.parametrize("parts", [{"data": {"a b": 1}}, {"images": {'"': (b"", page.PNG)}}])
def test_names_are_plain(parts):
    with pytest.raises(ValueError, match="expected a name of letters"):
        page.build("t", "", **parts)


def test_a_picture_that_is_not_given_is_named():
    with pytest.raises(ValueError, match="not given: missing"):
        page.build("t", '<img src="image:missing" alt="">')


def test_a_page_is_written_whole_as_utf_8(tmp_path):
    path = tmp_path / "new" / "page.html"
    page.write(path, page.build("Übung\u00b2", "<p>é</p>"))
    assert path.read_bytes().decode("utf-8") == page.build("Übung\u00b2", "<p>é</p>")
    assert [p.name for p in path.parent.iterdir()] == ["page.html"]


def test_templates_escape_text_between_tags_and_in_attributes():
    template = page.TEMPLATES.from_string('<p title="{{ text }}">{{ text }}</p>')
    read = Elements(template.render(text=ROGUE))
    ((has, text),) = read.all("p")
    assert has["title"] == text == ROGUE
    assert Elements(template.render(text=3)).all("p") == [({"title": "3"}, "3")]


def test_templates_refuse_values_that_are_not_given():
    with pytest.raises(jinja2.UndefinedError, match="'session' is undefined"):
        page.render("clicking.html")


@pytest.mark.parametrize("path", sorted(page.ASSETS.glob("*.html")), ids=lambda path: path.name)
def test_all_templates_compile(path):
    page.TEMPLATES.get_template(path.name)
