"""The Slurm profile: which rules it names, and the tiny study on a real Slurm.

`.ci/slurm` starts one.
"""

import importlib.util
import random
import re
import shutil
import subprocess
import sys
import time

import pytest
import yaml

from courtside.study.provenance import comparison
from smoke.snakemake_runs import FOLDER, ROOT, TINY, copy_repository

PROFILE = ROOT / "profiles" / "slurm" / "config.yaml"
MOST_JOBS = 15
ONE_TAKE = "results/walk-4cams-tiny/takes/balancing"
SKELETONS = f"{ONE_TAKE}/pose3d/file/all-robust/blazepose-full.npz"


def rules():
    files = (ROOT / "workflow" / "rules").glob("*.smk")
    return {name for file in files for name in re.findall(r"^rule (\w+):", file.read_text(), re.M)}


def profile():
    return yaml.safe_load(PROFILE.read_text())


def test_every_rule_is_in_a_group_and_no_other_is_named():
    assert set(profile()["groups"]) == rules()
    assert set(profile()["set-resources"]) < rules()
    assert set(profile()["group-components"]) == set(profile()["groups"].values())


def test_measured_rules_are_those_with_a_benchmark_file():
    """But for simulations, whose rules bear names of sessions."""
    text = "\n".join(path.read_text() for path in (ROOT / "workflow" / "rules").glob("*.smk"))
    blocks = re.findall(r"^rule (\w+):\n(.*?)(?=^rule |^\S|\Z)", text, re.M | re.S)
    with_file = {name for name, block in blocks if re.search(r"^ +benchmark:", block, re.M)}
    assert with_file == set(profile()["set-resources"])


def test_groups_of_the_default_study_do_not_wait_for_one_another(tmp_path):
    """Snakemake refuses a group that depends on itself; needs no Slurm."""
    named = profile()["groups"]
    parts = [f"{group}=1000" for group in profile()["group-components"]]
    command = [sys.executable, "-m", "snakemake", "-n", "--forceall", "--quiet", "rules"]
    command += ["--directory", str(tmp_path), "--config", "sessions=[plain-b,players-b,walk-4cams]"]
    command += ["variations=[]", "--groups", *(f"{rule}={group}" for rule, group in named.items())]
    command += ["--group-components", *parts]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert re.search(r"^total +\d{3,}$", done.stdout + done.stderr, re.M)


def answer(*command):
    return subprocess.run(command, capture_output=True, text=True, timeout=30, check=True).stdout


@pytest.fixture(scope="module")
def slurm():
    """Skip where no Slurm answers, or Snakemake cannot speak to it."""
    if importlib.util.find_spec("snakemake_executor_plugin_slurm") is None:
        pytest.skip("snakemake-executor-plugin-slurm is not installed (profiles/README.md)")
    if shutil.which("sinfo") is None:
        pytest.skip("no Slurm is installed; .ci/slurm installs one")
    try:
        nodes = answer("sinfo", "--noheader", "--format=%C")
    except (subprocess.CalledProcessError, subprocess.TimeoutExpired):
        pytest.skip("no Slurm answers; .ci/slurm starts one")
    return int(nodes.rpartition("/")[2])


@pytest.fixture(scope="module")
def copy(slurm, tiny_study, tmp_path_factory):
    """Return a copy of the repository without results but for what is fetched from outside."""
    root = tmp_path_factory.mktemp("slurm")
    copy_repository(root)
    shutil.copytree(tiny_study / "external", root / FOLDER / "results" / "external")
    return root


def started(root, cores, *options):
    """Start Snakemake with the profile; the file of what it says is the root's `said.txt`."""
    command = [sys.executable, "-m", "snakemake", "--workflow-profile", "profiles/slurm"]
    command += ["--cores", str(cores), "--slurm-init-seconds-before-status-checks", "5"]
    command += ["--directory", str(FOLDER), "--configfile", str(TINY), *options]
    with (root / "said.txt").open("w") as output:
        return subprocess.Popen(command, cwd=root, stdout=output, stderr=output)


def finish(process, root, timeout_s):
    """Wait for Snakemake; return what it said."""
    try:
        status = process.wait(timeout=timeout_s)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
        status = "none: too long"
    output = (root / "said.txt").read_text()
    assert status == 0, output
    return output


def slurm_jobs(output):
    return re.findall(r"submitted with SLURM jobid (\d+)", output)


@pytest.fixture(scope="module")
def on_slurm(slurm, copy):
    """Return what Snakemake said of the whole tiny study on Slurm."""
    return finish(started(copy, slurm, "--", "all"), copy, timeout_s=1500)


@pytest.mark.slurm
def test_the_tiny_study_gives_the_same_results_as_on_one_machine(on_slurm, copy, tiny_study):
    verdicts = comparison.compare(copy / FOLDER / "results", tiny_study)
    # The local study also has what is asked for by name, and what an older version of it left.
    faults = [v for v in verdicts if v.outcome in (comparison.DIFFERENT, comparison.ONLY_HERE)]
    assert faults == []
    assert sum(v.outcome == comparison.EQUAL for v in verdicts) > 200


@pytest.mark.slurm
def test_the_tiny_study_takes_few_slurm_jobs(on_slurm):
    assert 5 < len(slurm_jobs(on_slurm)) <= MOST_JOBS


@pytest.mark.slurm
def test_one_take_with_a_cancelled_job_gives_the_same_skeletons(slurm, copy, tiny_study):
    chance = random.Random(7)
    process = started(copy, slurm, "--forcerun", "detect_pose", "--", SKELETONS)
    try:
        job = running_job(process, copy)
        time.sleep(chance.uniform(2, 8))  # in the middle of starting, or of detecting
        answer("scancel", job)
    except BaseException:
        process.kill()
        raise
    output = finish(process, copy, timeout_s=600)
    assert len(slurm_jobs(output)) >= 2, output
    assert "Trying to restart job" in output
    local = tiny_study.parent / SKELETONS
    assert (copy / FOLDER / SKELETONS).read_bytes() == local.read_bytes()


def running_job(process, root):
    """Return the id of the Slurm job that Snakemake submitted, as soon as it runs."""
    until = time.monotonic() + 120
    while time.monotonic() < until and process.poll() is None:
        for job in slurm_jobs((root / "said.txt").read_text()):
            if answer("squeue", "--noheader", "--format=%T", "--job", job).strip() == "RUNNING":
                return job
        time.sleep(0.5)
    raise AssertionError("no Slurm job ran:\n" + (root / "said.txt").read_text())
