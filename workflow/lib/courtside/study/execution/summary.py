"""The text at the end of a run: what was made and how long it took, or what to do."""

from collections.abc import Iterable, Sequence
from pathlib import Path

from courtside.study.errors import SPARE_MEMORY, InputError, StrPath, few
from courtside.study.execution import machine_resources

N_NAMED = 3  # folders or files that a line names; the rest are counted
N_FAULTS = 20  # told with their reason
UNFINISHED = (" INFO ", " WARNING ")  # the last line of a log without an error
# What a file is, by what its path must contain and how it ends; the first that fits counts.
KINDS = (
    ("reports", "", ("report.html",)),
    ("3D viewers", "/pages/viewer", (".html",)),
    ("pages", "", (".html",)),
    ("videos with skeletons", "/videos/", (".mp4",)),
    ("figures", "/figures/", (".png",)),
    ("figures of plans", "/plans/", (".png",)),
    ("skeletons for other programs", "/pose3d", (".trc", ".c3d", ".bvh")),
    ("skeletons of devices for other programs", "/devices/", (".trc", ".c3d", ".bvh")),
    ("calibrated cameras", "/calibration/", ("cameras.toml",)),
    ("measures of takes", "/kinematics/", (".summary.csv",)),
    ("footwork of takes", "/footwork/", (".summary.csv",)),
    ("strokes of players", "/strokes/", (".reactions.csv",)),
    ("tables of errors", "/evaluation/", (".csv",)),
)


def finished(
    made: Iterable[str], seconds: float, look_at: Iterable[str] = (), n_failed: int = 0
) -> str:
    """Return a few lines on a run in which everything was made.

    `made` are the files that this run made; `look_at` is what to look at, where it exists;
    `n_failed` counts the takes that were measured, but judged as failed.
    """
    made = list(made)
    if not made:
        return "Courtside: everything was there already, nothing had to be made."
    count = "1 file" if len(made) == 1 else f"{len(made)} files"
    takes = "1 take" if n_failed == 1 else f"{n_failed} takes"
    but = f", but {takes} failed: see the end" if n_failed else ""
    word = "" if n_failed else "finished, "
    lines = [f"Courtside: {word}{count} made in {duration(seconds)}{but}."]
    lines += [
        f"  {kind} ({len(paths)}): {_places(paths)}" for kind, paths in _by_kind(made).items()
    ]
    there = [path for path in look_at if Path(path.split(" ")[0]).exists()]
    lines += [f"Look at {', '.join(there)}."] if there else []
    return "\n".join(lines)


def failed(
    faults: Sequence[tuple[str, list[str]]], n_finished: int, n_wanted: int, seconds: float
) -> str:
    """Return a few lines on a run that stopped: what failed and why, what to do.

    `faults` are the jobs that failed, each a name with its log files; `n_wanted` counts the jobs to
    do at the start.
    """
    lines = [f"Courtside: stopped after {n_finished} of {n_wanted} jobs, {duration(seconds)}."]
    for name, logs in faults[:N_FAULTS]:
        log = next((path for path in logs if Path(path).is_file()), "")
        why = _last_fault(log) if log else "no log of its own"
        lines.append(f"  {name}: {why}" + (f" (whole log: {log})" if log else ""))
    if len(faults) > N_FAULTS:
        lines.append(_more(faults[N_FAULTS:]))
    lines.append(
        "Finished files are kept: correct the fault and run the same command again. If it reports "
        "a locked folder and no other run uses this folder: snakemake --unlock."
    )
    return "\n".join(lines)


def _more(faults: Sequence[tuple[str, list[str]]]) -> str:
    """Return a line on the jobs that are only counted, with the places of their logs."""
    logs = [path for _, paths in faults for path in paths if Path(path).is_file()]
    count = "1 more job" if len(faults) == 1 else f"{len(faults)} more jobs"
    return f"  and {count}" + (f" (their logs: {_places(logs)})" if logs else "")


def duration(seconds: float) -> str:
    """Return a time in words: 42 s, 3 min 20 s, 2 h 5 min."""
    seconds = round(seconds)
    if seconds < 60:
        return f"{seconds} s"
    minutes, seconds = divmod(seconds, 60)
    if minutes < 60:
        return f"{minutes} min {seconds} s"
    return f"{minutes // 60} h {minutes % 60} min"


def _by_kind(made: Iterable[str]) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {kind: [] for kind, _, _ in KINDS}
    for path in map(str, made):
        kinds = (kind for kind, part, end in KINDS if part in path and path.endswith(end))
        if kind := next(kinds, None):
            found[kind].append(path)
    return {kind: paths for kind, paths in found.items() if paths}


def _places(paths: list[str]) -> str:
    """Return the files themselves if few, their folders otherwise."""
    if len(paths) <= N_NAMED:
        return ", ".join(paths)
    return few(list(dict.fromkeys(f"{Path(path).parent}/" for path in paths)), N_NAMED)


def _last_fault(log: StrPath) -> str:
    """Return the last error that a job's log holds, else its last line."""
    lines = Path(log).read_text(encoding="utf-8", errors="replace").splitlines()
    lines = [line.strip() for line in lines if line.strip()]
    for line in reversed(lines):
        _, mark, message = line.partition(" ERROR ")
        if mark:
            return message
    if not lines:
        return _unwritten(Path(log).parent)
    if any(mark in lines[-1] for mark in UNFINISHED):
        return f"it was killed, or ran out of memory; its last words: {lines[-1]}"
    return lines[-1]


def _unwritten(folder: Path) -> str:
    """Return why a job's log in a folder is empty, as far as the disk tells it."""
    try:
        machine_resources.check(folder)
    except InputError as error:
        return f"its log could not be written: {error}"
    return f"its log is empty: it was killed, or disk or memory are full; {SPARE_MEMORY}"
