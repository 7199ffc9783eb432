"""The commit is Git's, the versions are those that modules tell themselves."""

import hashlib
import platform
import subprocess

import numpy as np
import pytest
import scipy

from courtside.study.provenance import environment

LOCK = "numpy==1.0 \\\n    --hash=sha256:00\n# via numpy==9\nscipy[extra]==2.0 \\\nnot_here==3\n"


@pytest.fixture
def repository(tmp_path):
    (tmp_path / "environment.lock").write_text(LOCK)
    for words in (["init", "-q"], ["add", "."], ["commit", "-qm", "first"]):
        subprocess.run(["git", *author(), *words], cwd=tmp_path, check=True)
    return tmp_path


def author():
    return ["-c", "user.name=a", "-c", "user.email=a@b"]


def test_a_clean_checkout_has_a_commit_and_is_not_dirty(repository):
    head = subprocess.run(
        ["git", "rev-parse", "HEAD"], cwd=repository, capture_output=True, text=True, check=True
    )
    found = environment.found(repository)
    assert found["commit"] == head.stdout.strip()
    assert found["dirty"] is False
    assert found["lock_sha256"] == hashlib.sha256(LOCK.encode()).hexdigest()
    assert found["python"] == platform.python_version()
    assert found["packages"] == {"numpy": np.__version__, "scipy": scipy.__version__}


@pytest.mark.parametrize("name", ["environment.lock", "new.py"])
def test_a_changed_or_new_file_is_dirty(repository, name):
    (repository / name).write_text("x")
    assert environment.commit(repository)["dirty"] is True


def test_without_checkout_and_lock_all_packages_are_listed(tmp_path):
    found = environment.found(tmp_path)
    assert (found["commit"], found["dirty"], found["lock_sha256"]) == (None, None, None)
    assert found["packages"]["numpy"] == np.__version__


def test_without_git_there_is_no_commit(repository, monkeypatch):
    monkeypatch.setenv("PATH", "")
    assert environment.commit(repository) == {"commit": None, "dirty": None}
