"""Snakemake against the sum of its parts: jobs that do next to nothing, by it and in a loop."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import rows

try:
    import resource
except ImportError:  # Windows does not tell the time of ended processes
    resource = None

NAME = "study"
LIMIT = "the same scripts, one after the other, without Snakemake"
BOUNDS = (
    "starting Python and importing NumPy and SciPy once a job, which the plain loop pays as well; "
    "Snakemake adds its own start, and for each job its records of inputs, parameters and outputs"
)
JOBS = 4  # of the smallest run
SCRIPT = """import numpy
import scipy.linalg
open({output}, "w").write(str(scipy.linalg.norm(numpy.ones(3))))
"""
SNAKEFILE = """
rule all:
    input: expand("made/{{number}}.txt", number=range({count}))

rule make:
    output: "made/{{number}}.txt"
    log: "logs/{{number}}.log"
    benchmark: "benchmarks/{{number}}.tsv"
    script: "make.py"
"""


SNAKEMAKE = [sys.executable, "-m", "snakemake", "--cores", "1", "--quiet", "all"]


def compare(given):
    """Return the rows of Snakemake, the loop, and a second call that has nothing to do."""
    if resource is None:
        raise SystemExit(
            f"{NAME}: Windows does not tell what ended processes took; run it elsewhere"
        )
    found = []
    for times in rows.TIMES[: 2 if given.quick else None]:
        count = times * JOBS
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "make.py").write_text(SCRIPT.format(output="snakemake.output[0]"))
            (folder / "Snakefile").write_text(SNAKEFILE.format(count=count))
            spent = {"loop of scripts": _loop_s(folder, count)}
            for method in ("snakemake", "snakemake, nothing to do"):
                spent[method] = _children_s(SNAKEMAKE, folder)
        least_s = spent["loop of scripts"]
        found += [
            rows.Row(NAME, method, method == "snakemake", "job", count, times, cpu_s, least_s)
            for method, cpu_s in spent.items()
        ]
    return found


def _loop_s(folder, count):
    (folder / "loop").mkdir()
    script = folder / "plain.py"
    script.write_text(SCRIPT.format(output="__import__('sys').argv[1]"))
    commands = [[sys.executable, script, folder / "loop" / f"{at}.txt"] for at in range(count)]
    return sum(_children_s(command, folder) for command in commands)


def _children_s(command, folder):
    """Return the processor time of a command and of all that it starts, s."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    environment = {key: os.environ[key] for key in os.environ if key != "SNAKEMAKE_PROFILE"}
    done = subprocess.run(
        [str(part) for part in command], cwd=folder, env=environment, capture_output=True, text=True
    )
    if done.returncode:
        raise SystemExit(f"{command[0]}: {done.stderr.strip()}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
