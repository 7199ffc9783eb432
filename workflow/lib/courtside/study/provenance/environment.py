"""What a study ran with: commit, lock, interpreter, packages."""

import platform
import subprocess
from importlib import metadata
from pathlib import Path
from typing import Any

from courtside.study.errors import StrPath
from courtside.study.execution import digest, files

GIT_SECONDS = 20  # ASSUME: enough for `git status` on a slow disk; a run does not wait longer


def found(repository: StrPath) -> dict[str, Any]:
    """Return the commit, lock, interpreter and packages with which a study would run now.

    commit (40 digits, None outside a Git checkout), dirty (True if a file differs from the commit
    or is new), lock_sha256, python, platform, packages (version of each package of the lock that
    is installed).
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


def commit(repository: StrPath) -> dict[str, Any]:
    """Return the commit of a checkout and whether it is dirty; both None without Git."""
    head = _git(repository, "rev-parse", "HEAD")
    changes = _git(repository, "status", "--porcelain") if head else None
    return {"commit": head, "dirty": None if changes is None else bool(changes)}


def packages(lock: StrPath) -> dict[str, str]:
    """Return {name: version} of installed packages that a lock names; of all without a lock."""
    lock = Path(lock)
    found = {digest.package_name(one.name): one.version for one in metadata.distributions()}
    named = digest.pins(lock.read_text(encoding="utf-8")) if lock.is_file() else found
    return {name: version for name, version in sorted(found.items()) if name in named}


def _git(repository: StrPath, *words: str) -> str | None:
    """Return the output of Git, None where it is not installed, too slow, or fails."""
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
