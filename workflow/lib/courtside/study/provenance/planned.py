"""The jobs that a run would have now: told by the workflow, asked for by who verifies a study.

Snakemake's own list of what is out of date rests on its hidden records of settings and code
(`.snakemake/metadata`), which results that were moved without them do not have.
"""

import json
import os
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from courtside.study import paths
from courtside.study.configuration.sessions import Study
from courtside.study.errors import InputError, StrPath, few
from courtside.study.execution import files
from courtside.study.provenance import provenance, run
from courtside.study.targets import remains

ASKED = "COURTSIDE_PLAN"  # environment variable: the file that the workflow writes its jobs to
N_NAMED = 3  # rules in a line
Settings = dict[str, list]


@dataclass(frozen=True)
class Plan:
    """What a run would make, or why this is unknown."""

    settings: dict[str, Settings]  # of all steps before a file, by file, as in its sidecar
    pending: frozenset[str]  # files that Snakemake would make anew
    by_name: frozenset[str] = frozenset()  # files that are made when asked for only
    remains: frozenset[str] = frozenset()  # here or deleted; no longer asked for
    advice: tuple[str, ...] = ()  # on those that are here
    refused: str = ""


def tell(workflow: Any, study: Study) -> None:
    """Write what a workflow would make, and what is left of earlier ones, if a program asks."""
    path = os.environ.get(ASKED)
    if path and workflow.dag is not None:
        dag = workflow.dag
        jobs = [{**run.plain_job(job, dag, touched=False), "code": None} for job in dag.jobs]
        drawn = (path.as_posix() for path in Path(paths.RESULTS).glob("**/figures/*"))
        names = dict.fromkeys([*provenance.recorded(paths.RUN, paths.RESULTS), *drawn])
        content = {
            "jobs": [{**job, "params": provenance.plain(job["params"])} for job in jobs],
            "remains": remains.of_records(study, names),
            "advice": run.remaining(study),
        }
        Path(path).write_text(json.dumps(content), encoding="utf-8")


def ask(command: Sequence[str], repository: StrPath, targets: Sequence[str] = ()) -> Plan:
    """Return what a command of Snakemake would make now; `InputError` if it is refused.

    `command` are its words, to be given in the folder `repository`, `targets` what is asked for.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "jobs.json"
        words = [
            sys.executable,
            "-m",
            *command,
            "--summary",
            *(["--", *targets] if targets else ()),
        ]
        environ = {**os.environ, ASKED: str(path)}
        done = subprocess.run(
            words, cwd=repository, env=environ, capture_output=True, text=True, check=False
        )
        if done.returncode or not path.is_file():
            said = (done.stdout + done.stderr).splitlines()
            faults = [line for line in said if "Error" in line or "Exception" in line]
            raise InputError(faults[0] if faults else "Snakemake failed")
        told = files.read_json(path, "give the command again")
    jobs = told["jobs"]
    reach = provenance.upstream(jobs)
    settings: dict[str, Settings] = {}
    for job, reached in zip(jobs, reach, strict=True):
        of_job = provenance.settings(jobs[at] for at in sorted(reached))
        settings |= dict.fromkeys(job["outputs"], of_job)
    pending = [name for job in jobs if not job["done"] for name in job["outputs"]]
    left, advice = frozenset(told["remains"]), tuple(told["advice"])
    return Plan(settings, frozenset(pending), remains=left, advice=advice)


def changes(recorded: Settings, now: Settings) -> dict[str, list[str]]:
    """Return the names of the settings that differ, by rule."""
    rules = sorted({*recorded, *now})
    pairs = {rule: (recorded.get(rule, []), now.get(rule, [])) for rule in rules}
    return {rule: _differing(*pair) for rule, pair in pairs.items() if pair[0] != pair[1]}


def _differing(one: list, other: list) -> list[str]:
    keys = sorted({key for params in (*one, *other) for key in params})
    differing = [key for key in keys if _values(one, key) != _values(other, key)]
    return differing or keys  # the same values, in other combinations


def _values(jobs: list, key: str) -> set[str | None]:
    """Return all values of a setting, None for a job that lacks it."""
    return {json.dumps(params[key], sort_keys=True) if key in params else None for params in jobs}


def unseen(workflow: Any, repository: Path) -> list[str]:
    """Return a line if Snakemake lacks records of files that were here before, and keeps them."""
    dag, known = workflow.dag, workflow.persistence
    if dag is None or known is None:
        return []
    kept = [job for job in dag.jobs if job.output and not dag.needrun(job)]
    rules = [job.rule.name for job in kept if _is_unknown(job, known.metadata)]
    if not rules:
        return []
    command = shlex.join(["python", "workflow/verify_study.py", *run.in_folder(repository)])
    jobs = "1 job" if len(rules) == 1 else f"{len(rules)} jobs"
    return [
        f"Remark: results of {jobs} ({few(sorted(set(rules)), N_NAMED)}) are here, but "
        "not Snakemake's records of them (.snakemake/metadata): it does not see changes of their "
        f"settings and code; `{command}` tells these"
    ]


def _is_unknown(job: Any, metadata: Callable[[Any], Any]) -> bool:
    return any(Path(path).exists() and metadata(path) is None for path in job.output)
