"""How long Snakemake plans a study of many sessions, and how long it finds nothing to do.

    python benchmarks/many_sessions.py [--sessions 10 100 1000] [--finished DIR] [--json OUT]

In a temporary copy of the repository it writes so many sessions like `walk-4cams` (4 takes by 4
fixed cameras, a calibration file; all files a few bytes long) and runs `snakemake -n --quiet rules`
over them: seconds, seconds of the processor, largest resident memory, jobs. `--finished DIR` is a
folder with the finished results of the tiny study (tests/smoke after the tests): the time of a
`snakemake -n` over it that finds nothing to do, the median of three.
"""

import argparse
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import yaml

from repository import ROOT

KEPT = ("Snakefile", "workflow", "config", "profiles", "environment.lock")
LINE = (
    "{:>8} sessions x {} takes x {} cameras{:>9} jobs{:>9.1f} s{:>9.1f} s of processor{:>9.0f} MB"
)
TINY = str(Path("config") / "tiny.yaml")


def copied(folder):
    """Copy what a study needs into a folder."""
    for name in KEPT:
        source = ROOT / name
        if source.is_dir():
            ignored = shutil.ignore_patterns("__pycache__")
            shutil.copytree(source, folder / name, ignore=ignored, dirs_exist_ok=True)
        else:
            shutil.copy2(source, folder / name)
    return folder


def write_sessions(folder, n_sessions, n_takes, n_cameras):
    """Write sessions, their recordings and their study; return its configuration's name."""
    cameras = [f"cam{number:02d}" for number in range(1, n_cameras + 1)]
    names = [f"visit-{number:04d}" for number in range(n_sessions)]
    for name in names:
        data = folder / "data" / name
        data.mkdir(parents=True)
        (data / "calibration.toml").write_text("[metadata]\n")
        takes = {}
        for number in range(1, n_takes + 1):
            videos = {camera: f"data/{name}/take{number}_{camera}.mp4" for camera in cameras}
            takes[f"take{number}"] = {"synchronised": True, "videos": videos}
            for path in videos.values():
                (folder / path).write_text("no video")
        content = {
            "description": "A visit",
            "court": "none",
            "subjects": {"p1": {"consent": ["analysis", "export", "pictures"]}},
            "cameras": {camera: {} for camera in cameras},
            "calibration": {"file": f"data/{name}/calibration.toml"},
            "takes": takes,
        }
        file = folder / "config" / "sessions" / f"{name}.yaml"
        file.write_text(yaml.safe_dump(content, sort_keys=False))
    study = folder / "config" / "many.yaml"
    study.write_text(yaml.safe_dump({"sessions": names, "plans": [], "variations": []}))
    return str(study.relative_to(folder))


def timed(folder, *options):
    """Run a dry run; return its seconds, processor seconds, memory in MB, and what it printed."""
    command = [sys.executable, "-m", "snakemake", "--dry-run", *options]
    with tempfile.TemporaryFile("w+") as output:
        started = time.monotonic()
        process = subprocess.Popen(command, cwd=folder, stdout=output, stderr=output)
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.monotonic() - started
        output.seek(0)
        text = output.read()
    if status:
        sys.exit(f"{' '.join(command)} ended with status {status}:\n{text[-2000:]}")
    return seconds, usage.ru_utime + usage.ru_stime, mib(usage.ru_maxrss), text


def mib(ru_maxrss):
    """Return the greatest memory of a process, MiB: macOS tells bytes, other systems KiB."""
    return ru_maxrss / (2**20 if sys.platform == "darwin" else 2**10)


def planned(n_sessions, n_takes, n_cameras):
    """Return and print what planning so many sessions costs."""
    with tempfile.TemporaryDirectory() as name:
        folder = copied(Path(name))
        study = write_sessions(folder, n_sessions, n_takes, n_cameras)
        *numbers, text = timed(folder, "--quiet", "rules", "--configfile", study)
    n_jobs = int(re.search(r"^total +(\d+)$", text, re.M).group(1))
    row = (n_sessions, n_takes, n_cameras, n_jobs, *numbers)
    print(LINE.format(*row), flush=True)
    keys = ("sessions", "takes", "cameras", "jobs", "seconds", "cpu_s", "memory_mb")
    return dict(zip(keys, row, strict=True))


def nothing_to_do(finished, repeats=3):
    """Return and print how long a finished tiny study needs to find that nothing is to be done."""
    options = ("--quiet", "rules", "--directory", str(finished), "--configfile", TINY)
    runs = [timed(ROOT, *options) for _ in range(repeats)]
    if any("\ntotal " in text for *_, text in runs):
        sys.exit(f"{finished}: expected a finished tiny study, found jobs to run; run it first")
    seconds, cpu_s, memory_mb, _ = zip(*runs, strict=True)
    found = {"seconds": seconds, "cpu_s": cpu_s, "memory_mb": memory_mb}
    found = {key: statistics.median(column) for key, column in found.items()}
    print("nothing to do in the tiny study: {seconds:.1f} s, {cpu_s:.1f} s of processor, "
          "{memory_mb:.0f} MB".format(**found))  # fmt: skip
    return found


def main():
    """Measure what was asked for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sessions", type=int, nargs="*", default=[10, 100, 1000])
    parser.add_argument("--takes", type=int, default=4)
    parser.add_argument("--cameras", type=int, default=4)
    parser.add_argument("--finished", type=Path, help="a folder with the finished tiny study")
    parser.add_argument("--json", type=Path, help="also write the numbers to this file")
    given = parser.parse_args()
    found = {"planned": [planned(n, given.takes, given.cameras) for n in given.sessions]}
    if given.finished:
        found["nothing_to_do"] = nothing_to_do(given.finished.resolve())
    if given.json:
        given.json.write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
