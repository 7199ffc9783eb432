"""Software bill of materials (CycloneDX 1.6): packages of the lock, pinned artefacts."""

import re
from collections.abc import Iterable
from importlib import metadata
from pathlib import Path
from typing import Any

from courtside.study.errors import InputError
from courtside.study.execution.artefacts import Artefact

# A package of a lock: `name[extra]==version ; marker \` and the lines of its hashes.
PACKAGE = re.compile(
    r"^(?P<name>[A-Za-z0-9._-]+)(?:\[[^]]*\])?==(?P<version>[^\s;\\]+)"
    r"(?: *; *(?P<marker>[^\\\n]+?))? *\\?\n"
    r"(?P<hashes>(?: +--hash=sha256:[0-9a-f]{64} *\\?\n)*)",
    re.M,
)
# What names a licence, and is neither its text nor a copyright.
LICENCE_NAME = re.compile(r"(?!Copyright)[^\n]{2,60}")
SPDX = re.compile(r"[A-Za-z0-9.+-]+(?: (?:AND|OR|WITH) [A-Za-z0-9.+-]+)*")


def of_study(
    lock_text: str, artefacts: Iterable[Artefact], *, name: str, version: str, licence: str
) -> dict[str, Any]:
    """Return the parts of a study as JSON of CycloneDX 1.6.

    Without date and serial number: the same parts give the same bytes. A package has the checksums
    of all files that the lock allows, one for each platform. Its licence is what the installed
    package of this version says; a package for other platforms has none. `name`, `version` and
    `licence` are of the study itself. An `InputError` if a requirement of the lock is not pinned
    with hashes.
    """
    study = {"type": "application", "name": name, "version": version, **_licences(licence)}
    parts = [*packages(lock_text), *map(_artefact, artefacts)]
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "version": 1,
        "metadata": {"component": {**study, "bom-ref": name}},
        "components": sorted(parts, key=lambda part: part["bom-ref"]),
    }


def packages(lock_text: str) -> list[dict[str, Any]]:
    """Return the components of all packages of a lock."""
    found = [_package(match) for match in PACKAGE.finditer(lock_text)]
    n_named = len(re.findall(r"^[^\s#]", lock_text, re.M))
    if n_named != len(found) or not all(part["hashes"] for part in found):
        raise InputError(
            f"environment.lock: expected hashes for each of {n_named} requirements, found them for "
            f"{sum(bool(part['hashes']) for part in found)}; compile it with --generate-hashes"
        )
    return found


def _package(match: re.Match[str]) -> dict[str, Any]:
    name, version = match["name"], match["version"]
    part = {
        "type": "library",
        "bom-ref": f"pkg:pypi/{name.lower()}@{version}",
        "name": name,
        "version": version,
        "purl": f"pkg:pypi/{name.lower()}@{version}",
        "hashes": _hashes(re.findall(r"sha256:([0-9a-f]{64})", match["hashes"])),
        **_licences(installed_licence(name, version)),
    }
    if match["marker"]:
        part["properties"] = [{"name": "marker", "value": match["marker"].strip()}]
    return part


def installed_licence(name: str, version: str) -> str | None:
    """Return the licence that an installed package states; None without this version of it."""
    try:
        about: Any = metadata.metadata(name)  # a Message, though its type does not say so
    except metadata.PackageNotFoundError:
        return None
    if about["Version"] != version:
        return None
    classified = [c.split(" :: ")[-1] for c in about.get_all("Classifier", []) if "License" in c]
    titles = [about.get("License") or "", *_titles_of_licence_files(name)]
    named = [line.strip() for line in titles if LICENCE_NAME.fullmatch(line.strip())]
    return about.get("License-Expression") or next(iter([*classified, *named]), None)


def _titles_of_licence_files(name: str) -> list[str]:
    """Return the first lines of a package's licence files."""
    found = (file for file in metadata.files(name) or () if file.name.startswith("LICEN"))
    texts = (Path(str(file.locate())) for file in found)
    return [
        path.read_text(encoding="utf-8").strip().split("\n")[0] for path in texts if path.is_file()
    ]


def _artefact(artefact: Artefact) -> dict[str, Any]:
    name, version, purl = _registered(artefact)
    part = {"type": "data", "bom-ref": f"artefact:{artefact.name}", "name": name}
    part |= {"version": version, "purl": purl} if version else {}
    part |= {"description": artefact.note} if artefact.note else {}
    members = [
        {"type": "file", "bom-ref": f"artefact:{artefact.name}/{member}", "name": member}
        | {"hashes": _hashes([sha256])}
        for member, sha256 in sorted(artefact.members.items())
    ]
    own = {"hashes": _hashes([artefact.sha256]), **_licences(artefact.licence)}
    return {**part, **own, "components": members}


def _registered(artefact: Artefact) -> tuple[str, str, str]:
    """Return name, version and package URL of an artefact; the name alone if no registry has it."""
    if artefact.package:
        name, _, version = artefact.package.rpartition("@")
        return name, version, f"pkg:npm/{name.replace('@', '%40')}@{version}"
    name, _, version = (artefact.requirement or artefact.name).partition("==")
    return name, version, f"pkg:pypi/{name}@{version}"


def _hashes(checksums: Iterable[str]) -> list[dict[str, str]]:
    return [{"alg": "SHA-256", "content": checksum} for checksum in checksums]


def _licences(stated: str | None) -> dict[str, Any]:
    if not stated:
        return {}
    return {
        "licenses": [
            {"expression": stated} if SPDX.fullmatch(stated) else {"license": {"name": stated}}
        ]
    }
