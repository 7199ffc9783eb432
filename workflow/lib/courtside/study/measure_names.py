"""The names of measures in the table of a study, known before any is measured."""

import re
from collections.abc import Iterable, Iterator

from courtside.study.errors import nearest

POINTS = ("neck", "centre", "mass")
DISTANCES = (
    *("distance", "distance_measured", "distance_in_gaps"),
    *("distance_noise_bias", "distance_noise_bias_most", "speed_mean"),
)
OF_POINT = (
    *DISTANCES,
    *(f"ground_{name}" for name in DISTANCES),
    *("speed_max", "acceleration_max", "noise_memory", "noise_white_share", "noise_scale"),
)
LIMBS = ("knee_flexion", "elbow_flexion", "hip_flexion", "shoulder_elevation")
ANGLES = (
    *(f"{side}_{limb}" for side in ("left", "right") for limb in LIMBS),
    *("trunk_lean", "trunk_lean_forward"),
)
FEET = (
    *("steps", "lunges", "split_steps", "jumps", "flight_time"),
    *(f"{what}_time{foot}" for what in ("stance", "swing") for foot in ("", "_left", "_right")),
    *(f"steps_{depth}_{side}" for depth in ("front", "mid", "rear") for side in ("left", "right")),
)
OF_RALLY = ("time", "unseen", "distance", "step_rate")
RALLY = re.compile(rf"rally_[1-9][0-9]*_({'|'.join(OF_RALLY)})")
NAMES = (
    *(f"{point}_{name}" for point in POINTS for name in OF_POINT),
    *(f"{angle}_{end}" for angle in ANGLES for end in ("max", "min")),
    *FEET,
    *(f"rally_1_{name}" for name in OF_RALLY),
)


def unknown(where: str, names: Iterable[str]) -> Iterator[str]:
    """Yield a fault for each name of no measure; rallies of any number are known."""
    for name in names:
        if name not in NAMES and not RALLY.fullmatch(name):
            yield (
                f"{where}: expected measures of study.csv, such as {NAMES[0]}, found {name!r}; "
                f"{nearest(name, NAMES, 'correct the name, or remove it')}"
            )
