"""Extract the frames of one walk on a fixed grid: video or photos -> PNG files and their table."""

from pathlib import Path

from courtside.records.cameras import frame_table
from courtside.sfm import usable
from courtside.study.errors import InputError
from courtside.study.execution import log
from courtside.study.execution.files import atomic_folder
from courtside.study.execution.script import run
from courtside.video import walk_frames


def main(video_path, folder, table_csv, *, every_s=None, every_frame=None):
    walk = Path(table_csv).stem
    with atomic_folder(folder) as beside:
        found = walk_frames.frames(video_path, every_s=every_s, every_frame=every_frame)
        shown = log.progress(found, None, f"{walk}: frames")
        photos = walk_frames.photo_paths(video_path)
        table, small = walk_frames.extract(shown, beside, photos)
        kept, reason = usable.judge(table, small, photos=bool(photos))
        if not kept.any():
            raise InputError(
                f"{video_path}: expected frames that show the hall, found all {len(table)} "
                f"{' or '.join(sorted(set(reason)))}; film the walk again, slowly and in light"
            )
        table = table.assign(kept=kept, reason=reason)
        frame_table.write(table_csv, table)
    for reason, count in table["reason"].value_counts().items():
        log.logger.info("%s: %d of %d frames %s", walk, count, len(table), reason or "kept")


if __name__ == "__main__":
    run(main, snakemake)
