"""Clicks that fit no camera: what is probably wrong with them, found by trying what would fit."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from courtside.calibration.court import place_checks, resection
from courtside.study.errors import InputError

COPIES = (1.5, 2.0, 3.0, 4.0)  # ASSUME: how many times smaller copies of pictures usually are


@dataclass(frozen=True, eq=False)
class _Change:
    """Places and clicks after a usual mistake is undone."""

    what: str
    mend: Callable[[float], str]  # from `place_checks.up` of the camera that they fit then
    xyz: NDArray
    xy: NDArray
    upright: bool = False  # whether the camera must be upright then

    def fit(self, size: tuple[int, int], options: dict[str, Any]) -> tuple[float, str]:
        """Return by how many px they fit a camera, inf where they do not, and what to do then."""
        try:
            found = resection.nonlinear(self.xyz, self.xy, size, **options)
        except InputError:
            return np.inf, ""
        below = found.camera.centre_in_world[2] < self.xyz[found.accepted, 2].min()
        up = place_checks.up(found.camera)
        if below or (self.upright and up < place_checks.UPRIGHT):
            return np.inf, ""
        fit_px = float(np.nan_to_num(found.rms_px, nan=np.inf))
        return fit_px, f"{self.what}, they fit by {fit_px:.1f} px{self.mend(up)}"


def fitted(
    xyz: NDArray, xy: ArrayLike, size: tuple[int, int], *, placed: bool = False, **options: Any
) -> resection.Fitted:
    """Fit a camera by `resection.nonlinear`; if this fails, the error says which change would fit.

    `placed` says whether the points have places of their own.
    """
    try:
        return resection.nonlinear(xyz, xy, size, **options)
    except InputError as fault:
        changes = _changes(xyz, np.asarray(xy, float), size, placed)
        fits = [change.fit(size, options) for change in changes]
        fit_px, mend = min(fits, key=lambda one: one[0])
        if np.isinf(fit_px):
            raise
        found = str(fault).partition("; ")[0]
        raise InputError(f"{found}; {mend}") from None


def _changes(xyz: NDArray, xy: NDArray, size: tuple[int, int], placed: bool) -> Iterator[_Change]:
    def turned(up: float) -> str:
        return place_checks.mirrored(up, placed)

    yield _Change("mirrored", turned, xyz * [-1, 1, 1], xy)
    # Exchanged axes are a mirror image, too, of a picture that lies on its side.
    what, flipped = "with x_px and y_px exchanged", xy[:, ::-1]
    yield _Change(what, _always(place_checks.RENAME), xyz, flipped, upright=True)
    for times in COPIES:
        if (np.nanmax(xy, axis=0) * times < size).all():
            mend = (
                f"they are of a smaller copy of the picture, which has {size[0]} x {size[1]} px; "
                f"multiply x_px and y_px by {times:g}"
            )
            yield _Change(f"times {times:g}", _always(mend), xyz, xy * times)


def _always(mend: str) -> Callable[[float], str]:
    return lambda up: f": {mend}"
