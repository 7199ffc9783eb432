"""A command that is advised for a file knows the session of the file."""

from pathlib import Path

import pytest

from courtside.study.provenance import advice

SPRING = "results/spring/figures/f.png"
WORDS = ["snakemake", "--configfile", "config/autumn.yaml"]
RUN = {"config": {"sessions": ["autumn"]}}


@pytest.fixture
def repository(tmp_path, monkeypatch):
    """Go to a repository with the sessions spring and autumn."""
    monkeypatch.chdir(tmp_path)
    Path("config/sessions").mkdir(parents=True)
    for name in ("spring", "autumn"):
        Path(f"config/sessions/{name}.yaml").touch()
    write("config", "walk")
    write("autumn", "autumn")
    return tmp_path


def write(name, *sessions):
    Path(f"config/{name}.yaml").write_text(f"sessions: [{', '.join(sessions)}]\n")


def advised(name=SPRING, run=RUN, sidecars=(), repository="."):
    return " ".join(advice.making(name, WORDS, run, sidecars, repository))


def test_the_configuration_of_the_last_run_is_advised_if_it_knows_the_session(repository):
    last = "snakemake --configfile config/autumn.yaml --force"
    assert advised("results/autumn/figures/f.png") == last
    assert advised("results/figures/f.png") == last  # of the study
    assert advised("results/capture-1/figures/f.png") == last  # varied from a session
    assert advised(run={}) == last


def test_another_configuration_is_advised_if_it_does_not(repository):
    assert advised() == "snakemake --force"
    Path("config/broken.yaml").write_text("sessions: [")
    Path("config/none.yaml").write_text("models: [net]\n")
    write("season", "spring", "autumn")
    assert advised() == "snakemake --configfile config/season.yaml --force"
    write("year", "spring", "autumn")
    words = {"unclosed": "'", "none": "snakemake", "bare": "snakemake --configfile"}
    commands = [*words.values(), "snakemake --configfile config/year.yaml -- x"]
    sidecars = [{"file": "results/spring/a.csv", "command": each} for each in commands]
    assert advised(sidecars=sidecars) == "snakemake --configfile config/year.yaml --force"
    Path("config/year.yaml").unlink()
    assert advised(sidecars=sidecars) == "snakemake --configfile config/season.yaml --force"
    write("config", "spring")
    assert advised() == "snakemake --force"
    plain = f"snakemake --directory {repository.name} --force"
    (repository.parent / "config" / "sessions").mkdir(parents=True, exist_ok=True)
    (repository.parent / "config" / "sessions" / "spring.yaml").touch()
    assert advised(repository=repository.parent) == plain
