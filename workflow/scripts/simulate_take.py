"""Film one take of a virtual session: settings, a court and the virtual body -> recordings, clicks, truth."""

from pathlib import Path

from courtside.calibration.court import court
from courtside.exports import bvh
from courtside.study.execution import log
from virtualgym.body import makehuman
from virtualgym.session import session
from virtualgym.session import take as takes


def body_folder(files):
    """Return the folder of an artefact, of which these are the files of a body."""
    return next(above for above in Path(files[0]).parents if (above / makehuman.MESH).is_file())


def main(court_yaml, body_folder, folder, *, backdrops_npz, settings, take, threads):
    worn = takes.simulate_take(
        session.Settings(**settings),
        takes.TakeSettings(**take),
        court.read(court_yaml),
        body_folder,
        folder,
        backdrops_npz=backdrops_npz,
        threads=threads,
    )
    for name, posed in worn.items():
        bvh.write(Path(folder) / f"{name}.bvh", posed)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.court,
        body_folder(snakemake.input.body),
        Path(snakemake.output.truth).parent,
        backdrops_npz=next(iter(snakemake.input.backdrops), None),
        settings=snakemake.params.settings,
        take=snakemake.params.take,
        threads=snakemake.threads,
    )
