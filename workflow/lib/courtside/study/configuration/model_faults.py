"""Faults in models.yaml and detectors.yaml that their schemas cannot detect."""

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from courtside.study.configuration import schemas
from courtside.study.configuration.sessions import DEFAULT_DETECTOR, ONE_STAGE
from courtside.study.configuration.yaml_files import Content
from courtside.study.execution.artefacts import Artefact

OPTIONS = {  # keys that mean something to a decoder of models.yaml
    "blazepose": ("flip_test",),
    "heatmaps": ("input", "flip_test", "cells", "refine"),
    "simcc": ("input", "flip_test", "split", "full_score"),
    "rtmo": ("input", "min_score", "min_height"),
    "yolo-pose": ("input", "min_score", "min_height"),
}
FINDERS = {  # and of detectors.yaml
    "blazepose": ("min_score",),
    "yolox": ("input", "person_class", "min_score", "min_height"),
    "end-to-end": ("input", "person_class", "min_score", "min_height"),
}
COMMON = ("decoder", "skeleton", "tracking", "detector", "landmarks", "network")
Artefacts = dict[str, Artefact] | None


def find(
    folder: Path, models: Content | None, detectors: Content | None, known: Artefacts
) -> Iterator[str]:
    """Yield the faults of all models and detectors.

    A register is None if its file has faults, and so are the artefacts `known`.
    """
    for name, entry in (detectors or {}).items():
        yield from _of_detector(folder, name, entry, known)
    for name, entry in (models or {}).items():
        yield from _of_model(folder, name, entry, detectors, known)


def _of_model(
    folder: Path, name: str, entry: Content, detectors: Content | None, known: Artefacts
) -> Iterator[str]:
    file = folder / "models.yaml"
    if not (folder / "skeletons" / f"{entry['skeleton']}.yaml").is_file():
        there = sorted(path.stem for path in (folder / "skeletons").glob("*.yaml"))
        yield f"{file}: {name}.skeleton: expected one of {there}, found {entry['skeleton']!r}"
    yield from _option_faults(f"{file}: {name}", entry, OPTIONS[entry["decoder"]])
    yield from _padding_faults(f"{file}: {name}.input", entry)
    yield from _network_faults(f"{file}: {name}.landmarks", entry["landmarks"], known)
    wanted = entry.get("detector", DEFAULT_DETECTOR)
    if entry["decoder"] in ONE_STAGE:
        if "detector" in entry:
            yield f"{file}: {name}.detector: expected none, for it finds persons itself; remove it"
    elif detectors is not None and wanted not in detectors:
        yield (
            f"{file}: {name}.detector: expected one of {sorted(detectors)} (detectors.yaml), found "
            f"{wanted!r}"
        )


def _of_detector(folder: Path, name: str, entry: Content, known: Artefacts) -> Iterator[str]:
    where = f"{folder / 'detectors.yaml'}: {name}"
    yield from _option_faults(where, entry, FINDERS[entry["decoder"]])
    yield from _network_faults(f"{where}.network", entry["network"], known)


def absent(
    folder: Path, root: Path, models: Content | None, detectors: Content | None, used: Iterable[str]
) -> Iterator[str]:
    """Yield a line for each file of a network that is used and not there; paths start at `root`."""
    lines = {}
    for name in used:
        entry = (models or {}).get(name, {})
        parts = {f"{folder / 'models.yaml'}: {name}.landmarks": entry.get("landmarks", {})}
        finder = entry.get("detector", DEFAULT_DETECTOR)
        network = (detectors or {}).get(finder, {}).get("network", {})
        parts[f"{folder / 'detectors.yaml'}: {finder}.network"] = network
        for where, network in parts.items():
            if "file" in network and not (root / network["file"]).is_file():
                lines[where] = (
                    f"{where}.file: expected an ONNX file, found none at {network['file']}; put it "
                    "there or correct the path"
                )
    yield from lines.values()


def _option_faults(where: str, entry: Content, wanted: Iterable[str]) -> Iterator[str]:
    decoder = entry["decoder"]
    for key in entry:
        if key not in (*wanted, *COMMON):
            yield f"{where}.{key}: expected none with the decoder {decoder}; remove it"
    if "input" in wanted and "input" not in entry:
        yield f"{where}.input: expected with the decoder {decoder}, found none; add it"


def _padding_faults(where: str, entry: Content) -> Iterator[str]:
    given = entry.get("input", {})
    if entry["decoder"] in ONE_STAGE and "padding" in given:
        yield f"{where}: expected no `padding` of a one-stage network; remove it"
    square = not given or given["size"][0] == given["size"][1]
    if entry["decoder"] not in ONE_STAGE and not square and "padding" not in given:
        yield (
            f"{where}: expected `padding` of crops that are not square, found size "
            f"{given['size']} without it; add `padding: 1.25`, or what it was trained with"
        )


def _network_faults(where: str, network: dict[str, Any], known: Artefacts) -> Iterator[str]:
    if known is None or "file" in network:
        return
    artefact, member = network["artefact"], network["member"]
    members = known[artefact].members if artefact in known else {}
    if members.get(member) != network["sha256"]:
        yield (
            f"{where}: expected a member of external.yaml with its checksum, "
            f"found {schemas.shortened(artefact)}: {schemas.shortened(member)}"
        )
