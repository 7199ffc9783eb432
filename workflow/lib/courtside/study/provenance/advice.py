"""The command that is advised for a file: by a configuration that knows the file's session."""

import shlex
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from courtside.study import paths
from courtside.study.configuration import yaml_files
from courtside.study.errors import InputError, StrPath
from courtside.study.execution import files
from courtside.study.provenance.run import in_folder

DEFAULT = "config/config.yaml"


def making(
    name: str,
    words: Sequence[str],
    run: Mapping[str, Any],
    sidecars: Iterable[Mapping[str, Any]],
    repository: StrPath,
) -> list[str]:
    """Return the words of the command that makes a file anew, but for its name.

    `words` are those of the last run, whose record is `run`. If its study does not have the file's
    session, another configuration is named: one by which files of the session were made, or else
    one in the folder config. Without any, the plain command.
    """
    session = Path(name).relative_to(paths.RESULTS).parts[0]
    of_run = run.get("config", {}).get("sessions")
    is_known = of_run is None or session in of_run
    if is_known or not (Path(repository) / "config/sessions" / f"{session}.yaml").is_file():
        return [*words, "--force"]
    plain = ["snakemake", *in_folder(repository)]
    every = (path.as_posix() for path in sorted(Path(repository).glob("config/*.yaml")))
    there = [files.seen_from(path, repository) for path in every]
    for path in [*_recorded(session, sidecars), DEFAULT, *there]:
        if session in _sessions(Path(repository) / path):
            return [*plain, *(() if path == DEFAULT else ("--configfile", path)), "--force"]
    return [*plain, "--force"]


def _recorded(session: str, sidecars: Iterable[Mapping[str, Any]]) -> list[str]:
    """Return the configuration files by which files of a session were made."""
    folder = f"{paths.RESULTS}/{session}/"
    commands = {str(s.get("command")) for s in sidecars if s["file"].startswith(folder)}
    found = [_configfile(text) for text in sorted(commands)]
    return [path for path in dict.fromkeys(found) if path is not None]


def _configfile(command: str) -> str | None:
    try:
        words = shlex.split(command)
    except ValueError:
        return None
    given = words[words.index("--configfile") + 1 :] if "--configfile" in words else []
    return given[0] if given else None


def _sessions(path: Path) -> list[str]:
    """Return the sessions that a configuration file names; none if it cannot be read."""
    try:
        content = yaml_files.read(path)
    except InputError:
        return []
    found = content.get("sessions")
    return [str(name) for name in found] if isinstance(found, list) else []
