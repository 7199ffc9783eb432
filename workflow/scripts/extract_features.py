"""Extract the features of all images of a session: static pictures and walks -> COLMAP database."""

from pathlib import Path

import pandas as pd

from courtside.records import tables
from courtside.sfm import features, grid
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(static_png, frames_csv, features_db, table_csv, *, cameras, walks, threads, **options):
    root = Path(features_db).parents[1]
    frames = grid.read(dict(zip(walks, frames_csv, strict=True)))
    groups = [
        features.Group(camera, (Path(path).relative_to(root).as_posix(),))
        for camera, path in zip(cameras, static_png, strict=True)
    ]
    groups += [features.Group(walk, frames.of_walk(walk)) for walk in walks]
    counts, guessed = features.extract(features_db, root, groups, threads=threads, **options)
    for group in guessed:
        guess = f"{options['focal_factor']:g} of its pictures' longer side"
        log.logger.info("%s: focal length not known, first guess %s", group, guess)
    table = pd.DataFrame(
        [(g.name, name, counts[name]) for g in groups for name in g.images],
        columns=["source", "name", "n_features"],
    )
    tables.write(table_csv, table)


if __name__ == "__main__":
    run(main, snakemake)
