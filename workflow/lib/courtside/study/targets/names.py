"""Names of files that a user asks for and that no rule makes."""

import re
from collections.abc import Iterable, Sequence

from courtside.study import paths
from courtside.study.configuration.configuration import RESERVED
from courtside.study.errors import nearest

MADE = "see config/README.md, Files that the study makes"
OF_SESSION = re.compile(r"\{session\b[^{}]*\}")


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
