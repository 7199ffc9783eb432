"""Run all comparisons with other programs, and write one table and one figure of them.

    python benchmarks/run.py [--only NAME ...] [--quick] [--images 10 20 40 75] [--video FILE]
                             [--results results] [--environments DIR] [--repeats 3]

Writes results/benchmarks/speed.csv, speed.png and speed.svg, and the table as Markdown on the
terminal. All times are processor time of one run on this machine, the least of the repeats; ratios
are between those. Other programs are installed into environments of their own the first time.
`--only` keeps what the table has of the other comparisons. `--images 300` takes hours with COLMAP's
defaults: run it in the background.
"""

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))

import cv2
import pandas as pd

import machine
import panels
import peers
import rows
import run_log
from comparisons import decoding, filtering, hierarchy, pose, structure, study, triangulation

ALL = [triangulation, filtering, pose, hierarchy, decoding, study, structure]
IMAGES = 10, 20, 40, 75
VIDEO = "external/pose2sim/Pose2Sim/Demo_SinglePerson/videos/cam01.mp4"
KEPT = list(rows.Row.__dataclass_fields__)


@dataclass(frozen=True)
class Given:
    """What comparisons are given: see the command line."""

    environments: Path
    results: Path
    video: Path
    images: tuple
    quick: bool
    repeats: int


def asked():
    """Return the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__.splitlines()[0], epilog="\n".join(__doc__.splitlines()[5:])
    )
    names = [each.NAME.split()[0] for each in ALL]
    parser.add_argument("--only", nargs="+", choices=names, default=names)
    parser.add_argument("--quick", action="store_true", help="little work: does it run?")
    parser.add_argument("--images", type=int, nargs="+", default=IMAGES)
    parser.add_argument("--video", type=Path, help="of one person; that of Pose2Sim by default")
    parser.add_argument("--results", type=Path, default=ROOT / "results", help="of the study")
    parser.add_argument(
        "--to", type=Path, help="folder of the table; results/benchmarks by default"
    )
    parser.add_argument("--environments", type=Path, default=peers.FOLDER)
    parser.add_argument("--repeats", type=int, default=3)
    given = parser.parse_args()
    given.video = given.video or given.results / VIDEO
    return given


def main():
    """Compare, add to the table, draw."""
    peers.on_one_thread()
    cv2.setNumThreads(1)
    line = asked()
    given = Given(*(getattr(line, name) for name in Given.__dataclass_fields__))
    folder = line.to or line.results / "benchmarks"
    folder.mkdir(parents=True, exist_ok=True)
    chosen = [each for each in ALL if each.NAME.split()[0] in line.only]
    found = []
    for each in chosen:
        print(f"{each.NAME} ...", file=sys.stderr, flush=True)
        found += each.compare(given)
    table = rows.table([*kept(folder / "speed.csv", [each.NAME for each in chosen]), *found])
    table.to_csv(folder / "speed.csv", index=False, float_format="%.6g", lineterminator="\n")
    limits = {name: of(name).LIMIT for name in table["comparison"].unique()}
    panels.save(panels.draw(table, limits), folder / "speed.png", folder / "speed.svg")
    print(rows.markdown(table), *sentences(table), sep="\n")
    report_study(line.results.parent)


def of(comparison):
    """Return the module of a comparison's rows."""
    return next(each for each in ALL if comparison.split(",")[0] == each.NAME)


def kept(path, names):
    """Return the table's existing rows, but for those of comparisons that were run now."""
    if not path.is_file():
        return []
    old = pd.read_csv(path, keep_default_na=False, na_values=[""])
    old["error_unit"] = old["error_unit"].fillna("")
    old = old[~old["comparison"].str.split(",").str[0].isin(names)]
    return [rows.Row(**row) for row in old[KEPT].to_dict("records")]


def sentences(table):
    """Return what bounds each comparison, and what its limit counts."""
    core = machine.measured()
    lines = [
        f"\nOne core: {core.flops_32 / 1e9:.0f} GFlop/s of 32 bits, "
        f"{core.bytes_s / 1e9:.1f} GB/s copied. "
        "`over limit`: the time over the least that this core needs for"
    ]
    for each in ALL:
        if of_table := [name for name in table["comparison"].unique() if of(name) is each]:
            lines.append(f"- {of_table[0].split(',')[0]}: {each.LIMIT}. Bounded by {each.BOUNDS}.")
    return lines


def report_study(root):
    """Print the profile of the study, and what Snakemake adds to its jobs."""
    stages = run_log.stages(root)
    if len(stages):
        print(f"\nProcessor time of the study by stage (benchmark files of {len(stages)} rules):")
        print(stages.round(1).to_string(index=False))
    log = run_log.longest(root / ".snakemake" / "log")
    jobs = run_log.jobs(log) if log else []
    if jobs:
        by_log_s, by_file_s, count = run_log.seconds_in_jobs(root, jobs)
        busy_s = sum((job.ended - job.began).total_seconds() for job in jobs)
        whole_s = (max(job.ended for job in jobs) - min(job.began for job in jobs)).total_seconds()
        cores = run_log.cores(log)
        print(
            f"\nLongest run: {len(jobs)} jobs in {whole_s:.0f} s on {cores} cores, which is "
            f"{cores * whole_s:.0f} s of cores; jobs took {busy_s:.0f} s from start to end.\n"
            f"{count} jobs state their own time: {by_file_s:.0f} s; "
            f"Snakemake saw {by_log_s:.0f} s of them."
        )


if __name__ == "__main__":
    main()
