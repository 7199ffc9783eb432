"""All numbers together: documents are written and checked against other results."""

from pathlib import Path

import pytest

from courtside.evaluation.numbers import register, study
from courtside.study.errors import InputError

ROOT = Path(__file__).parents[4]


@pytest.fixture
def repository(tmp_path):
    """Return a repository with the tables by hand, and documents with one table each."""
    folder = tmp_path / "docs" / "numbers"
    folder.mkdir(parents=True)
    (tmp_path / "config" / "published").mkdir(parents=True)
    theirs = Path("config/published/badminton_tab01.csv")
    (tmp_path / theirs).write_text((ROOT / theirs).read_text())
    for path in (ROOT / "docs" / "numbers").glob("*.csv"):
        (folder / path.name).write_text(path.read_text())
    for name, table in (("README.md", "racket"), ("docs/measured.md", "angles")):
        (tmp_path / name).write_text(f"# Title\n\n<!-- table: {table} -->\n<!-- end -->\n")
    return tmp_path


def test_documents_are_written_once_and_then_stay(source, repository):
    found = study.numbers(source.folder, repository)
    assert study.write(found, repository) == [study.REGISTER, *study.DOCUMENTS]
    assert "| 12.7; 11.9 |" in (repository / "README.md").read_text()
    assert study.write(found, repository) == []
    kept = {number.source for number in register.read(repository / study.REGISTER)}
    assert not [source for source in kept if source.startswith("docs/")]
    assert study.filled(study.kept(repository), repository) == {
        name: (repository / name).read_text() for name in study.DOCUMENTS
    }


def test_results_that_changed_make_numbers_stale(source, repository, tmp_path):
    study.write(study.numbers(source.folder, repository), repository)
    assert study.report(source.folder, repository) == []
    kept = (repository / study.REGISTER).read_text()
    assert ",4.2,4.2,mm," in kept
    (repository / study.REGISTER).write_text(kept.replace(",4.2,4.2,mm,", ",4.3,4.3,mm,"))
    (line,) = study.report(source.folder, repository)
    assert line.endswith("printed 4.3, would be 4.2") and line.startswith("racket/sfm18/`plain-a`")


def test_results_without_a_table_are_refused_by_its_name(repository, tmp_path):
    with pytest.raises(InputError, match="run snakemake"):
        study.numbers(tmp_path / "nowhere", repository)
    with pytest.raises(InputError, match=r"figures/calibration\.csv"):
        study.numbers(tmp_path, repository)
