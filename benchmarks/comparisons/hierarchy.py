"""Reading and forward kinematics of a BVH file of 27 joints with six channels each."""

import tempfile
from pathlib import Path

import numpy as np

import bvh
import machine
import rows

NAME = "bvh"
LIMIT = "bytes of the text read and of the places written, over the memory's"
BOUNDS = (
    "turning text into numbers, which takes most of the time; the products of rotations that "
    "follow are one call a joint for all frames, where bvhio walks the tree of joints in Python "
    "in every frame"
)
FRAMES = 750


def compare(given):
    """Return the rows of this project and bvhio."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        source, path = Path(folder) / "made.bvh", Path(folder) / "take.bvh"
        bvh.writer.write(source, bvh.made())
        for times in rows.TIMES[: 2 if given.quick else None]:
            n_frames = times * FRAMES
            bvh.repeat_rows(path, source, n_frames)
            measured = bvh.measure(path, given.repeats if times < 4 else 1)
            peer = measured.pop("bvhio")
            ours_s = min(spent for spent, _ in measured.values())
            places = measured["courtside"][1]
            least_s = (path.stat().st_size + places.nbytes) / machine.measured().bytes_s
            away = 1000 * np.linalg.norm(places - peer[1], axis=-1)
            work = "frame", n_frames, times
            apart = {"error_median": np.median(away), "error_p95": np.percentile(away, 95)}
            apart["error_unit"] = "mm from bvhio's"
            found.append(rows.Row(NAME, rows.OURS, True, *work, ours_s, least_s, **apart))
            found.append(rows.Row(NAME, "bvhio", False, *work, peer[0], least_s))
    return found
