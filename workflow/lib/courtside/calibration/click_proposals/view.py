"""A picture of a court and its camera, shared by the measurements of lines and posts."""

from dataclasses import dataclass

from numpy.typing import NDArray

from courtside.calibration.click_proposals import line_profiles, line_shift
from courtside.calibration.court import line_edges
from courtside.calibration.court.court import Court
from courtside.geometry.camera import Camera


@dataclass(frozen=True, eq=False)
class View:
    """A picture and its camera, with what all measurements in it have in common."""

    grey: NDArray  # (H, W) float32
    camera: Camera
    court: Court
    blur_px: float  # of the picture, standard deviation
    polarity: int  # 1 where lines are lighter than the floor, -1 where darker

    def shift(
        self, line: int, ends_m: NDArray, origin_m: NDArray, reach_px: float
    ) -> line_shift.Shift | None:
        """Return how far a stretch of a painted line is off, None where it is not seen.

        Parameters
        ----------
        line : row of the court's `lines_m`
        ends_m : (2, 3) float; of the stretch, on the line's middle
        origin_m : (3,) float; on the same straight line: where the shift is wanted
        reach_px : how far off the line may be
        """
        _, half = line_edges.middle_line(self.court, line)
        paint = line_edges.paint(self.camera, self.court)
        seen = line_profiles.sample_stretch(
            self.grey, self.camera, ends_m, origin_m, half, paint, reach_px, self.blur_px
        )
        if seen is None:
            return None
        return line_shift.shift(seen, polarity=self.polarity, blur_px=self.blur_px)


@dataclass(frozen=True, eq=False)
class Ray:
    """A straight edge or axis as it was seen in the picture."""

    start: NDArray  # (2,): on it, px, where it is needed
    direction: NDArray  # (2,): unit length
    sigma_px: float  # standard deviation across it at `start`
    share: float  # of what was expected near `start` that is seen, 0..1
