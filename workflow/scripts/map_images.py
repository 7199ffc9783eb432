"""Map a session's fixed cameras with N bridging images: matches -> COLMAP model."""

from pathlib import Path

from courtside.sfm import grid, mapping, registration
from courtside.study.execution import log
from courtside.study.execution.files import write_json
from courtside.study.execution.script import run


def main(
    matches_db,
    features_csv,
    frames_csv,
    summary_json,
    *,
    walks,
    mapper,
    n_images,
    offset,
    rule,
    **options,
):
    frames = grid.read(dict(zip(walks, frames_csv, strict=True)))
    fixed = grid.fixed(features_csv, walks)
    chosen = frames.choose(int(n_images), int(offset), rule)
    folder = Path(summary_json).parent
    summary = mapping.map_images(matches_db, fixed + chosen, folder, mapper=mapper, **options)
    summary["bridging_images"] = chosen
    unregistered, unmatched = summary.pop("unregistered"), summary.pop("unmatched")
    log.logger.info("registered %(n_registered)d of %(n_images)d images", summary)
    for line in registration.lost(unregistered, unmatched, frames.called):
        log.logger.warning("%s", line)
    own_names = frames.own_names()
    summary["unregistered"] = {name: own_names.get(name, "") for name in unregistered}
    write_json(summary_json, summary)


if __name__ == "__main__":
    run(main, snakemake)
