"""Extract the features of all images of a session: static pictures and walks -> COLMAP database."""

from pathlib import Path

import pandas as pd

from courtside.records import tables
from courtside.sfm import features, grid
from courtside.study.execution import log


def main(static_png, frames_csv, features_db, table_csv, *, threads, **options):
    root = Path(features_db).parents[1]
    walks = grid.read(frames_csv)
    groups = [
        features.Group(camera, (str(Path(path).relative_to(root)),))
        for camera, path in static_png.items()
    ]
    groups += [features.Group(walk, walks.of_walk(walk)) for walk in frames_csv]
    counts, guessed = features.extract(features_db, root, groups, threads=threads, **options)
    for group in guessed:
        guess = f"{options['focal_factor']:g} picture widths"
        log.logger.info("%s: no focal length in its pictures, first guess %s", group, guess)
    table = pd.DataFrame(
        [(g.name, name, counts[name]) for g in groups for name in g.images],
        columns=["source", "name", "n_features"],
    )
    tables.write(table_csv, table)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        dict(zip(snakemake.params.cameras, snakemake.input.static, strict=True)),
        dict(zip(snakemake.params.walks, snakemake.input.frames, strict=True)),
        snakemake.output.database,
        snakemake.output.table,
        threads=snakemake.threads,
        **snakemake.params.step,
    )
