"""What is said when a run ends.

Inputs: the jobs of the run. Outputs: none. Steps: what was made, or what failed; the words are the library's.
"""

import time

from courtside.study.execution import summary

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
