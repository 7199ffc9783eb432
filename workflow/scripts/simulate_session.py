"""Film one virtual session: its settings and a court -> videos, clicked court points, truth."""

from pathlib import Path

from courtside.calibration.court import court
from courtside.study.errors import InputError
from courtside.study.execution.script import run
from virtualgym.cameras import layouts
from virtualgym.session import session


def main(court_yaml, truth_npz, backdrops_npz=(), *, settings, names, threads):
    folder = Path(truth_npz).parent
    walks = [session.WALK] if settings["walk_frames"] else []
    expected = [*layouts.LAYOUTS[settings["layout"]], *walks]
    if sorted(names) != sorted(expected):
        raise InputError(
            f"session {folder.name}: expected the cameras (and walk) of layout "
            f"{settings['layout']}, {expected}, found {names}; rename them"
        )
    session.simulate(
        session.Settings(**settings),
        court.read(court_yaml),
        folder,
        backdrops_npz=next(iter(backdrops_npz), None),
        threads=threads,
    )


if __name__ == "__main__":
    run(main, snakemake)
