"""Files of a study that are out of date, and why, according to their sidecars."""

import os
import shlex
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from courtside.study.errors import InputError, StrPath, few
from courtside.study.execution import checksums, digest, files
from courtside.study.provenance import advice, environment, planned
from courtside.study.provenance.provenance import FORMAT, command
from courtside.study.provenance.run import in_folder

REPEATED = {"--directory", "--configfile", "--config"}  # options of a command that is repeated
OF_RUN = {"command": str, "config_files": dict}  # what a record must hold
OF_FILE = {
    "file": str, "sha256": str, "inputs": dict, "artefacts": dict, "code": dict, "packages": dict,
    "lock_sha256": str | None, "python": str, "rule": str, "settings": dict,
}  # fmt: skip
N_NAMED = 3  # settings in a line
OF_REPOSITORY = {"config", "workflow"}  # folders
DRAWN = {".pdf", ".png", ".csv"}  # in folders named figures: all have sidecars


def read(folder: StrPath) -> list[dict[str, Any]]:
    """Return all sidecars below a folder such as results/run, in the order of their names.

    An `InputError` if there is none, or one is not a sidecar of this version.
    """
    folder = Path(folder) / "provenance"
    paths = sorted(folder.rglob("*.json"))
    if not paths:
        raise InputError(
            f"{folder}: expected sidecars of results, found none; run snakemake in this folder "
            "first"
        )
    return [_read(path, OF_FILE) for path in paths]


def _read(path: Path, kinds: dict[str, Any]) -> dict[str, Any]:
    content = files.read_json(path, "delete it")
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise InputError(f"{path}: expected a sidecar of format {FORMAT}; delete it")
    for key, kind in kinds.items():
        if key not in content or not isinstance(content[key], kind):
            raise InputError(
                f"{path}: expected {key} in a sidecar, found {content.get(key)!r:.80}; delete it"
            )
    return content


def present(repository: StrPath, ran_in: StrPath = ".") -> dict[str, Any]:
    """Return the inputs, code and versions with which the study would be made now.

    sha256 (callable of a path, None for one that is not here; each file is read once), code
    (callable of the file name of a script, None for one that is gone), and what `environment.found`
    says. `ran_in` is the folder where the study ran, seen from the repository: files of the
    repository are found wherever the results are now.
    """
    workflow = Path(repository) / "workflow"

    @cache
    def sha256(path):
        place = Path(path) if Path(path).exists() else _in_repository(path, repository, ran_in)
        return checksums.of_path(place) if place.exists() else None

    @cache
    def code(script):
        path = workflow / "scripts" / script
        return digest.code_digest(path, workflow / "lib") if path.is_file() else None

    return {"sha256": sha256, "code": code, **environment.found(repository)}


def _in_repository(path: str, repository: StrPath, ran_in: StrPath) -> Path:
    """Return where a recorded file of the repository is now; of other files, the path itself."""
    inner = Path(os.path.normpath(Path(ran_in) / path))
    return Path(repository) / inner if inner.parts[0] in OF_REPOSITORY else Path(path)


def changes(sidecar: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """Return why a file would differ if made now (see `present`), one reason for each cause.

    Inputs that are not here are no reason (see `absent`).
    """
    there = now["sha256"](sidecar["file"])
    reasons = []
    if there != sidecar["sha256"]:
        reasons.append("missing" if there is None else "altered since it was made")
    for kind in ("inputs", "artefacts"):
        for path, recorded in sidecar[kind].items():
            found = now["sha256"](path)
            reasons += [] if found is None else _of_file(path, recorded, found)
    for script, recorded in sidecar["code"].items():
        found = now["code"](script)
        # What follows a hyphen is of the lock's packages, which have reasons of their own.
        if found is None or found != str(recorded).partition("-")[0]:
            reasons.append(f"code of {script} " + ("is gone" if found is None else "changed"))
    return reasons + _of_surroundings(sidecar, now)


def absent(sidecar: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """Return the inputs of a file that are not here, so that they cannot be compared."""
    recorded = {**sidecar["inputs"], **sidecar["artefacts"]}
    return [path for path, sha in recorded.items() if sha and now["sha256"](path) is None]


def _of_file(path: str, recorded: str | None, found: str | None) -> list[str]:
    if found == recorded:
        return []
    return [f"{path} is gone" if found is None else f"{path} changed"]


def _of_surroundings(sidecar: dict[str, Any], now: dict[str, Any]) -> list[str]:
    reasons = []
    if sidecar["lock_sha256"] != now["lock_sha256"]:
        reasons.append("environment.lock changed")
    names = sorted(set(sidecar["packages"]) | set(now["packages"]))
    for name in names:
        old, new = sidecar["packages"].get(name, "none"), now["packages"].get(name, "none")
        if old != new:
            reasons.append(f"package {name} {old} -> {new}")
    for key, word in (("python", "Python"), ("platform", "platform")):
        if sidecar.get(key) != now[key]:
            reasons.append(f"{word} {sidecar.get(key)} -> {now[key]}")
    return reasons


def _unrecorded(root: StrPath, sidecars: Iterable[dict[str, Any]]) -> list[str]:
    """Return the files in folders named figures below `root` that have no sidecar."""
    known = {Path(sidecar["file"]).resolve() for sidecar in sidecars}
    drawn = (p for p in Path(root).glob("**/figures/*") if p.suffix in DRAWN)
    return sorted(path.as_posix() for path in drawn if path.resolve() not in known)


def _planned(
    words: list[str], sidecars: Sequence[dict[str, Any]], repository: StrPath
) -> planned.Plan:
    """Return what a run's command would make, and of the other recorded files those it could."""
    try:
        plan = planned.ask(words, repository)
    except InputError as error:
        return planned.Plan({}, frozenset(), refused=f"{shlex.join(words)}: {error}")
    names = [sidecar["file"] for sidecar in sidecars]
    others = [name for name in names if name not in plan.settings and name not in plan.remains]
    apart = [name for name in others if Path(name).exists()]
    try:
        other = planned.ask(words, repository, apart) if apart else plan
    except InputError:  # of another study, or of nothing that still exists
        return plan
    settings, pending = other.settings | plan.settings, other.pending | plan.pending
    return replace(plan, settings=settings, pending=pending, by_name=frozenset(apart))


def _words(run: dict[str, Any]) -> list[str]:
    """Return the words of a record's command, if it is one of snakemake: results travel."""
    try:
        words = shlex.split(run["command"])
    except ValueError:
        words = []
    options = {word for word in words if word.startswith("-")}
    if words[:1] != ["snakemake"] or not options <= REPEATED:
        raise InputError(
            f"provenance.json: expected a command of snakemake with none but {sorted(REPEATED)}, "
            f"found {run['command']!r}; delete the record and run snakemake in this folder"
        )
    return words


def _folder(words: list[str]) -> str:
    """Return the folder where a run's command was given, seen from the repository."""
    return words[words.index("--directory") + 1] if "--directory" in words[:-1] else "."


def _here(words: list[str], repository: StrPath) -> list[str]:
    """Return the words of a run's command for the present folder: results travel."""
    at = words.index("--directory") if "--directory" in words else len(words)
    rest = words[:at] + words[at + 2 :]
    return [*rest[:1], *in_folder(repository), *rest[1:]]


def _settings(sidecar: dict[str, Any], plan: planned.Plan) -> dict[str, str]:
    """Return in words which settings would be others now, by rule."""
    now = plan.settings.get(sidecar["file"])
    found = {} if now is None else planned.changes(sidecar["settings"], now)
    return {
        rule: f"settings of {rule} changed ({few(keys, N_NAMED)})" for rule, keys in found.items()
    }


def _forcing(words: list[str], unnoticed: dict[str, set[str]], plan: planned.Plan) -> list[str]:
    """Return a line on settings that changed unseen by Snakemake: rules by file."""
    if not unnoticed:
        return []
    rules = sorted(set().union(*unnoticed.values()))
    apart = sorted(plan.by_name.intersection(unnoticed))
    targets = ["--", "all", *apart] if apart else []
    return [
        "Snakemake has no records of these settings (.snakemake/metadata), so it does not see that "
        "they changed; what rests on them is made anew by: "
        + shlex.join([*words, "--forcerun", *rules, *targets])
    ]


def report(folder: StrPath, root: StrPath, repository: StrPath) -> tuple[list[str], int, int]:
    """Return lines for people, the number of faults, and of files not compared in full.

    Faults are files that would differ, that have no record, or that the study no longer asks for.
    `folder` is such as results/run, `root` the folder of all results.
    """
    sidecars = read(folder)
    run = _read(Path(folder) / "provenance.json", OF_RUN)
    recorded = _words(run)
    words, now = _here(recorded, repository), present(repository, _folder(recorded))
    changed = [
        line
        for path, sha in run["config_files"].items()
        for line in _of_file(path, sha, now["sha256"](path))
    ]
    plan = _planned(words, sidecars, repository)
    asked_for = [sidecar for sidecar in sidecars if sidecar["file"] not in plan.remains]
    lines, causes = _of_all(asked_for, now, plan, words, bool(changed))
    lines += [
        f"{name}: has no record; remake it, or delete it if the study no longer names it: "
        + command(advice.making(name, words, run, sidecars, repository), name)
        for name in _unrecorded(root, sidecars)
        if name not in plan.remains
    ]
    n_faults = len(lines)
    told, n_unseen = _not_compared(asked_for, now, plan)
    lines += [*(f"since the last run, {line}" for line in changed), *causes, *told, *plan.advice]
    lines += _forgotten(sum(not Path(name).exists() for name in plan.remains))
    lines += [f"{len(asked_for)} files have a record: {_verdict(n_faults, n_unseen, plan)}"]
    n_faults += len(plan.advice) + bool(plan.refused and changed)
    return lines, n_faults, n_unseen


def _not_compared(
    sidecars: Sequence[dict[str, Any]], now: dict[str, Any], plan: planned.Plan
) -> tuple[list[str], int]:
    """Return lines on what cannot be compared, and of how many files."""
    missing = {sidecar["file"]: absent(sidecar, now) for sidecar in sidecars}
    names = sorted(set().union(*missing.values()))
    files = [name for name, paths in missing.items() if paths]
    lines = [f"settings are not compared: {plan.refused}"] * bool(plan.refused)
    if not plan.refused and (n := sum(s["file"] not in plan.settings for s in sidecars)):
        lines.append(f"{n} files are not of the last run's study: their settings are not compared")
    if names:
        lines.append(
            f"{len(names)} inputs of {len(files)} files are not here, so they cannot be compared: "
            f"{few(names, N_NAMED)}; bring them to this folder"
        )
    return lines, len(sidecars) if plan.refused else len(files)


def _verdict(n_faults: int, n_unseen: int, plan: planned.Plan) -> str:
    parts = [f"{n_faults} are missing, out of date or without a record"] if n_faults else []
    parts += [f"{n_unseen} cannot be compared in full"] if n_unseen else []
    n_left = sum(Path(name).exists() for name in plan.remains)
    text = ", ".join(parts) or "all are up to date"
    if n_unseen and not n_faults:
        text += ", the rest is up to date"
    left = f"; besides, {n_left or 'others'} that the study no longer asks for"
    return text + (left if plan.advice else "")


def _forgotten(n_deleted: int) -> list[str]:
    if not n_deleted:
        return []
    return [
        f"{n_deleted} files that the study no longer asks for were deleted: the next run that "
        "makes a file drops their records"
    ]


def _of_all(
    sidecars: Sequence[dict[str, Any]],
    now: dict[str, Any],
    plan: planned.Plan,
    words: list[str],
    is_configured_anew: bool,
) -> tuple[list[str], list[str]]:
    """Return a line for each file that would differ, and lines on what this comes from."""
    lines: list[str] = []
    causes: Counter[str] = Counter()
    unnoticed: dict[str, set[str]] = {}
    for sidecar in sidecars:
        name, rules = sidecar["file"], _settings(sidecar, plan)
        is_pending = name in plan.pending
        reasons = changes(sidecar, now) + list(rules.values())
        if not reasons and is_configured_anew and is_pending:
            reasons = ["configuration changed"]
        lines += [f"{name}: {'; '.join(reasons)}"] if reasons else []
        causes.update(reasons)
        if rules and not is_pending:
            unnoticed[name] = set(rules)
    told = [f"{n} files: {cause}" for cause, n in causes.most_common() if n > 1]
    return lines, told + _forcing(words, unnoticed, plan)
