"""A lens whose file says how to undo its distortion, as coefficients that distort."""

from collections.abc import Callable, Sequence

from numpy.typing import NDArray

from courtside.geometry import camera_fields, lens_fit
from courtside.study.errors import InputError

# ASSUME: below the noise of keypoints; lenses of Vicon are some 0.03 px off, of OptiTrack 0.1 px.
MOST_OFF_PX = 0.25


def coefficients(
    where: str,
    size: Sequence[float] | NDArray,
    matrix: NDArray,
    undistort: Callable[[NDArray], NDArray],
) -> NDArray:
    """Return OpenCV's k1 k2 p1 p2 k3 (5,) of a lens that is stated as its inverse.

    `undistort` maps px (N, 2) of the picture of `size` px to directions (N, 2) on the z = 1 plane;
    `matrix` (3, 3) px. The coefficients are fitted by least squares over the whole picture. Raises
    `InputError` that begins with `where` if they miss the lens by more than 0.25 px anywhere.
    """
    xy = lens_fit.grid(camera_fields.numbers(where, "size", size, (2,)))
    found = lens_fit.fit(xy, undistort(xy), matrix)
    if found is None:
        raise InputError(f"{where}: expected a lens, found one without limits; export it again")
    dist, off_px = found
    if not off_px <= MOST_OFF_PX:
        raise InputError(
            f"{where}: expected a lens that five coefficients of OpenCV follow to {MOST_OFF_PX:g} "
            f"px, found {off_px:.3g} px; calibrate with another program, or give undistorted videos"
        )
    return dist
