"""Decoding a video into upright BGR pictures, one thread."""

import os
import subprocess
from itertools import islice

import numpy as np

import decode_video
import machine
import peers
import rows

NAME = "decoding"
LIMIT = "bytes of the pictures written once, over the memory's"
BOUNDS = (
    "the H.264 decoder itself, which all of them share, and turning YUV into BGR; this project "
    "checks the whole file's packets first, so that one cut short is found before anything is "
    "computed from it"
)
SHARES = {1: 1 / 8, 2: 1 / 4, 4: 1 / 2, 8: 1.0}  # of the video
METHODS = {
    rows.OURS: decode_video.READERS["courtside"],
    "opencv": decode_video.READERS["cv2, 1 thread"],
}
COMMANDS = {
    "ffmpeg, pictures": ("-f", "rawvideo", "-pix_fmt", "bgr24"),
    "ffmpeg, decoding alone": ("-f", "null"),
}


def compare(given):
    """Return the rows of this project, OpenCV and ffmpeg."""
    first = next(decode_video.opencv(given.video, 1))
    whole = sum(1 for _ in decode_video.opencv(given.video, 1))
    program = _ffmpeg(given.environments)
    found = []
    for times, share in list(SHARES.items())[: 2 if given.quick else None]:
        count = max(1, round(whole * share))
        least_s = count * first.nbytes / machine.measured().bytes_s
        spent = {name: _read_s(read, given, count) for name, read in METHODS.items()}
        for name, form in COMMANDS.items():
            command = [
                program,
                "-v",
                "error",
                "-threads",
                "1",
                "-i",
                given.video,
                "-frames:v",
                count,
            ]
            command += ["-threads", "1", *form, "-y", os.devnull]
            spent[name] = min(_program_s(command) for _ in range(given.repeats))
        found += [
            rows.Row(NAME, name, name == rows.OURS, "frame", count, times, cpu_s, least_s)
            for name, cpu_s in spent.items()
        ]
    return found


def _read_s(read, given, count):
    def all_frames():
        for _image in islice(read(given.video), count):
            pass

    return machine.least(all_frames, given.repeats)[0]


def _ffmpeg(environments):
    python = peers.interpreter("ffmpeg", environments)
    command = [python, "-c", "import imageio_ffmpeg as f; print(f.get_ffmpeg_exe())"]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


def _program_s(command):
    """Return the processor time of a program and of those that it starts, s."""
    with subprocess.Popen([str(part) for part in command]) as running:
        _, status, usage = os.wait4(running.pid, 0)
        running.returncode = os.waitstatus_to_exitcode(status)
    if running.returncode:
        raise SystemExit(f"{command[0]}: expected to decode the video, found the error above")
    return float(np.sum([usage.ru_utime, usage.ru_stime]))
