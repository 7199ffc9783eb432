"""Estimate the empty picture of one fixed camera: the take itself -> temporal median."""

from courtside.study.execution.script import run
from courtside.video import reader, static_picture, walk_frames


def main(source, background_png, *, trim_s, n_frames):
    pictures = walk_frames.spread(source, n_frames, trim_s=trim_s)
    reader.write_png(background_png, static_picture.temporal_median(pictures))


if __name__ == "__main__":
    run(main, snakemake)
