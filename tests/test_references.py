"""Every cited work is in docs/references.bib, and every work there is cited."""

import ast
import html
import re
import subprocess
import tokenize
import unicodedata
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
FAMILY = r"(?:(?:de|van|von) )?[A-ZÀ-Þ][a-zà-ÿ]+(?:[A-Z][a-zà-ÿ]+)?(?:-[A-ZÀ-Þ][a-zà-ÿ]+)*"
AUTHORS = rf"{FAMILY}(?:(?:, {FAMILY})* & {FAMILY}| et al\.)?"
YEAR = r"(?:18|19|20)\d\d"
AUTHOR_YEAR = re.compile(rf"(?<![\w-])({AUTHORS})(?:['’]s)?,? [(\[]?({YEAR}(?:, {YEAR})*)(?![\w-])")
KEY_IN_BRACKETS = re.compile(rf"\[([A-Za-z]+{YEAR})\b")
NOT_AUTHORS = {"In", "Since", "From", "Until", "Before", "After", "College"}
VENUES = {"journal", "booktitle", "publisher", "institution", "howpublished", "note"}
SUFFIXES = {".py", ".smk", ".rst", ".md", ".html", ".yaml", ".csv"}
CITING = ["workflow", "docs", "config", "benchmarks", "README.md", "CHANGELOG.md"]


def plain_name(name):
    """Return a family name in ASCII letters only: as it stands in keys."""
    letters = unicodedata.normalize("NFKD", name)
    return "".join(c for c in letters if c.isascii() and c.isalpha())


def read_bib(text):
    """Return {key: fields} of a bib file whose fields stand on one line each."""
    found = {}
    for key, body in re.findall(r"^@\w+\{(\w+),\n(.*?)^\}$", text, flags=re.M | re.S):
        assert key not in found, key
        found[key] = dict(re.findall(r"^  (\w+) = \{(.*)\},$", body, flags=re.M))
    return found


BIB_TEXT = (ROOT / "docs" / "references.bib").read_text(encoding="utf-8")
WORKS = read_bib(BIB_TEXT)


def families(work):
    return [author.split(",")[0] for author in work["author"].split(" and ")]


def comments(path):
    """Yield the comments of a Python file; those on lines that follow one another are one."""
    block, last = [], -1
    with tokenize.open(path) as file:
        for token in tokenize.generate_tokens(file.readline):
            if token.type == tokenize.COMMENT:
                if token.start[0] != last + 1:
                    yield " ".join(block)
                    block = []
                block.append(token.string.lstrip("# "))
                last = token.start[0]
    yield " ".join(block)


def strings(tree):
    """Yield the text of all strings; an f-string is one text, with {} for its values."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value
        elif isinstance(node, ast.JoinedStr):
            yield "".join(
                getattr(part, "value", "") if isinstance(part, ast.Constant) else "{}"
                for part in node.values
            )


def prose(path):
    """Yield the pieces of text of a file in which works are cited, white space made single."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        pieces = [*strings(ast.parse(text)), *comments(path)]
    else:
        pieces = re.sub(r"^ *#+ ", "", html.unescape(text), flags=re.M).split("\n\n")
    for piece in pieces:
        yield " ".join(piece.split())


def citations(text):
    """Return [(names, years)] of a text: `Wu et al. 2002, 2005` has two years."""
    found = []
    for names, years in AUTHOR_YEAR.findall(text):
        named = re.split(r", | & ", names.removesuffix(" et al."))
        if named[0] not in NOT_AUTHORS:
            found += [(named, year) for year in years.split(", ")]
    return found


def cited():
    """Return {(key, names as cited): a file that cites it} over the whole repository."""
    done = subprocess.run(
        ["git", "ls-files", *CITING], cwd=ROOT, capture_output=True, text=True, check=True
    )
    found = {}
    for name in done.stdout.splitlines():
        path = ROOT / name
        if path.suffix not in SUFFIXES or not path.is_file():
            continue
        for text in prose(path):
            for named, year in citations(text):
                found.setdefault((plain_name(named[0]) + year, tuple(named)), name)
            for key in KEY_IN_BRACKETS.findall(text):
                found.setdefault((key, ()), name)
    return found


@pytest.fixture(scope="module")
def all_cited():
    return cited()


def test_every_citation_resolves_to_an_entry(all_cited):
    unknown = {key: name for (key, _), name in all_cited.items() if key not in WORKS}
    assert unknown == {}


def test_the_names_of_a_citation_are_the_first_authors_of_the_work(all_cited):
    wrong = {
        (key, named): name
        for (key, named), name in all_cited.items()
        if key in WORKS and list(named) != families(WORKS[key])[: len(named)]
    }
    assert wrong == {}


def test_every_entry_is_cited(all_cited):
    assert sorted(set(WORKS) - {key for key, _ in all_cited}) == []


def test_entries_are_complete_sorted_and_keyed_by_first_author_and_year():
    assert len(WORKS) == BIB_TEXT.count("\n@") > 50
    assert list(WORKS) == sorted(WORKS, key=str.lower)
    for key, work in WORKS.items():
        assert key == plain_name(families(work)[0]) + work["year"]
        assert work["title"] and VENUES & set(work), key
        assert not work.get("doi", "").startswith("http"), key


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("as in Winter 2009, sec. 2.2", [(["Winter"], "2009")]),
        ("Hartley & Zisserman (2004)", [(["Hartley", "Zisserman"], "2004")]),
        (
            "Lindeman, Merenda & Gold 1980; Shapley 1953",
            [(["Lindeman", "Merenda", "Gold"], "1980"), (["Shapley"], "1953")],
        ),
        ("Wu et al. 2002, 2005", [(["Wu"], "2002"), (["Wu"], "2005")]),
        ("de Leva's (1996, table 4)", [(["de Leva"], "1996")]),
        ("[Pech-Pacheco et al. 2000]", [(["Pech-Pacheco"], "2000")]),
        ("CVPR 2016, in 1920 px, since 2020, 2020-05-01", []),
    ],
)
def test_citations_are_recognised(text, expected):
    assert citations(text) == expected
