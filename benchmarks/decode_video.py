"""Decode videos with OpenCV, PyAV and the study's reader: frames per second, and what differs.

    python benchmarks/decode_video.py VIDEO... [--repeats 5]

One run decodes every file in turn with each reader and repeats that, so that a busy moment of the
machine hits all readers alike; the best time of each counts. Run it on an otherwise idle machine.
"""

import argparse
import sys
import time
from pathlib import Path

import av
import cv2
import numpy as np
from av.video.reformatter import Interpolation, VideoReformatter

from repository import ROOT

sys.path.insert(0, str(ROOT / "workflow" / "lib"))
from courtside.video import reader


def opencv(path, threads):
    options = [cv2.CAP_PROP_N_THREADS, threads] if threads else []
    capture = cv2.VideoCapture(str(path), cv2.CAP_FFMPEG, options)
    while True:
        found, image = capture.read()
        if not found:
            return
        yield image


def pyav(path, threads):
    reformatter = VideoReformatter()
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        stream.codec_context.thread_type = "AUTO"
        stream.codec_context.thread_count = threads
        for frame in container.decode(stream):
            picture = reformatter.reformat(
                frame, format="bgr24", interpolation=Interpolation.BICUBIC, threads=threads
            )
            yield picture.to_ndarray()


READERS = {
    "cv2, 1 thread": lambda path: opencv(path, 1),
    "av, 1 thread": lambda path: pyav(path, 1),
    "courtside": lambda path: (image for _, image in reader.frames(path)),
    "cv2, default": lambda path: opencv(path, 0),
    "av, default": lambda path: pyav(path, 0),
    "list only": reader.frame_times,
}


def seconds(read, path):
    start = time.process_time()
    count = 0
    for _image in read(path):  # kept until the next, as a script keeps it
        count += 1
    return time.process_time() - start, count


def largest_difference(path):
    pairs = zip(opencv(path, 1), (image for _, image in reader.frames(path)), strict=True)
    return max(int(np.abs(a.astype(np.int16) - b).max()) for a, b in pairs)


def main(paths, repeats):
    print(
        f"{'frames per second':24s}"
        + "".join(f"{name:>15s}" for name in READERS)
        + "   ratio   max diff"
    )
    for path in paths:
        best = dict.fromkeys(READERS, np.inf)
        for _ in range(repeats):
            for name, read in READERS.items():
                took_s, count = seconds(read, path)
                best[name] = min(best[name], took_s)
        row = "".join(f"{count / best[name]:15.0f}" for name in READERS)
        ratio = best["cv2, 1 thread"] / best["courtside"]
        print(f"{path.name:24s}{row}{ratio:8.2f}{largest_difference(path):11d}", flush=True)
    print(
        "ratio: courtside's speed over OpenCV's on one thread; "
        "max diff: of pixel values between the two"
    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("videos", nargs="+", type=Path)
    parser.add_argument("--repeats", type=int, default=5)
    arguments = parser.parse_args()
    main(arguments.videos, arguments.repeats)
