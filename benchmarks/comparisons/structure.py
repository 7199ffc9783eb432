"""Structure from motion of two fixed cameras and a walk, by number of bridging images.

The walk goes between the cameras.
"""

import itertools

import machine
import rows
import structure_from_motion

NAME = "structure from motion"
LIMIT = (
    "additions and multiplications of comparing all descriptors of matched pairs, over the core's"
)
BOUNDS = (
    "features, the same for both and growing with images; then matching, which grows with pairs: "
    "this project's list of near frames grows with images, COLMAP's default with their square"
)
SESSION = "plain-a"
DESCRIPTOR = 128
AFTER = structure_from_motion.STEPS[1:]


def compare(given):
    """Return the rows of this project and COLMAP's defaults, in all and after features."""
    if not (given.results / SESSION / "frames" / "walk.csv").is_file():
        target = f"{given.results}/{SESSION}/sfm/features.db"
        raise SystemExit(f"expected frames of {SESSION}: run `snakemake {target}` first")
    counts = given.images[:1] if given.quick else given.images
    found = []
    for count in counts:
        sides = structure_from_motion.compare(given.results, SESSION, count)
        for (name, steps), (side, row) in itertools.product(
            ((NAME, structure_from_motion.STEPS), (f"{NAME}, after features", AFTER)), sides.items()
        ):
            method = rows.OURS if side == "courtside" else "colmap's defaults"
            found.append(
                rows.Row(name, method, side == "courtside", "image", count, count / counts[0],
                         structure_from_motion.total(row, steps), least_s(row),
                         error_median=row["adjusted_cm"],
                         error_ours_p95=sides["courtside"]["adjusted_cm"],
                         error_unit="cm over the volume")
            )  # fmt: skip
    return found


def least_s(row):
    """Return the least time of comparing the descriptors of one side, s."""
    return 2 * DESCRIPTOR * row["compared"] / machine.measured().flops_32
