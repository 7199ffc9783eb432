"""A picture of a court and its camera, shared by the measurements of lines and posts."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.click_proposals import line_profiles, line_shift
from courtside.calibration.court import line_edges
from courtside.calibration.court.court import Court
from courtside.geometry.camera import Camera, project

BLUR = 0.75, 1920  # ASSUME: px of blur, per px of the longer side beyond this
NO_PLACE = np.full(2, np.nan), np.full((2, 2), np.nan), 0.0  # px, covariance, share that is seen


@dataclass(frozen=True, eq=False)
class View:
    """A picture and its camera, with data shared by all measurements in the picture."""

    grey: NDArray  # (H, W) float32
    camera: Camera
    court: Court
    blur_px: float  # of the picture, standard deviation
    polarity: int  # 1 where lines are lighter than the floor, -1 where darker, 0: either

    @classmethod
    def of(cls, image: NDArray, camera: Camera, court: Court, lines: str) -> "View":
        """Return the view of a picture (H, W, 3) uint8; `lines` are "light", "dark" or "any"."""
        blur_px = BLUR[0] * max(1.0, max(camera.size) / BLUR[1])
        polarity = {"light": 1, "dark": -1, "any": 0}[lines]
        return cls(image.mean(axis=2).astype(np.float32), camera, court, blur_px, polarity)

    def shift(
        self, line: int, ends_m: NDArray, origin_m: NDArray, reach_px: float
    ) -> line_shift.Shift | None:
        """Return the shift of a stretch of a row of the court's `lines_m`; see `measure`."""
        _, half = line_edges.middle_line(self.court, line)
        paint = line_edges.paint(self.camera, self.court)
        return self.measure(paint, ends_m, origin_m, half, reach_px, self.polarity)

    def measure(
        self,
        paint: line_edges.Paint,
        ends_m: NDArray,
        origin_m: NDArray,
        half_width_m: NDArray,
        reach_px: float,
        polarity: int,
    ) -> line_shift.Shift | None:
        """Return the shift of a stretch of an expected line, None if it is not seen.

        The ends (2, 3) are on the line's middle. The shift is measured at the origin (3,), on the
        same straight line, and is at most `reach_px`.
        """
        seen = line_profiles.sample_stretch(
            self.grey, self.camera, ends_m, origin_m, half_width_m, paint, reach_px, self.blur_px
        )
        if seen is None:
            return None
        return line_shift.shift(seen, polarity=polarity, blur_px=self.blur_px)

    def ray(
        self,
        origin_m: NDArray,
        place_m: NDArray,
        along_m: NDArray,
        across_m: NDArray,
        moved_px: float,
        slope: float,
    ) -> tuple[NDArray, NDArray]:
        """Return start and unit direction, (2,) px each, of a line as it was seen at a place.

        It lies `moved_px` across from where it was expected, and is turned by a `slope`.
        """
        tangent, normal = line_profiles.tangent_and_normal(
            self.camera, origin_m[None], along_m, across_m
        )
        direction = tangent[0] + slope * normal[0]
        start = project(self.camera, place_m) + moved_px * normal[0]
        return start, direction / np.linalg.norm(direction)


@dataclass(frozen=True, eq=False)
class Ray:
    """A straight edge or axis, as measured in the picture."""

    start: NDArray  # (2,): on it, px, where it is needed
    direction: NDArray  # (2,): unit length
    sigma_px: float  # standard deviation across it at `start`
    share: float  # of what was expected near `start` that is seen, 0..1
