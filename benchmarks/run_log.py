"""Read what a run of Snakemake says of its jobs: begin, end, and benchmark file of each."""

import re
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import pandas as pd

STAMP = re.compile(r"^\[(\w{3} \w{3} +\d+ [\d:]{8} \d{4})\]$")
BEGINS = re.compile(r"^(?:local)?(?:rule|checkpoint) (\w+):$")
NUMBER = re.compile(r"^ {4}jobid: (\d+)$")
BENCHMARK = re.compile(r"^ {4}benchmark: (.+)$")
CORES = re.compile(r"^Provided cores: (\d+)", re.M)
ENDS = re.compile(r"^Finished jobid: (\d+) ")


@dataclass
class Job:
    """One job of a run; times to the second, as the log has them."""

    rule: str
    began: datetime
    ended: datetime | None = None
    benchmark: str | None = None


def jobs(log):
    """Return the finished jobs of a run.

    Parameters
    ----------
    log : str or Path
        Of `.snakemake/log`.

    Returns
    -------
    jobs : list of Job
        In the order in which they began.
    """
    stamp, job, found = None, None, {}
    for line in Path(log).read_text(errors="replace").splitlines():
        if match := STAMP.match(line):
            stamp = datetime.strptime(match[1], "%a %b %d %H:%M:%S %Y")
        elif match := BEGINS.match(line):
            job = Job(match[1], stamp)
        elif match := NUMBER.match(line):
            found[match[1]] = job
        elif (match := BENCHMARK.match(line)) and job:
            job.benchmark = match[1]
        elif (match := ENDS.match(line)) and match[1] in found:
            found[match[1]].ended = stamp
    return [each for each in found.values() if each.ended]


def longest(folder):
    """Return the log of the run with the most jobs, or None."""
    logs = sorted(Path(folder).glob("*.snakemake.log"))
    return max(logs, key=lambda log: len(jobs(log)), default=None)


def cores(log):
    """Return how many cores a run was given, 1 where its log does not say."""
    match = CORES.search(Path(log).read_text(errors="replace"))
    return int(match[1]) if match else 1


def stages(root):
    """Return the profile of a study: its benchmark files, added up by rule.

    Parameters
    ----------
    root : str or Path
        Where `results` is.

    Returns
    -------
    stages : pandas.DataFrame
        Columns rule, jobs, cpu_s, wall_s, most_mb; most processor time first.
    """
    parts = []
    for path in sorted(Path(root).glob("results/**/benchmarks/*/*.tsv")):
        runs = pd.read_csv(path, sep="\t", na_values=["-", "NA"])
        last = runs.iloc[-1]
        parts.append((path.parent.name, 1, last["cpu_time"], last["s"], last["max_rss"]))
    found = pd.DataFrame(parts, columns=["rule", "jobs", "cpu_s", "wall_s", "most_mb"])
    how = {"jobs": "sum", "cpu_s": "sum", "wall_s": "sum", "most_mb": "max"}
    return found.groupby("rule", as_index=False).agg(how).sort_values("cpu_s", ascending=False)


def seconds_in_jobs(root, found):
    """Return the seconds by the clock of jobs with a benchmark file: by the log, and by the file.

    Parameters
    ----------
    root : str or Path
        Where the run's `results` is.
    found : list of Job

    Returns
    -------
    by_log_s, by_file_s : float
    n_jobs : int
    """
    by_log_s = by_file_s = n_jobs = 0
    for job in found:
        path = Path(root) / job.benchmark if job.benchmark else None
        if path and path.is_file():
            by_log_s += (job.ended - job.began).total_seconds()
            by_file_s += float(pd.read_csv(path, sep="\t")["s"].iloc[-1])
            n_jobs += 1
    return by_log_s, by_file_s, n_jobs
