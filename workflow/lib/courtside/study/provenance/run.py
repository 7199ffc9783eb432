"""A run of Snakemake: its jobs as plain values, the command that repeats it, its last words."""

import json
import shlex
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from courtside.study import paths
from courtside.study.configuration import consent
from courtside.study.configuration.sessions import Session, Study
from courtside.study.errors import InputError, StrPath, few
from courtside.study.execution import files, summary
from courtside.study.execution import verdicts as verdict_files
from courtside.study.provenance import environment, provenance
from courtside.study.targets import remains
from courtside.study.targets.calibration import warning_files

N_WARNINGS = 3  # of one calibration, on the terminal
N_NAMED = 3  # photos, models or files in a line


States = Mapping[str, tuple[int, int] | None]  # size and date, ns, by path; None without a file


def states(workflow: Any) -> States:
    """Return the present states of the files that jobs which are about to run start from."""
    dag = workflow.dag
    made = {name for job in dag.jobs for name in job.products()}
    used = {name for job in dag.needrun_jobs() for name in job.input if name not in made}
    return {name: _state(name) for name in sorted(Path(name).as_posix() for name in used)}


def _state(name: str) -> tuple[int, int] | None:
    """Return size and date, ns, of a file; of a folder, its files are inputs of their own."""
    if not Path(name).is_file():
        return None
    found = Path(name).stat()
    return found.st_size, found.st_mtime_ns


def changed_since(before: States) -> list[str]:
    """Return the files whose states have changed."""
    return [name for name, state in before.items() if state != _state(name)]


def unsure(workflow: Any, repository: Path, before: States) -> list[str]:
    """Return a line on files that changed while a run made results from them.

    The jobs have to be forced: Snakemake notes the content of an input at the end of a job.
    """
    changed, dag = set(changed_since(before)), workflow.dag
    jobs = [
        (job, found)
        for job in dag.needrun_jobs(exclude_finished=False)
        if dag.finished(job)
        and job.output
        and (found := {Path(name).as_posix() for name in job.input} & changed)
    ]
    if not jobs:
        return []
    names = sorted(set().union(*(found for _, found in jobs)))
    words = repeating_command(workflow.config_settings, repository)
    forced = shlex.join([*words, "--forcerun", *(str(job.output[0]) for job, _ in jobs)])
    return [
        f"Warning: {few(names, N_NAMED)} changed during this run, so results may be of what was "
        f"there before; they are made anew by: {forced}"
    ]


def record(
    workflow: Any,
    repository: Path,
    config: Mapping[str, Any],
    shared: Iterable[str],
    changed: Iterable[str] = (),
) -> None:
    """Write the sidecars of all files that are newer than theirs.

    `workflow` is Snakemake's, `config` the merged configuration, `shared` the YAML files that the
    study was read from beside Snakemake's configuration files, `changed` the inputs that changed
    while the run went on. An `InputError` if sidecars cannot be written.
    """
    dag = workflow.dag
    jobs = [
        plain_job(job, dag, workflow.touch) | {"known": workflow.persistence.has_metadata(job)}
        for job in dag.jobs
    ]
    targets = {Path(name).as_posix() for name in dag.derived_targetfiles}
    run = {
        "command": repeating_command(workflow.config_settings, repository),
        "surroundings": environment.found(repository),
        "config": config,
        "config_files": [files.seen_from(path) for path in workflow.configfiles]
        + [Path(path).as_posix() for path in shared],
    }
    pinned = (paths.EXTERNAL, paths.NETWORKS)
    try:
        provenance.record(
            jobs,
            paths.RUN,
            run=run,
            root=paths.RESULTS,
            pinned=pinned,
            targets=targets,
            changed=changed,
        )
    except OSError as error:
        raise InputError(
            f"{paths.RUN}: provenance not written: {error}; mend this, then run "
            "`snakemake --force -- FILE` for any file of the study"
        ) from None


def plain_job(job: Any, dag: Any, touched: bool) -> dict[str, Any]:
    """Return what `provenance.record` needs of a Snakemake job."""
    params = dict(job.params.items())
    params.pop("mirror_folder", None)  # a checksum tells what is fetched, from wherever
    scripted = job.rule.script is not None
    return {
        "rule": job.rule.name,
        "script": Path(str(job.rule.script)).name if scripted else None,
        "code": params.pop("code", None),
        "inputs": [Path(name).as_posix() for name in job.input],
        "outputs": [Path(name).as_posix() for name in job.products()],
        "params": params,
        "done": dag.noneedrun_finished(job),
        "made": dag.finished(job) and not touched,
    }


def repeating_command(settings: Any, repository: Path) -> list[str]:
    """Return the command that makes files of this study, but for their names, as words."""
    words = ["snakemake", *in_folder(repository)]
    given = [files.seen_from(path, repository) for path in settings.configfiles]
    words += ["--configfile", *given] if given else []
    changed = [
        f"{key}={value if isinstance(value, str) else json.dumps(value)}"
        for key, value in settings.config.items()
    ]
    return words + (["--config", *changed] if changed else [])


def in_folder(repository: StrPath) -> list[str]:
    """Return the option of a command, given in the repository, that names the present folder."""
    folder = files.seen_from(Path.cwd(), repository)
    return [] if folder == "." else ["--directory", folder]


def verdicts(workflow: Any) -> tuple[list[str], int]:
    """Return the verdicts on the takes that a run was asked for, and how many of them failed."""
    made = {Path(name).as_posix() for job in workflow.dag.jobs for name in job.output}
    name = Path(paths.QUALITY).name
    return verdict_files.summary(
        sorted(path for path in made if path.endswith(f"/{name}") and "/takes/" in path)
    )


def ending(
    workflow: Any,
    repository: Path,
    seconds: float,
    look_at: Iterable[str],
    n_failed: int = 0,
    viewers: Iterable[str] = (),
) -> str:
    """Return the words at the end of a run, finished or stopped; `n_failed` takes failed.

    Of the files to `look_at`, those that this run made are named, and of `viewers` the first.
    """
    dag, scheduler = workflow.dag, workflow.scheduler
    wanted = [job for job in dag.needrun_jobs(exclude_finished=False) if job.output]
    done = [job for job in wanted if dag.finished(job)]
    failed = scheduler.failed if scheduler else ()
    if not failed and len(done) == len(wanted):
        made = [str(path) for job in done for path in job.output]
        of_run = {Path(path).as_posix() for job in dag.jobs for path in job.output}
        new = {Path(path).as_posix() for path in made}
        named = [path for path in look_at if path in new]
        named += [path for path in viewers if path in new][:1]
        text = summary.finished(made, seconds, named, n_failed)
        is_older = made and paths.REPORT not in of_run and Path(paths.REPORT).is_file()
        return f"{text}\n{_older_report(workflow, repository)}" if is_older else text
    faults = [(job.name, [str(path) for path in job.log]) for job in failed]
    return summary.failed(faults, len(done), len(wanted), seconds)


def _older_report(workflow: Any, repository: Path) -> str:
    snakemake, *rest = repeating_command(workflow.config_settings, repository)
    command = shlex.join([snakemake, "report", *rest])
    return f"{paths.REPORT} is of an earlier run; {command} makes it anew."


def waiting_for_clicks(study: Study) -> list[str]:
    """Return one line for each session whose court points nobody has clicked yet."""
    waiting = [session for session in study.sessions.values() if session.unclicked]
    pages = [paths.CLICKING_PAGE.format(session=session.name) for session in waiting]
    return [
        f"{session.name}: court points are not clicked yet: open {page} in a browser, "
        f"click them, save them as {session.unclicked}, and give the same command again"
        for session, page in zip(waiting, pages, strict=True)
    ]


def lost_pictures(study: Study) -> list[str]:
    """Return a line for each session on the photos that a model which was made by now lacks.

    Models that lack the same photos share a line. Frames of a video beside fixed cameras are not
    told.
    """
    found = []
    for session in study.sessions.values():
        models: dict[tuple[int, int, str], list[str]] = {}
        for variant in session.variants() if session.walks else []:
            path = Path(paths.SFM_SUMMARY.format(session=session.name, **vars(variant)))
            lost = _lost(session, files.read_json(path)) if path.is_file() else (0, 0, "")
            models.setdefault(lost, []).append(variant.name)
        found += [
            f"{session.name}: {n_lost} of {n_images} pictures not in the model "
            f"{few(names, N_NAMED)}{photos}: too little overlap with the others, or another place, "
            f"see {paths.MATCH_TABLE.format(session=session.name)}; add pictures in between, or "
            f"leave {'it' if n_lost == 1 else 'them'} out"
            for (n_lost, n_images, photos), names in models.items()
            if n_lost
        ]
    return found


def _lost(session: Session, summary: Mapping[str, Any]) -> tuple[int, int, str]:
    """Return how many pictures a model lacks, of how many, and in words which photos they are."""
    unregistered = summary.get("unregistered", {})
    photos = [f"{own} is {name}" for name, own in unregistered.items() if own]
    n_lost = len(photos) if session.cameras else summary["n_images"] - summary["n_registered"]
    return n_lost, summary["n_images"], f" ({few(photos, N_NAMED)})" if photos else ""


def warnings(study: Study) -> list[str]:
    """Return warnings and remarks on cameras that recorded takes are measured with, a line each."""
    found = []
    for session in study.sessions.values():
        name, read = session.name, [] if session.virtual else warning_files(session)
        for path in (path for path in read if Path(path).is_file()):
            content = files.read_json(Path(path))
            told = content.get("warnings", [])
            found += [f"Warning: {name}: {line}; see {path}" for line in told[:N_WARNINGS]]
            more = len(told) - N_WARNINGS
            found += [f"Warning: {name}: {more} more, see {path}"] * (more > 0)
            found += [f"{name}: {line}; see {path}" for line in content.get("remarks", ())]
    return found


def left_out(study: Study) -> list[str]:
    """Return a line for each thing that is not made for want of consent, and on what remains."""
    found = _of_no_session(study)
    for session in study.sessions.values():
        found += [f"{session.name}: {line}" for line in consent.left_out(session)]
        found += [f"{session.name}: {line}" for line in _of_no_take(session)]
        Path(paths.WITHOUT_CONSENT.format(session=session.name)).unlink(missing_ok=True)
    for name, kept in remains.without_consent(study).items():
        listed = Path(paths.WITHOUT_CONSENT.format(session=name))
        listed.parent.mkdir(parents=True, exist_ok=True)
        with files.atomic(listed) as temporary:
            temporary.write_text("\n".join(kept) + "\n", encoding="utf-8")
        is_one, more = len(kept) == 1, "" if len(kept) == 1 else "such as "
        report = f", and {paths.REPORT}, which may show them" * Path(paths.REPORT).is_file()
        found.append(
            f"{name}: {len(kept)} file{'' if is_one else 's'} that persons have not agreed to "
            f"{'was' if is_one else 'were'} made before, {more}{few(kept, N_NAMED)}: delete all "
            f"that {listed.as_posix()} lists{report}"
        )
    return found


def told_without_jobs(study: Study, is_dry: bool) -> list[str]:
    """Return what `left_out` says where no job ran, or of a dry run would say."""
    try:
        return _announced(study) if is_dry else left_out(study)
    except OSError as error:
        return [
            f"Error: {error.filename}: expected a file that can be written, with what persons have "
            f"not agreed to, found: {error.strerror}; mend this, then give the same command again"
        ]


def _announced(study: Study) -> list[str]:
    """Return the lines that `left_out` would give now; nothing is written."""
    lines = [
        f"{session.name}: {line}"
        for session in study.sessions.values()
        for line in consent.left_out(session)
    ]
    return lines + remaining(study)


def remaining(study: Study) -> list[str]:
    """Return a line for each thing that is left of what the session files no longer ask for."""
    found = _of_no_session(study)
    found += [
        f"{session.name}: {line}"
        for session in study.sessions.values()
        for line in _of_no_take(session)
    ]
    return found + [
        f"{name}: {len(kept)} files that persons have not agreed to are here, such as "
        f"{few(kept, N_NAMED)}: delete them; the end of a run lists all"
        for name, kept in remains.without_consent(study).items()
    ]


def _of_no_session(study: Study) -> list[str]:
    """Return a line for each folder of results of a session that was renamed or removed."""
    return [
        f"{folder} belongs to no session of {study.folder / 'sessions'}: delete it, and "
        f"{paths.REPORT}, which may show it, or name the session again"
        for folder in remains.of_no_session(study)
    ]


def _of_no_take(session: Session) -> list[str]:
    """Return a line for each take with results of takes or persons that are no more."""
    pages = Path(paths.QUALITY_PAGE.format(session=session.name)).parent.as_posix()
    gone = [
        f"{folder} has files of {', '.join(persons)}, whom this take does not have: delete them"
        for folder, persons in remains.of_nobody(session).items()
    ]
    gone += [
        f"{folder} has files of {', '.join(cameras)}, which this take does not have: delete them"
        for folder, cameras in remains.of_no_camera(session).items()
    ]
    return gone + [
        f"{folder} was made before: delete it, {pages} and {paths.REPORT}, which may show it"
        if is_withheld
        else f"{folder} belongs to no take of the session: delete it, or name the take again"
        for folder, is_withheld in remains.of_takes(session).items()
    ]
