"""Fetch one pinned artefact: mirror folder or package registry -> its named members."""

from pathlib import Path

from courtside.study.execution import artefacts
from courtside.study.execution.script import run


def main(member_paths, *, external_yaml, artefact, mirror_folder):
    pinned = artefacts.read(external_yaml)[artefact]
    npm_lock = Path(external_yaml).with_name("npm.lock")
    outputs = dict(zip(pinned.members, member_paths, strict=True))
    artefacts.fetch(pinned, outputs, mirror_folder=mirror_folder, npm_lock=npm_lock)


if __name__ == "__main__":
    run(main, snakemake)
