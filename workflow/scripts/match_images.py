"""Match a session's images, each pair once.

Reads features; writes a COLMAP database with two-view geometries.
"""

import pandas as pd

from courtside.records import tables
from courtside.sfm import grid, matching
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(features_db, features_csv, frames_csv, matches_db, table_csv, *, walks, **options):
    frames = grid.read(dict(zip(walks, frames_csv, strict=True)))
    fixed = grid.fixed(features_csv, walks)
    found = matching.match(features_db, matches_db, frames.pairs(fixed), **options)
    table = pd.DataFrame(
        [(*pair, n) for pair, n in found.items()], columns=["name_a", "name_b", "n_matches"]
    )
    log.logger.info(
        "pairs with a two-view geometry: %d of %d", (table.n_matches > 0).sum(), len(table)
    )
    tables.write(table_csv, table)


if __name__ == "__main__":
    run(main, snakemake)
