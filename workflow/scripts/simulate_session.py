"""Film one virtual session: its settings and a court -> videos, clicked court points, truth."""

from pathlib import Path

from courtside.calibration.court import court
from courtside.study.errors import InputError
from courtside.study.execution import log
from virtualgym.cameras import layouts
from virtualgym.session import session


def main(court_yaml, folder, *, backdrops_npz, settings, names, threads):
    walks = [session.WALK] if settings["walk_frames"] else []
    expected = [*layouts.LAYOUTS[settings["layout"]], *walks]
    if sorted(names) != sorted(expected):
        raise InputError(
            f"session {Path(folder).name}: expected the cameras (and walk) of layout {settings['layout']}, "
            f"{expected}, found {names}; rename them"
        )
    session.simulate(
        session.Settings(**settings),
        court.read(court_yaml),
        folder,
        backdrops_npz=backdrops_npz,
        threads=threads,
    )


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.court,
        Path(snakemake.output.truth).parent,
        backdrops_npz=next(iter(snakemake.output.backdrops), None),
        settings=snakemake.params.settings,
        names=snakemake.params.names,
        threads=snakemake.threads,
    )
