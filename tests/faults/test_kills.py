"""kill -9 of every rule's job and of Snakemake, at seeded random moments of a run.

The run is one of the tiny study.
"""

import os
import random
import time
from contextlib import ExitStack

import psutil
import pytest

from faults import killing, study_copies
from faults.tally import tries
from smoke.conftest import ASKED_FOR
from smoke.snakemake_runs import FOLDER, planned, run

pytestmark = [
    pytest.mark.fault,
    pytest.mark.skipif(os.name == "nt", reason="Windows ends processes in another way"),
]
ALL = ("--", "all", *ASKED_FOR)
SEED = 20250711
N_OF_SNAKEMAKE = 24
LATEST = 0.9  # of a job's seconds: later, it may have ended before
EARLIER = (0.5, 0.2, 0.05, 0.0)  # for jobs that had; at last they are killed once seen
LATE_S = 2.0  # Snakemake is killed up to so long after a job has ended
# A job is not killed more often than Snakemake tries it again.
AGAIN = ("--keep-going", "--retries", "3")


class Killer:
    """Kills a job of every rule, and Snakemake, until none is left to kill; then the run may end.

    Attributes
    ----------
    killed : dict of str to int
        Jobs killed, by rule.
    missed : dict of str to int
        Jobs that had ended before their moment came, by rule.
    of_snakemake : dict of str to int
        Snakemake killed, with its jobs or alone.
    """

    def __init__(self, seconds, seed=SEED):
        self.seconds, self.draw = seconds, random.Random(seed)
        self.killed, self.missed, self.latest = {}, {}, LATEST
        self.of_snakemake = {"all": 0, "alone": 0}
        self.done, self.orphans = set(), []
        # After so many jobs of the study; two of one number: the second hits a start, or soon
        # after.
        self.moments = sorted(self.draw.choices(range(len(seconds) - 2), k=N_OF_SNAKEMAKE))

    def run_through(self, root, *options):
        """Run the study to its end, however often it is killed."""
        while True:
            main = study_copies.start(root, *AGAIN, *options)
            if not self.disturb(main):
                return main
            run("--unlock", root=root, anew=True)

    def again(self, root, rules, latest):
        """Rerun rules whose jobs had ended before their moments came; kill each, now earlier."""
        self.latest, self.moments = latest, []
        names = sorted(map(killing.name_in_snakemake, rules))
        main = study_copies.start(root, *AGAIN, "--forcerun", *names, "--until", *names, *ALL)
        self.disturb(main)
        return main

    def disturb(self, main):
        """Kill jobs until Snakemake ends; return whether it was killed."""
        due, moment_s = {}, None
        for jobs, begun, ended in killing.watch(main):
            now = time.monotonic()
            due |= {
                job.process.pid: (job, now + self.delay(job)) for job in begun if self.wants(job)
            }
            for job in ended:
                self.done.add(job.log)
                if due.pop(job.process.pid, None):
                    self.missed[job.rule] = self.missed.get(job.rule, 0) + 1
            for pid, (job, when_s) in list(due.items()):
                if now >= when_s:
                    del due[pid]
                    self.hit(job, jobs)
            if moment_s is None and self.moments and len(self.done) >= self.moments[0]:
                moment_s = now + self.draw.uniform(0, LATE_S)
            if moment_s is not None and now >= moment_s and main.poll() is None:
                self.kill_snakemake(main)
                return True
        return False

    def wants(self, job):
        return job.rule not in self.killed

    def delay(self, job):
        return self.draw.uniform(0, self.latest) * self.seconds.get(job.log, 1.0)

    def hit(self, job, jobs):
        if job.rule not in self.killed and job.kill():
            self.killed[job.rule] = 1
            jobs.running.pop(job.process.pid, None)

    def kill_snakemake(self, main):
        self.moments.pop(0)
        if len(self.moments) % 2:
            killing.kill_group(main)
            self.of_snakemake["all"] += 1
        else:
            self.orphans += killing.kill_alone(main)
            self.of_snakemake["alone"] += 1


@pytest.fixture(scope="module")
def killed(untouched, tmp_path_factory):
    """Return (repository of a study killed and restarted to its end, killer, raw files before)."""
    root = tmp_path_factory.mktemp("killed")
    study_copies.prepare_copy(root)
    before = study_copies.raw(root)
    killer = Killer(untouched[1])
    main = killer.run_through(root, *ALL)
    assert main.returncode == 0, study_copies.output(main)
    for latest in EARLIER:
        spared = rules_of(root) - set(killer.killed)
        if spared:
            main = killer.again(root, spared, latest)
            assert main.returncode == 0, study_copies.output(main)
    main = killer.run_through(root, *ALL)  # what rests on a folder that was made again is due
    assert main.returncode == 0, study_copies.output(main)
    psutil.wait_procs(killer.orphans, timeout=120)
    return root, killer, before


def rules_of(root):
    """Return the rules that ran as jobs, by their logs."""
    logs = (root / FOLDER).glob("results/**/*.log")
    return {killing.rule_of(path.relative_to(root / FOLDER)) for path in logs} - {None}


def test_killed_and_restarted_it_ends_as_an_untouched_run(killed, untouched):
    root, killer, before = killed
    kills = killer.of_snakemake
    with ExitStack() as rows:
        rows.enter_context(tries("kill -9 of a job, every rule's", sum(killer.killed.values())))
        rows.enter_context(tries("kill -9 of Snakemake and its jobs", kills["all"]))
        rows.enter_context(tries("kill -9 of Snakemake alone", kills["alone"]))
        assert study_copies.differences(root, untouched[0]) == []
        assert study_copies.raw(root) == before
        assert planned(*ALL, root=root) == {}
    print(f"too late at first for: {killer.missed}")


def test_a_job_of_every_rule_was_killed(killed, untouched):
    root, killer, _ = killed
    rules = rules_of(untouched[0])
    assert len(rules) >= 60
    assert rules_of(root) == rules
    assert rules - set(killer.killed) == set()


def test_snakemake_was_killed_with_and_without_its_jobs(killed):
    kills = killed[1].of_snakemake
    assert min(kills.values()) >= 10
    assert sum(kills.values()) + sum(killed[1].killed.values()) >= 60
