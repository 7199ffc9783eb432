"""What happens when a run ends, well or not: provenance is written, and what was made or what failed is said.

Inputs: all jobs that the run asked for. Outputs: results/run/: provenance.json of the run, checksums.json of the
inputs, provenance/<file>.json beside each figure, table and exported file.
Steps: record_provenance and end_of_run, called in `onsuccess` and `onerror` of the Snakefile.
"""

import json
import time

from courtside.study.execution import summary
from courtside.study.provenance import environment, provenance

PINNED = ("results/external/", "results/networks/")


def record_provenance():
    """Write the sidecars of all files that are new since theirs; a fault is told in one line."""
    jobs = [plain_job(job) for job in workflow.dag.jobs]
    targets = {str(name) for name in workflow.dag.derived_targetfiles}
    run = {
        "command": repeating_command(),
        "surroundings": environment.found(REPOSITORY),
        "config": config,
        "config_files": configuration_files(),
    }
    try:
        provenance.record(
            jobs, "results/run", run=run, root="results", pinned=PINNED, targets=targets
        )
    except OSError as error:
        raise WorkflowError(
            f"results/run: provenance not written: {error}; mend this, then run "
            "`snakemake --force -- FILE` for any file of the study"
        ) from None


def plain_job(job):
    """Return what the library wants to know of a job."""
    params = dict(job.params.items())
    scripted = job.rule.script is not None
    return {
        "rule": job.rule.name,
        "script": Path(str(job.rule.script)).name if scripted else None,
        "code": params.pop("code", None),
        "inputs": [str(name) for name in job.input],
        "outputs": [str(name) for name in job.products()],
        "params": params,
        "done": workflow.dag.noneedrun_finished(job),
        "made": workflow.dag.finished(job) and not workflow.touch,
    }


def repeating_command():
    """Return the words of the command that makes files of this study, without a file, in the repository's folder."""
    words = ["snakemake"]
    folder = os.path.relpath(Path.cwd(), REPOSITORY)
    words += [] if folder == "." else ["--directory", folder]
    given = [os.path.relpath(path, REPOSITORY) for path in workflow.config_settings.configfiles]
    words += ["--configfile", *given] if given else []
    changed = [
        f"{key}={value if isinstance(value, str) else json.dumps(value)}"
        for key, value in workflow.config_settings.config.items()
    ]
    return words + (["--config", *changed] if changed else [])


def configuration_files():
    """Return the YAML files that the study was read from."""
    sessions = [f"sessions/{name}.yaml" for name in config["sessions"]]
    shared = [CONFIG / name for name in ("external.yaml", "models.yaml", *sessions)]
    return [os.path.relpath(path) for path in workflow.configfiles] + [str(p) for p in shared]


STARTED_S = time.monotonic()
LOOK_AT = [
    "results/report.html",
    "results/figures/players.csv",
    "results/figures/calibration.csv",
]


def end_of_run():
    """Return the words at the end of a run, for the handlers of the Snakefile."""
    wanted = [job for job in workflow.dag.needrun_jobs(exclude_finished=False) if job.output]
    seconds = time.monotonic() - STARTED_S
    done = [job for job in wanted if workflow.dag.finished(job)]
    failed = workflow.scheduler.failed if workflow.scheduler else ()
    if not failed and len(done) == len(wanted):
        made = [str(path) for job in done for path in job.output]
        return summary.finished(made, seconds, LOOK_AT + every_viewer()[:1])
    faults = [(job.name, [str(path) for path in job.log]) for job in failed]
    return summary.failed(faults, len(done), len(wanted), seconds)
