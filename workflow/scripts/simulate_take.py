"""Film one take of a virtual session.

Reads settings, a court and the virtual body; writes recordings, clicks and truth.
"""

from pathlib import Path

from courtside.calibration.court import court
from courtside.exports import bvh
from courtside.study.errors import reading
from courtside.study.execution.script import run
from virtualgym.body import makehuman
from virtualgym.session import session
from virtualgym.session import take as takes


def body_folder(files):
    """Return the folder of an artefact, of which these are the files of a body."""
    return next(above for above in Path(files[0]).parents if (above / makehuman.MESH).is_file())


def main(court_yaml, body_files, truth_npz, backdrops_npz=(), *, settings, take, threads):
    folder = Path(truth_npz).parent
    with reading(folder, *takes.FITTING, kinds=(ValueError, TypeError)):
        of_session, of_take = session.Settings(**settings), takes.TakeSettings(**take)
    worn = takes.simulate_take(
        of_session,
        of_take,
        court.read(court_yaml),
        body_folder(body_files),
        folder,
        backdrops_npz=next(iter(backdrops_npz), None),
        threads=threads,
    )
    for name, posed in worn.items():
        bvh.write(folder / f"{name}.bvh", posed)


if __name__ == "__main__":
    run(main, snakemake)
