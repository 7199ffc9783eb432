"""Open a project of `exports/pose2sim.py` with Pose2Sim, triangulate it, compare with our TRC file.

Run by hand, never by pytest, in the environment that `python benchmarks/peers.py pose2sim` makes
and prints:

    PYTHON tests/unit/exports/open_by_pose2sim.py PROJECT

Works on a copy. Prints, over all markers that Pose2Sim has, how far its points are from ours, mm.
"""

import os
import shutil
import sys
import tempfile
import tomllib
from pathlib import Path

import numpy as np


def read(path):
    """Return markers and their points (T, J, 3) m by Pose2Sim's own reader."""
    from Pose2Sim.common import read_trc

    table, _, _, markers, _ = read_trc(path)
    return markers, table.to_numpy(float).reshape(len(table), -1, 3)


def main(project):
    """Triangulate a copy of the project and print the comparison."""
    from Pose2Sim import triangulation

    with tempfile.TemporaryDirectory() as home:
        copy = Path(home) / "peer"
        shutil.copytree(project, copy)
        ours = {path.stem: read(path) for path in (copy / "pose-3d").glob("*.trc")}
        os.chdir(copy)
        settings = tomllib.loads(Path("Config.toml").read_text())
        settings["project"]["project_dir"] = str(copy)
        triangulation.triangulate_all(settings)
        for path in sorted((copy / "pose-3d").glob("peer_*.trc")):
            markers, found = read(path)
            for name, (mine, points) in ours.items():
                mine = [marker.lower() for marker in mine]
                same = points[:, [mine.index(marker.lower()) for marker in markers]]
                off = 1000 * np.linalg.norm(found - same[: len(found)], axis=-1)
                print(path.stem, name, len(markers), "markers:", end=" ")
                print(f"median {np.nanmedian(off):.3f} mm, 95 % {np.nanquantile(off, 0.95):.3f} mm")


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
