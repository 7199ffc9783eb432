"""Documents name only files that exist, their lines are short, the glossary leads to every term."""

import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
LONGEST = 100
LINK = re.compile(r"\]\(([^)#:]+)(?:#[^)]*)?\)")


def tracked(*patterns):
    done = subprocess.run(
        ["git", "ls-files", *patterns], cwd=ROOT, capture_output=True, text=True, check=True
    )
    return [ROOT / name for name in done.stdout.splitlines() if (ROOT / name).is_file()]


MARKDOWN = tracked("*.md")
GLOSSARY = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")


def name(path):
    return path.relative_to(ROOT).as_posix()


@pytest.mark.parametrize("path", MARKDOWN, ids=name)
def test_every_link_leads_to_a_file_or_folder(path):
    links = LINK.findall(path.read_text(encoding="utf-8"))
    assert [link for link in links if not (path.parent / link).exists()] == []


def anchors(path):
    """Return the anchors of a document's headings, as GitHub makes them."""
    headings = re.findall(r"^#+ (.*)$", path.read_text(encoding="utf-8"), flags=re.M)
    return {re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-") for text in headings}


@pytest.mark.parametrize("path", MARKDOWN, ids=name)
def test_every_anchor_is_a_heading(path):
    links = re.findall(r"\]\(([^)#:]*)#([^)]*)\)", path.read_text(encoding="utf-8"))
    wanted = [((path.parent / to if to else path), anchor) for to, anchor in links]
    assert [anchor for to, anchor in wanted if anchor not in anchors(to)] == []


def test_every_term_of_the_glossary_says_where_it_lives():
    entries = re.split(r"^- (?=\*\*)", GLOSSARY, flags=re.M)[1:]
    assert len(entries) > 50
    assert [entry.split("**")[1] for entry in entries if not LINK.search(entry)] == []


def test_terms_stand_once_and_in_alphabetical_order():
    parts = [re.findall(r"^- \*\*(.+?)\*\*", part, flags=re.M) for part in GLOSSARY.split("\n## ")]
    terms = [term for part in parts for term in part]
    assert len(terms) == len(set(terms))
    for part in parts:
        assert part == sorted(part, key=str.lower)


def test_the_readme_and_the_architecture_lead_to_the_glossary():
    for document in (ROOT / "README.md", ROOT / "docs" / "architecture.md"):
        assert "glossary.md" in document.read_text(encoding="utf-8")


def long_lines(path):
    """Return the lines above the limit; tables, pictures, code and links may be longer."""
    found, code = [], False
    for line in path.read_text(encoding="utf-8").splitlines():
        code ^= line.lstrip().startswith("```")
        exempt = code or line.lstrip().startswith(("|", "![")) or " " not in line.strip()
        exempt = exempt or re.fullmatch("`[^`]*`", line)
        if len(line) > LONGEST and not exempt:
            found.append(line)
    return found


@pytest.mark.parametrize("path", [*MARKDOWN, *tracked("workflow/report/*.rst")], ids=name)
def test_lines_are_short(path):
    assert long_lines(path) == []


def ended(monkeypatch, program, *words):
    """Return how a program ends when it is given these words."""
    monkeypatch.setattr(sys, "argv", [program, *words])
    with pytest.raises(SystemExit) as end:
        runpy.run_path(str(ROOT / program), run_name="__main__")
    return end.value.code


@pytest.mark.parametrize(
    ("program", "explained"),
    [
        ("docs/draw_result.py", ["results"]),
        ("docs/make_tables.py", ["results", "--documents"]),
        ("workflow/draft_session.py", ["folder", "--name NAME", "--court COURT", "--sessions"]),
    ],
)
def test_help_explains_every_argument(program, explained, monkeypatch, capsys):
    assert ended(monkeypatch, program, "--help") == 0
    said = capsys.readouterr().out
    lines = re.findall(r"^  (\S.*?)(?:  +|\n {10,})\S", said, flags=re.M)
    assert [word for word in explained if not any(one.startswith(word) for one in lines)] == []


def test_the_picture_of_the_readme_without_results_is_refused_in_one_line(monkeypatch, tmp_path):
    said = ended(monkeypatch, "docs/draw_result.py", str(tmp_path / "nothing"))
    assert said.startswith("Error: ") and len(said.splitlines()) == 1
