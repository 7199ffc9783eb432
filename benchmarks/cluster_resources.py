"""What each rule asks of a cluster, from the benchmark files of finished runs.

    python benchmarks/cluster_resources.py results [more results]
        [--check profiles/slurm/config.yaml]

Prints, per rule, the largest memory, the longest time and the highest mean load measured, then the
lines for `set-resources` of the profile. Memory: 1.5 times the measured, and 500 MB for the
Snakemakes around the job, up to the next 500 MB. Time: ten times the measured, for longer takes and
slower nodes, and 2 minutes to start, up to the next 5 minutes. `--check` ends with 1 where the
profile asks for less than that, or does not name the rule.
"""

import argparse
import csv
import math
import sys
from pathlib import Path

import yaml

MEMORY_FACTOR, SNAKEMAKE_MB, MEMORY_STEP_MB = 1.5, 500, 500
TIME_FACTOR, START_MIN, TIME_STEP_MIN = 10, 2, 5
# Their rules bear the names of sessions and takes, which no profile can know: simulation.smk has
# their needs.
NAMED_BY_SESSION = ("simulate_session", "simulate_take")
LINE = "{:<22}{:>6}{:>10}{:>10}{:>8}{:>10}{:>10}"


def measured(folders):
    """Return {rule: [(seconds, MB, load in cores) of each job]}."""
    found = {}
    for folder in folders:
        for path in sorted(Path(folder).glob("**/benchmarks/*/*.tsv")):
            with path.open(encoding="utf-8", newline="") as stream:
                for row in csv.DictReader(stream, delimiter="\t"):
                    numbers = tuple(number(row[key]) for key in ("s", "max_rss", "mean_load"))
                    found.setdefault(path.parent.name, []).append(numbers)
    return {rule: found[rule] for rule in sorted(found)}


def number(word):
    """Return a number of a benchmark file, 0 where the job was too short to be looked at."""
    return 0.0 if word in ("NA", "-") else float(word)


def up_to(value, step):
    """Return the next multiple of a step."""
    return step * math.ceil(value / step)


def asked(jobs):
    """Return what a rule is to ask for: MB and minutes."""
    seconds, memory_mb, _ = (max(column) for column in zip(*jobs, strict=True))
    return {
        "mem_mb": up_to(MEMORY_FACTOR * memory_mb + SNAKEMAKE_MB, MEMORY_STEP_MB),
        "runtime": up_to(TIME_FACTOR * seconds / 60 + START_MIN, TIME_STEP_MIN),
    }


def table(jobs_of):
    """Print what was measured and what to ask for."""
    print(LINE.format("rule", "jobs", "most s", "most MB", "cores", "mem_mb", "runtime"))
    for rule, jobs in jobs_of.items():
        seconds, memory_mb, load = (max(column) for column in zip(*jobs, strict=True))
        numbers = (f"{seconds:.1f}", f"{memory_mb:.0f}", f"{load / 100:.1f}")
        print(LINE.format(rule, len(jobs), *numbers, *asked(jobs).values()))


def lines(jobs_of):
    """Return the lines of the profile."""
    named = {rule: asked(jobs) for rule, jobs in jobs_of.items() if rule not in NAMED_BY_SESSION}
    return [
        f"  {rule}: {{mem_mb: {ask['mem_mb']} * attempt, runtime: {ask['runtime']} * attempt}}"
        for rule, ask in named.items()
    ]


def shortages(jobs_of, profile):
    """Return a line for each rule that a profile gives less than was measured, with the margins."""
    given = yaml.safe_load(Path(profile).read_text(encoding="utf-8")).get("set-resources", {})
    found = []
    for rule, jobs in jobs_of.items():
        if rule in NAMED_BY_SESSION:
            continue
        for key, value in asked(jobs).items():
            has = int(str(given.get(rule, {}).get(key, 0)).partition("*")[0])
            if has < value:
                found.append(f"{profile}: {rule}: {key}: expected {value} or more, found {has}")
    return found


def main():
    """Print the table and the lines, or check a profile."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", nargs="+", type=Path)
    parser.add_argument("--check", type=Path, metavar="PROFILE")
    given = parser.parse_args()
    jobs_of = measured(given.results)
    if not jobs_of:
        sys.exit(f"{given.results[0]}: no benchmarks/<rule>/*.tsv found; run the study first")
    table(jobs_of)
    if given.check:
        found = shortages(jobs_of, given.check)
        print(*found or ["the profile asks for enough"], sep="\n")
        sys.exit(bool(found))
    print("\nset-resources:", *lines(jobs_of), sep="\n")


if __name__ == "__main__":
    main()
