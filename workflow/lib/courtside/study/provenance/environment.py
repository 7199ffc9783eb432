"""What a study ran with: commit, lock, interpreter, packages."""

import platform
import re
import subprocess
from importlib import metadata
from pathlib import Path

from courtside.study.execution import files

LOCKED = re.compile(r"^([A-Za-z0-9._-]+)(?:\[[^]]*\])?==", re.M)
GIT_SECONDS = 20


def found(repository):
    """Return what a study of a repository would run with now.

    Returns
    -------
    surroundings : dict
        commit (40 digits, None outside a Git checkout), dirty (True if a file differs from the commit or is
        new), lock_sha256, python, platform, packages (version of each package of the lock that is installed).
    """
    repository = Path(repository)
    lock = repository / "environment.lock"
    return {
        **commit(repository),
        "lock_sha256": files.sha256(lock) if lock.is_file() else None,
        "python": platform.python_version(),
        "platform": f"{platform.system()} {platform.machine()}",
        "packages": packages(lock),
    }


def commit(repository):
    """Return the commit of a checkout and whether it is dirty, both None where Git knows of none."""
    head = _git(repository, "rev-parse", "HEAD")
    changes = _git(repository, "status", "--porcelain") if head else None
    return {"commit": head, "dirty": None if changes is None else bool(changes)}


def packages(lock):
    """Return {name: version} of the installed packages that a lock names, or of all without a lock."""
    lock = Path(lock)
    text = lock.read_text(encoding="utf-8") if lock.is_file() else None
    wanted = None if text is None else {_plain(name) for name in LOCKED.findall(text)}
    installed = {_plain(entry.name): entry.version for entry in metadata.distributions()}
    return {
        name: version
        for name, version in sorted(installed.items())
        if wanted is None or name in wanted
    }


def _plain(name):
    return re.sub(r"[-_.]+", "-", name).lower()


def _git(repository, *words):
    """Return what Git says, None where it is not installed, not asked in time, or refuses."""
    try:
        done = subprocess.run(
            ["git", "--no-optional-locks", "-C", str(repository), *words],
            capture_output=True,
            text=True,
            check=False,
            timeout=GIT_SECONDS,
        )
    except (FileNotFoundError, subprocess.TimeoutExpired):
        return None
    return None if done.returncode else done.stdout.strip()
