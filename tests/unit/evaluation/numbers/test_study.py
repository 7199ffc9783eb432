"""All numbers together: documents are written and checked against other results."""

import shutil
from pathlib import Path, PurePosixPath

import pytest

from courtside.evaluation.numbers import register, study
from courtside.study.errors import InputError
from courtside.study.targets import numbers as tables

ROOT = Path(__file__).parents[4]
MADE = tables.made(ROOT)
NET = "blazepose-heavy-flip"
TAKES, CLAPS = "players-b/evaluation/takes", "single-view/evaluation/takes/claps"


@pytest.fixture
def repository(tmp_path):
    """Return a repository with the tables by hand, and documents with one table each."""
    folder = tmp_path / "docs" / "numbers"
    folder.mkdir(parents=True)
    shutil.copytree(ROOT / "config", tmp_path / "config")
    for path in (ROOT / "docs" / "numbers").glob("*.csv"):
        (folder / path.name).write_text(path.read_text())
    (tmp_path / "docs" / "measured").mkdir()
    for name, table in (("README.md", "racket"), ("docs/measured/movement.md", "angles")):
        (tmp_path / name).write_text(f"# Title\n\n<!-- table: {table} -->\n<!-- end -->\n")
    return tmp_path


def test_documents_are_written_once_and_then_stay(source, repository):
    found = study.numbers(source.folder, repository, MADE)
    assert study.write(found, repository) == [study.REGISTER, *study.documents(repository)]
    assert "| 12.7; 11.9 |" in (repository / "README.md").read_text()
    assert study.write(found, repository) == []
    kept = {number.source for number in register.read(repository / study.REGISTER)}
    assert not [source for source in kept if source.startswith("docs/")]
    assert study.filled(study.kept(repository), repository) == {
        name: (repository / name).read_text() for name in study.documents(repository)
    }


def test_results_that_changed_make_numbers_stale(source, repository, tmp_path):
    study.write(study.numbers(source.folder, repository, MADE), repository)
    assert study.report(source.folder, repository, MADE) == []
    kept = (repository / study.REGISTER).read_text()
    assert ",4.2,4.2,mm," in kept
    (repository / study.REGISTER).write_text(kept.replace(",4.2,4.2,mm,", ",4.3,4.3,mm,"))
    (line,) = study.report(source.folder, repository, MADE)
    assert line.endswith("printed 4.3, would be 4.2") and line.startswith("racket/sfm18/`plain-a`")


def test_results_without_a_table_are_refused_by_its_name(repository, tmp_path):
    with pytest.raises(InputError, match="run snakemake"):
        study.numbers(tmp_path / "nowhere", repository, MADE)
    with pytest.raises(InputError, match=r"figures/calibration\.csv"):
        study.numbers(tmp_path, repository, MADE)


def test_the_summary_repeats_numbers_of_other_tables(source, repository):
    found = study.numbers(source.folder, repository, MADE)
    shown = {n.row: n for n in found if n.table == study.SUMMARY}
    assert list(shown) == list(study.SUMMED_UP)
    printed = {n.name: n.printed for n in found}
    knee = shown["knee flexion of the same virtual players: RMS error"]
    assert knee.printed == f"{printed['angles/corrected_rmse/knee flexion, `players-b`']} degrees"
    (joints,) = (n for row, n in shown.items() if row.startswith("joints of two virtual players"))
    assert joints.printed == "29 / 58 mm in the median take, 34 / 68 mm in the worst"
    ellipsoids = shown["the same joints in their stated 90 % ellipsoids"]
    assert ellipsoids.printed == "99.0 % (of errors above 100 mm: 49 %)"
    with pytest.raises(InputError, match=r"expected corrected_rmse in the row .*knee flexion"):
        study.summary([n for n in found if n.table != "angles"])


LEFTOVERS = (  # a table that the default configuration does not make, and one to copy it from
    ("plain-b/evaluation/global-n40-o2.csv", "plain-a/evaluation/global-n40-o0.csv"),
    (f"{TAKES}/footwork/errors/sfm-n40.{NET}.csv",) * 2,
    (f"{TAKES}/footwork/kinematics/sfm-n40/all-robust/{NET}.csv",) * 2,
    (f"{TAKES}/shot/round_trip/sfm-n40.{NET}.csv",) * 2,
    ("figures/capture_height.csv", "figures/capture_baseline.csv"),
    (f"{CLAPS}/sources/net.errors.csv", f"{CLAPS}/sources/{NET}.errors.csv"),
)


def test_leftover_tables_of_older_configurations_are_not_read(source, tmp_path):
    results = shutil.copytree(source.folder, tmp_path / "results")
    for old, whole in LEFTOVERS:
        assert not (results / old).exists(), old
        (results / old).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source.folder / whole.replace("sfm-n40", "sfm-n40-lines"), results / old)
    # As text: NaN is not itself. A number names its source.
    printed, found = (
        list(map(repr, study.numbers(folder, ROOT, MADE))) for folder in (source.folder, results)
    )
    assert [one for one in found if one not in set(printed)] == []
    assert found == printed


def test_every_source_of_the_register_is_made_by_the_default_configuration():
    made = [PurePosixPath("/", path) for path in MADE]  # matched from their start
    kept = {n.source for n in register.read(ROOT / study.REGISTER) if n.origin == register.STUDY}
    assert [one for one in kept if not any(path.match(f"/{one}") for path in made)] == []
    assert len(kept) > 50
