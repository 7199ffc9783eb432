"""Running Snakemake as its user does, and reading what it says."""

import os
import re
import shutil
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

from smoke import forks

ROOT = Path(__file__).parents[2]
FOLDER = Path("tests") / "smoke"
TINY = Path("config") / "tiny.yaml"
TIMEOUT_S = 3600
MADE_BY = ("Snakefile", "workflow", "config", "profiles", "environment.lock")
DIGESTS = Path(".snakemake") / "courtside" / "code.json"  # of code, by its content


def copy_repository(root, *further, copy_file=shutil.copy2):
    """Copy what a study is made by, and further files or folders of the repository, to a folder.

    Bytecode goes along: it is valid where files keep their dates, and saves compiling the library.
    So do digests of code, which save parsing it.
    """
    left_out = shutil.ignore_patterns("*.pyc.*", "locks")  # half-written bytecode
    for name in (*MADE_BY, *map(str, further)):
        source, target = ROOT / name, root / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, target, ignore=left_out, copy_function=copy_file)
        else:
            copy_file(source, target)
    copy_digests(root / FOLDER)


def copy_digests(folder):
    """Copy the digests of code that the tiny study keeps, if any, to the folder of another run."""
    (folder / DIGESTS).parent.mkdir(parents=True, exist_ok=True)
    if (ROOT / FOLDER / DIGESTS).is_file():
        shutil.copy2(ROOT / FOLDER / DIGESTS, folder / DIGESTS)


def snakemake(*words, root, anew=False):
    """Run Snakemake in a folder; return the finished process with its whole output.

    `anew` imports all that Snakemake needs, as its user does.
    """
    words = ("snakemake", *map(str, words))
    if forks.POSSIBLE and not anew:
        return forks.run(*words, cwd=root, timeout_s=TIMEOUT_S)
    settings = {"capture_output": True, "text": True, "check": False, "timeout": TIMEOUT_S}
    return subprocess.run([sys.executable, "-m", *words], cwd=root, **settings)


def run(*options, root=ROOT, check=True, **settings):
    """Run the tiny study of a repository; return the finished process with its whole output."""
    words = ("--directory", FOLDER, "--configfile", TINY, *options)
    done = snakemake(*words, root=root, **settings)
    if check and done.returncode:
        raise AssertionError(done.stdout + done.stderr)
    return done


def planned(*options, root=ROOT, **settings):
    """Return the number of jobs of each rule that Snakemake would run now."""
    done = run("-n", "--quiet", "rules", *options, root=root, **settings)
    table = re.search(r"Job stats:\njob +count\n[- ]+\n(.*?)\n\n", done.stdout + done.stderr, re.S)
    if table is None:
        assert "Nothing to be done" in done.stdout + done.stderr
        return {}
    rows = dict(line.split() for line in table.group(1).splitlines())
    return {rule: int(count) for rule, count in rows.items() if rule not in ("all", "total")}


@contextmanager
def changed(path, content=None):
    """Give a file another content, or only another date, for a while."""
    state, before = path.stat(), None if content is None else path.read_bytes()
    _give(path, content)
    try:
        yield
    finally:
        _give(path, before)
        os.utime(path, ns=(state.st_atime_ns, state.st_mtime_ns))


def _give(path, content):
    """Give a file a content, or without one the present date."""
    if content is None:
        os.utime(path)
    else:
        path.write_bytes(content)


@contextmanager
def edited(path, old, new):
    """Replace the one place of a text file that says `old`, for a while."""
    text = path.read_text()
    assert text.count(old) == 1, f"{path}: {old}"
    with changed(path, text.replace(old, new).encode()):
        yield
