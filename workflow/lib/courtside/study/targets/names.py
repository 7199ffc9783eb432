"""Names of files that a user asks for and that no rule makes."""

import os
import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import Any

from courtside.study import paths
from courtside.study.configuration.configuration import RESERVED
from courtside.study.configuration.sessions import Study
from courtside.study.errors import InputError, nearest
from courtside.study.jobs.job import Job

MADE = "see docs/results.md"
OF_SESSION = re.compile(r"\{session\b[^{}]*\}")


def faults(
    wanted: Iterable[str], rules: Iterable[Any], study: Study, by_default: Iterable[str]
) -> list[str]:
    """Return a line for each target that is no file, and that none of Snakemake's `rules` makes.

    Nor does a rule make files of takes, cameras and devices that the session does not have.
    `by_default` are the files of the study that it makes without being asked.
    """
    named = {rule.name: rule for rule in rules}
    files = {name: [str(file) for file in rule.products()] for name, rule in named.items()}
    plain = [name for name, made in files.items() if not any("{" in file for file in made)]
    asked = {os.path.normpath(name).replace(os.sep, "/") for name in wanted if name not in named}
    made, lines = list(chain.from_iterable(files.values())), []
    for path in sorted(name for name in asked if not Path(name).exists()):
        makers = [rule for rule in named.values() if rule.is_producer(path)]
        misnamed = [_misnamed(study, rule.get_wildcards(path)) for rule in makers]
        if not makers:
            lines.append(fault(path, list(study.sessions), [*plain, *made, *by_default]))
        elif all(misnamed):
            lines += misnamed[0]
    return lines


def _misnamed(study: Study, wildcards: Mapping[str, str]) -> list[str]:
    """Return what is wrong with the take, the camera or the device of a file; [] of a right one."""
    job = Job(study, wildcards)
    if wildcards.get("session") not in study.sessions:
        return []
    try:
        for what in ("take", "device", "camera"):
            if what in wildcards:
                getattr(job, what)
    except InputError as error:
        return error.lines
    return []


def fault(target: str, sessions: Sequence[str], known: Iterable[str]) -> str:
    """Return why nothing makes a target: `sessions` have not its name, or what is known neither.

    `known` are names of rules, and of files that rules make; they may contain `{session}` or, as
    Snakemake writes it, `{session,one|other}`.
    """
    results, *folders = target.split("/")
    session, start = folders[0] if folders[1:] else "", ""
    if results == paths.RESULTS and session and session not in RESERVED:
        if session not in sessions:
            return (
                f"{target}: expected a session of the study, one of {', '.join(sessions)}, found "
                f"{session!r}; {nearest(session, sessions, 'name it in the configuration')}"
            )
        start = f"{results}/{session}/"
    filled = {OF_SESSION.sub(session, name) for name in known}
    likely = sorted(name for name in filled if name.startswith(start) and "{" not in name)
    advice = nearest(target, likely, MADE)
    return f"{target}: expected a rule or a file that one makes, found neither; {advice}"
