"""Map a session's fixed cameras with N bridging images: matches -> COLMAP model."""

from pathlib import Path

import pandas as pd

from courtside.sfm import grid, mapping
from courtside.study.execution import log
from courtside.study.execution.files import write_json


def main(
    matches_db, features_csv, frames_csv, folder, summary_json, *, n_images, offset, rule, **options
):
    walks = grid.read(frames_csv)
    images = pd.read_csv(features_csv)
    fixed = images["name"][~images["source"].isin(list(frames_csv))].tolist()
    chosen = walks.choose(n_images, offset, rule)
    summary = mapping.map_images(matches_db, fixed + chosen, folder, **options)
    summary["bridging_images"] = chosen
    log.logger.info("registered %(n_registered)d of %(n_images)d images", summary)
    write_json(summary_json, summary)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.matches,
        snakemake.input.table,
        dict(zip(snakemake.params.walks, snakemake.input.frames, strict=True)),
        Path(snakemake.output.summary).parent,
        snakemake.output.summary,
        mapper=snakemake.wildcards.mapper,
        n_images=int(snakemake.wildcards.n_images),
        offset=int(snakemake.wildcards.offset),
        **snakemake.params.step,
    )
