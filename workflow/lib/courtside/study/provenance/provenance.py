"""Provenance of each figure, table and exported file: one JSON file (sidecar) for each.

A job is a dictionary: rule, script (its file name or None), code (digest of the script and of the
library code that it reaches, or None), inputs and outputs (paths), params (without the digest),
done (its outputs are up to date), made (in this run), known (Snakemake has records of what it was
made with, and nothing changed since; true where it is left out).
"""

import graphlib
import json
import shlex
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from courtside.study import paths
from courtside.study.errors import InputError, StrPath
from courtside.study.execution import checksums, files

FORMAT = 1
# Of files that people or other programs read.
FINAL = {".pdf", ".png", ".csv", ".html", ".trc", ".c3d", ".bvh", ".glb", ".txt", ".mp4"}
FINAL |= {".mot", ".osim"}
Job = Mapping[str, Any]


def record(
    jobs: Sequence[Job],
    folder: StrPath,
    *,
    run: dict[str, Any],
    root: StrPath,
    pinned: Sequence[str] = (),
    targets: Collection[str] = (),
    changed: Iterable[str] = (),
) -> list[str]:
    """Write the sidecars of all final files that are newer than theirs, and the record of the run.

    A file that was not made again keeps its sidecar, which states what the file was made of, not
    what it would be made of now. Returns the files that got a new sidecar.

    `jobs` are all that the study asked for, in the form above; `folder` is that of the records
    (`provenance.json`, `checksums.json`, `provenance/<file>.json`), `root` that of all results,
    below which sidecars are named. `run` is what is the same for all files: `command` (list of
    words, without the file), `surroundings`, `config`, `config_files` (paths). `pinned` are starts
    of paths of artefacts and networks, which are given with checksum though a job made them.
    `targets` were asked for by name: they are final whatever their kind. `changed` are inputs that
    changed while jobs ran: sidecars have no checksum of them.
    """
    folder = Path(folder)
    known = checksums.Checksums(folder / Path(paths.CHECKSUMS).name)
    known.doubt(changed)
    due = []
    for job in jobs:
        names = [name for name in job["outputs"] if _is_final(name, targets, folder, root)]
        due.append([n for n in names if job["done"] and _is_due(n, job, sidecar(folder, n, root))])
    reach = upstream(jobs)
    written = []
    for at, names in enumerate(due):
        if not names:
            continue
        body = {**origin(jobs, reach[at], known.of, pinned), **run["surroundings"]}
        for name in names:
            files.write_json(sidecar(folder, name, root), _sidecar(jobs[at], name, run, body))
            written.append(name)
    _prune(folder, root)
    files.write_json(folder / "provenance.json", _of_run(run, known))
    for name, made_ns in _last_made(jobs).items():
        known.use(name, made_ns)
    known.write()
    return written


def sidecar(folder: StrPath, name: str, root: StrPath) -> Path:
    """Return the path of a file's sidecar below the folder of the records."""
    path = Path(name)
    inner = path.relative_to(root) if path.is_relative_to(root) else Path(path.name)
    return Path(folder) / "provenance" / inner.with_name(f"{inner.name}.json")


def recorded(folder: StrPath, root: StrPath) -> list[str]:
    """Return the files that have a sidecar, here or not."""
    own = Path(folder) / "provenance"
    inner = sorted(path.relative_to(own) for path in own.rglob("*.json"))
    return [(Path(root) / p.with_name(p.name.removesuffix(".json"))).as_posix() for p in inner]


def _is_final(name: str, targets: Collection[str], folder: StrPath, root: StrPath) -> bool:
    if Path(name).suffix in FINAL or name in targets:
        return True
    return sidecar(folder, name, root).exists()


def _is_due(name: str, job: Job, record_of_it: Path) -> bool:
    """Tell whether a file exists and has no sidecar that is younger than itself.

    A copy has a date of its own: the sidecar stays if it is of the same content, unless Snakemake
    knows that the file was made as it would be now.
    """
    path = Path(name)
    if not path.exists():
        return False
    if job["made"] or not record_of_it.exists():
        return True
    if _made_ns(path) <= record_of_it.stat().st_mtime_ns:
        return False
    return job.get("known", True) or not _is_of(record_of_it, path)


def _made_ns(path: Path) -> int:
    """Return the date of a file; of a folder, that of Snakemake's time stamp in it."""
    stamp = path / ".snakemake_timestamp" if path.is_dir() else path
    return (stamp if stamp.exists() else path).stat().st_mtime_ns


def _last_made(jobs: Sequence[Job]) -> dict[str, int]:
    """Return {input: date of the newest file, ns, that a job has made from it}."""
    made = {name for job in jobs for name in job["outputs"]}
    found: dict[str, int] = {}
    for job in (job for job in jobs if job["done"]):
        names = [name for name in job["inputs"] if name not in made]
        outputs = [path for path in map(Path, job["outputs"]) if path.exists()] if names else []
        last_ns = max(map(_made_ns, outputs), default=0)
        found |= {name: max(last_ns, found.get(name, 0)) for name in names}
    return found


def _is_of(record_of_it: Path, path: Path) -> bool:
    """Tell whether a sidecar is of a file's present content."""
    try:
        content = files.read_json(record_of_it, "delete it")
    except InputError:  # damaged: it is written anew
        return False
    return isinstance(content, dict) and content.get("sha256") == checksums.of_path(path)


def upstream(jobs: Sequence[Job]) -> list[frozenset[int]]:
    """Return, for each job, the indices of itself and of all jobs that it rests on.

    A `ValueError` if two jobs make one file, or jobs depend on one another in a circle.
    """
    maker = _makers(jobs)
    before = {
        at: {maker[name] for name in job["inputs"] if maker.get(name, at) != at}
        for at, job in enumerate(jobs)
    }
    found: dict[int, frozenset[int]] = {}
    try:
        for at in graphlib.TopologicalSorter(before).static_order():
            found[at] = frozenset({at}).union(*(found[other] for other in before[at]))
    except graphlib.CycleError as error:
        rule = jobs[error.args[1][0]]["rule"]
        raise ValueError(f"jobs depend on one another in a circle: {rule}") from None
    return [found[at] for at in range(len(jobs))]


def _makers(jobs: Sequence[Job]) -> dict[str, int]:
    """Return {file: index of the job that makes it}."""
    maker: dict[str, int] = {}
    for at, job in enumerate(jobs):
        for name in job["outputs"]:
            if maker.setdefault(name, at) != at:
                raise ValueError(f"two jobs make {name}")
    return maker


def origin(
    jobs: Sequence[Job],
    reached: Iterable[int],
    sha256_of: Callable[[str], str | None],
    pinned: Sequence[str] = (),
) -> dict[str, Any]:
    """Return what a job's files rest on.

    `reached` are the job and all that it rests on, of `upstream`; `sha256_of` gives the checksum of
    a path, None for one that is gone or in doubt; `pinned` is as of `record`. The result has inputs
    and artefacts {path: sha256}, settings {rule: [params of its jobs, each once]}, seeds {name:
    [values]}, code {script: digest}.
    """
    upstream_jobs = [jobs[at] for at in sorted(reached)]
    made = {name for job in upstream_jobs for name in job["outputs"]}
    used = {name for job in upstream_jobs for name in job["inputs"]}
    kept = {name for name in used & made if name.startswith(tuple(pinned))}
    of_rules = settings(upstream_jobs)
    seeds: dict[str, list] = {}
    for rule, each in of_rules.items():
        for name, value in _seeds(each, rule):
            values = seeds.setdefault(name, [])
            values += [value] * (value not in values)
    return {
        "inputs": {name: sha256_of(name) for name in sorted(used - made)},
        "artefacts": {name: sha256_of(name) for name in sorted(kept)},
        "settings": of_rules,
        "seeds": {name: sorted(values, key=str) for name, values in sorted(seeds.items())},
        "code": dict(sorted((job["script"], job["code"]) for job in upstream_jobs if job["code"])),
    }


def settings(jobs: Iterable[Job]) -> dict[str, list]:
    """Return {rule: params of its jobs, each once, as JSON can hold them}."""
    found: dict[str, dict] = {}
    for job in jobs:
        if params := plain(job["params"]):
            found.setdefault(job["rule"], {})[json.dumps(params, sort_keys=True)] = params
    return {rule: [each[text] for text in sorted(each)] for rule, each in sorted(found.items())}


def _seeds(value: Any, where: str) -> Iterator[tuple[str, Any]]:
    """Yield (name, value) of every number that is called a seed, at any depth."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if (key == "seed" or key.endswith("_seed")) and not isinstance(inner, dict):
                yield f"{where}.{key}", inner
            else:
                yield from _seeds(inner, f"{where}.{key}")
    elif isinstance(value, list):
        for inner in value:
            yield from _seeds(inner, where)


def plain(value: Any) -> Any:
    """Return a value as JSON can hold it: paths as text, an unknown object as its type."""
    if value is None or isinstance(value, bool | int | float):
        return value
    if isinstance(value, StrPath):
        return str(value)
    if isinstance(value, Mapping):
        return {str(key): plain(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [plain(inner) for inner in value]
    return f"a {type(value).__name__}"


def command(words: Iterable[str], name: str) -> str:
    """Return the command that makes one file again, to be given in the repository's folder."""
    return shlex.join([*words, "--", str(name)])


def _sidecar(job: Job, name: str, run: dict[str, Any], body: dict[str, Any]) -> dict[str, Any]:
    return {
        "format": FORMAT,
        "file": name,
        "sha256": checksums.of_path(name),
        "rule": job["rule"],
        "command": command(run["command"], name),
        "recorded": "when it was made" if job["made"] else "after it was made, by a later run",
        **body,
    }


def _of_run(run: dict[str, Any], known: checksums.Checksums) -> dict[str, Any]:
    config_files = {str(path): known.of(path) for path in run["config_files"]}
    return {
        "format": FORMAT,
        "command": shlex.join(run["command"]),
        "config_files": config_files,
        "config": plain(run["config"]),
        **run["surroundings"],
    }


def _prune(folder: Path, root: StrPath) -> None:
    """Delete the sidecars of files that are gone."""
    for name in recorded(folder, root):
        if not Path(name).exists():
            sidecar(folder, name, root).unlink()
