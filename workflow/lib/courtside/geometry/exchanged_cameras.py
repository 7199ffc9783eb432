"""Camera files under each other's names: the clicks of two fixed cameras fit where the other one stands."""

from itertools import combinations

import numpy as np

from courtside.geometry import alignment
from courtside.study.errors import InputError

OFF = 0.01  # of the court's length: points nearer than that fit
BENT = 0.1  # of the court's length: structure from motion of 12 small pictures was bent by up to half of that
NEARER = 5.0  # so many times nearer must they be with the clicks of two cameras exchanged


def refuse(court, cameras, clicks, adjust=None):
    """Raise where the clicks fit the court only after those of two cameras are exchanged.

    Parameters
    ----------
    court : courtside.geometry.courts.Court
    cameras : list of Camera
        Fixed cameras in one frame, of structure from motion: clicks must not have shaped it.
    clicks : dict of str to (P, 2) float
        By camera name, px; NaN where not clicked.
    adjust : callable, optional
        From clicks to the fixed cameras after a joint adjustment with them. Structure from motion of few
        pictures is bent by more than clicks scatter: points that such a bend can explain are judged after it.

    Raises
    ------
    InputError
        If so: the files of these cameras may be exchanged. Any other fault of the clicks is not looked for.
    """
    near_m = OFF * np.max(court.size_m)
    if _off_m(court, cameras, clicks) < near_m:
        return
    off_m = _off_m(court, cameras, clicks, adjust)
    if off_m < near_m:
        return
    for one, other in combinations([camera.name for camera in cameras], 2):
        exchanged = {**clicks, one: clicks[other], other: clicks[one]}
        better_m = _off_m(court, cameras, exchanged, adjust)
        if better_m < min(near_m, off_m / NEARER):
            found = f"{100 * off_m:.0f} cm off" if np.isfinite(off_m) else "impossible"
            raise InputError(
                f"cameras {one} and {other}: expected clicked court points to fit the walk, found them "
                f"{found}, but {100 * better_m:.0f} cm off with the clicks of the two exchanged: the camera "
                "files may be exchanged; correct their names in the session, or in the court points"
            )


def _off_m(court, cameras, clicks, adjust=None):
    """Return how far most reconstructed points are from the court, inf where they cannot be aligned."""
    try:
        off_m = _misfit_m(court, cameras, clicks)
        if adjust and off_m <= BENT * np.max(court.size_m):
            off_m = _misfit_m(court, adjust(clicks), clicks)
    except InputError:
        return np.inf
    return off_m


def _misfit_m(court, cameras, clicks):
    xyz = alignment.reconstruct(cameras, clicks)
    world_from_sfm, _ = alignment.align(court, xyz)
    return alignment.misfit_m(court, world_from_sfm, xyz)
