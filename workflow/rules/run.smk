"""The end of a run: write provenance, list results or faults.

Inputs: all jobs that the run asked for. Outputs: results/run/: provenance.json of the run,
checksums.json of the inputs, provenance/<file>.json beside each figure, table and exported file.
Steps: record_provenance and end_of_run, called in `onsuccess` and `onerror` of the Snakefile. A run
in which a take was judged as failed ends with a line on it and exit code 1. `last_words` is called
when Snakemake ends, also where nothing was to be done: what it cannot see is told, what lacks
consent unless a run has told it, and its jobs are written for a program that asks
(`courtside.study.provenance.planned`).
"""

import atexit
import contextlib
import time

from courtside.study.provenance import planned, run

STARTED_S = time.monotonic()
STUDIED_IN = Path.cwd()
BEFORE = {}  # states of the files that the jobs of a run start from, before it
HAS_RUN = []  # not empty once jobs have run: hooks of the Snakefile then tell how they ended
LOOK_AT = [paths.REPORT, paths.PLAYERS_TABLE, paths.CALIBRATION_TABLE]


def record_provenance(call=asked):
    """Write the sidecars of all files that are newer than theirs; `call` tells what prevents it."""
    HAS_RUN.append(True)
    read = [CONFIG / paths.SESSION_YAML.format(session=name) for name in config["sessions"]]
    registers = ("external.yaml", "models.yaml", "detectors.yaml")
    read = [*(CONFIG / name for name in registers), *read]
    call(run.record, workflow, REPOSITORY, config, map(str, read), run.changed_since(BEFORE))


def end_of_run(n_failed=0):
    """Return the words at the end of a run; `n_failed` takes were made, but judged as failed."""
    viewers = targets.pages.every_viewer(STUDY)
    seconds = time.monotonic() - STARTED_S
    return run.ending(workflow, REPOSITORY, seconds, LOOK_AT, n_failed, viewers)


def last_words():
    """Tell the jobs to who asks, and the user of results that Snakemake has no records of."""
    with contextlib.chdir(STUDIED_IN):  # which Snakemake has left
        planned.tell(workflow, STUDY)
        for line in [*planned.unseen(workflow, REPOSITORY), *untold()]:
            print(line, file=sys.stderr)


def untold():
    """Return what lacks consent, unless a run has told it or Snakemake was refused."""
    if HAS_RUN or workflow.scheduler is None:
        return []
    return run.told_without_jobs(STUDY, workflow.dryrun)


if workflow.is_main_process:
    atexit.register(last_words)
