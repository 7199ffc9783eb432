"""Copies of the repository to hurt, and running the tiny study in them."""

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import zipfile

from courtside.study.execution import artefacts
from courtside.study.provenance import comparison
from smoke.snakemake_runs import FOLDER, ROOT, TINY, copy_repository

EXTERNAL = [ROOT / folder / "results" / "external" for folder in (".", FOLDER)]
WRITTEN = {"results", ".snakemake", "__pycache__"}  # folders that a run may write to
TAKE = "results/walk-4cams-tiny/takes/balancing"
METHOD = "file/all-robust/blazepose-full"
SAME = {comparison.EQUAL, comparison.CLOSE, comparison.TIMES}
# A few jobs, one after the other and side by side, to which the smaller faults are done: rule to
# product.
JOBS = {
    "triangulate": f"{TAKE}/pose3d/{METHOD}.npz",
    "filter_motion": f"{TAKE}/pose3d_filtered/{METHOD}.npz",
    "export_take": f"{TAKE}/pose3d_filtered/{METHOD}.p1.trc",
    "draw_skeletons": f"{TAKE}/figures/skeletons.{METHOD.replace('/', '.')}.png",
    "draw_overlay": f"{TAKE}/figures/overlay.{METHOD.replace('/', '.')}.png",
}
CUT = [JOBS[rule] for rule in ("export_take", "draw_skeletons", "draw_overlay")]


def prepare_copy(root):
    """Copy what a study is made by; present pinned artefacts are packed into a mirror folder."""
    copy_repository(root)
    pack_mirror(root)


def pack_mirror(root):
    """Make a wheel of each artefact whose members are here, and pin that: nothing is fetched.

    Its jobs then do what they do with a wheel of the package registry, and can be killed at it.
    """
    pins = root / "config" / "external.yaml"
    text = pins.read_text(encoding="utf-8")
    (root / "mirror").mkdir()
    for artefact in artefacts.read(pins).values():
        folders = [folder / artefact.name for folder in EXTERNAL]
        whole = [f for f in folders if all((f / member).is_file() for member in artefact.members)]
        if not whole or not artefact.requirement:
            continue
        name, version = artefact.requirement.split("==")
        wheel = root / "mirror" / f"{name}-{version}-py3-none-any.whl"
        with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
            for member in artefact.members:
                archive.write(whole[0] / member, member)
        text = text.replace(artefact.sha256, sha256(wheel))
    pins.write_text(text, encoding="utf-8")
    tiny = root / TINY
    mirror = f"\nmirror_folder: {root / 'mirror'}\n"
    tiny.write_text(tiny.read_text(encoding="utf-8") + mirror, encoding="utf-8")


def copy_study(root, target):
    """Copy a repository with its finished study; its mirror folder is left where it is."""
    shutil.copytree(root, target, ignore=shutil.ignore_patterns("mirror", "locks"), symlinks=True)
    return target


def start(root, *options, cores=2):
    """Start the tiny study as its user does; return the process, which leads a group of its own."""
    command = [sys.executable, "-m", "snakemake", "--directory", str(FOLDER), "--configfile"]
    command += [str(TINY), "--cores", str(cores), *options]
    words = tempfile.TemporaryFile()  # noqa: SIM115 -- open as long as the run; not beside the study, whose disk may be full
    settings = {"cwd": root, "stdout": words, "stderr": subprocess.STDOUT}
    main = subprocess.Popen(command, start_new_session=True, **settings)
    main.words = words
    return main


def output(main):
    """Return what a process of `start` has said by now."""
    descriptor = main.words.fileno()
    content = os.pread(descriptor, os.fstat(descriptor).st_size, 0)
    return content.decode("utf-8", errors="replace")


def sha256(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def raw(root):
    """Return the checksum of every file that no run may write."""
    paths = (path for path in sorted(root.rglob("*")) if path.is_file())
    return {
        str(path.relative_to(root)): sha256(path)
        for path in paths
        if not WRITTEN.intersection(path.relative_to(root).parts)
    }


def differences(here, there):
    """Return verdicts on files that differ beyond stated tolerance, are missing or left over."""
    verdicts = comparison.compare(here / FOLDER / "results", there / FOLDER / "results")
    return [each for each in verdicts if each.outcome not in SAME]
