"""Match the images of a session, each pair once: features -> COLMAP database with two-view geometries."""

import pandas as pd

from courtside.records import tables
from courtside.sfm import grid, matching
from courtside.study.execution import log


def main(features_db, features_csv, frames_csv, matches_db, table_csv, **options):
    walks = grid.read(frames_csv)
    images = pd.read_csv(features_csv)
    fixed = images["name"][~images["source"].isin(list(frames_csv))].tolist()
    found = matching.match(features_db, matches_db, walks.pairs(fixed), **options)
    table = pd.DataFrame(
        [(*pair, n) for pair, n in found.items()], columns=["name_a", "name_b", "n_matches"]
    )
    log.logger.info(
        "pairs with a two-view geometry: %d of %d", (table.n_matches > 0).sum(), len(table)
    )
    tables.write(table_csv, table)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.features,
        snakemake.input.table,
        dict(zip(snakemake.params.walks, snakemake.input.frames, strict=True)),
        snakemake.output.database,
        snakemake.output.table,
        **snakemake.params.step,
    )
