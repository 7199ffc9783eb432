"""Join the chapters into which a GoPro, a camcorder or an action camera cuts up a recording.

Example: `python workflow/join_chapters.py GX010034.MP4 GX020034.MP4 --output data/north/left.mp4`.

Packets are copied, with the sound; nothing is encoded again. Each chapter begins one frame after
the last frame of the one before.
"""

import argparse
import itertools
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(REPOSITORY / "workflow" / "lib"))

from courtside.study import installed

installed.require()

from courtside.drafting import device_names
from courtside.study.errors import InputError
from courtside.video import chapters


def main(paths, joined):
    """Join chapters and return the lines to print."""
    if len(paths) < 2:
        raise InputError(f"{paths[0]}: expected two chapters or more, found one; name them all")
    for before, path in itertools.pairwise(paths):
        check_order(before, path)
    begun_s = chapters.join(paths, joined)
    lines = [f"{begin:12.3f} s {path}" for begin, path in zip(begun_s, paths, strict=True)]
    return [f"Wrote {joined}. Its chapters begin at", *lines]


def check_order(before, path):
    """Refuse files of which the names say that the second does not follow the first."""
    one, other = (device_names.read(name.stem) for name in (before, path))
    if not (one and other and one.mark.startswith("g") and other.mark.startswith("g")):
        return  # only GoPros tell
    if one.mark[-4:] != other.mark[-4:] or other.chapter != one.chapter + 1:
        raise InputError(
            f"{path}: expected chapter {one.chapter + 1} of recording {one.mark[-4:]} after "
            f"{before.name}, found chapter {other.chapter} of recording {other.mark[-4:]}; "
            "correct the order"
        )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=" ".join(__doc__.split("\n\n")[:2]))
    parser.add_argument("chapters", type=Path, nargs="+", help="in their order")
    parser.add_argument("--output", type=Path, required=True, help="a new file, .mp4 or .mov")
    given = parser.parse_args()
    try:
        print("\n".join(main(given.chapters, given.output)))
    except (InputError, OSError) as error:
        sys.exit(f"Error: {error}")
