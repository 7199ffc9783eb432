"""Watching the jobs of a Snakemake process from outside, and killing them."""

import contextlib
import re
import signal
import time
from dataclasses import dataclass, field
from pathlib import Path

import psutil

LOOK_EVERY_S = 0.03
SCRIPT = re.compile(r"(\S+/\.snakemake/scripts/tmp\w+\.\w+\.py)")
LOG = re.compile(r"results/[\w./-]*?logs/(\w+)/([\w.-]+)\.log")
# One script, and a rule for each artefact, virtual session and take.
PER_NAME = {"fetch_artefact", "simulate_session", "simulate_take"}


@dataclass
class Job:
    """A running job: its rule, its log (one per job of a study), its process, when it was seen."""

    rule: str
    log: str
    process: psutil.Process
    started_s: float = field(default_factory=time.monotonic)

    def kill(self):
        """Kill the shell, the script and all that it started; return whether anything was alive."""
        tree = [self.process]
        with contextlib.suppress(psutil.NoSuchProcess):
            tree += self.process.children(recursive=True)
        return sum(_kill(process) for process in tree) > 0


def _kill(process):
    try:
        process.send_signal(signal.SIGKILL)
    except psutil.NoSuchProcess:
        return False
    return True


def rule_of(log):
    """Return the rule that a log file belongs to, None where a path is no job's log."""
    found = LOG.search(str(log))
    if not found:
        return None
    rule, stem = found.groups()
    return f"{rule}/{stem}" if rule in PER_NAME else rule


def name_in_snakemake(rule):
    """Return the name by which Snakemake knows a rule of `rule_of`."""
    script, _, stem = rule.partition("/")
    return f"{script.split('_')[0]}_{re.sub('[.-]', '_', stem)}" if stem else rule


class Jobs:
    """The jobs below a Snakemake process.

    Attributes
    ----------
    running : dict of int to Job
        By process id.
    """

    def __init__(self, main):
        self.main = psutil.Process(main.pid)
        self.running = {}

    def look(self):
        """Return the jobs that have begun and the jobs that have ended since the last look."""
        try:
            children = {child.pid: child for child in self.main.children()}
        except psutil.NoSuchProcess:
            children = {}
        ended = [self.running.pop(pid) for pid in set(self.running) - set(children)]
        begun = {}
        for pid in set(children) - set(self.running):
            job = job_of(children[pid])
            if job:
                begun[pid] = job
        self.running |= begun
        return list(begun.values()), ended


def job_of(process):
    """Return the job that a process runs, None where it runs none."""
    try:
        script = SCRIPT.search(" ".join(process.cmdline()))
        text = Path(script.group(1)).read_text(errors="replace") if script else ""
    except (psutil.Error, OSError):
        return None
    log = LOG.search(text)
    return Job(rule_of(log.group(0)), log.group(0), process) if log else None


def watch(main):
    """Yield (jobs begun, jobs ended) again and again until a Snakemake process ends.

    Parameters
    ----------
    main : subprocess.Popen

    Yields
    ------
    jobs : Jobs
    begun, ended : list of Job
    """
    jobs = Jobs(main)
    while main.poll() is None:
        yield jobs, *jobs.look()
        time.sleep(LOOK_EVERY_S)
    yield jobs, *jobs.look()


def kill_group(main):
    """Kill Snakemake and all its jobs at once."""
    tree = [psutil.Process(main.pid)]
    tree += tree[0].children(recursive=True)
    for process in tree:
        _kill(process)
    main.wait()


def kill_alone(main):
    """Kill Snakemake; its jobs go on without it. Return them."""
    children = psutil.Process(main.pid).children(recursive=True)
    main.kill()
    main.wait()
    return children
