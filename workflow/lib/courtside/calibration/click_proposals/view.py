"""A picture of a court with the camera that expects it, as measurements of lines and posts share them."""

from dataclasses import dataclass

import numpy as np

from courtside.calibration.click_proposals import line_profiles, line_shift
from courtside.calibration.court import line_edges
from courtside.calibration.court.court import Court
from courtside.geometry.camera import Camera


@dataclass(frozen=True, eq=False)
class View:
    """A picture, its camera and what all measurements in it have in common.

    Attributes
    ----------
    grey : (H, W) float32
    camera : Camera
    court : Court
    blur_px : float
        Of the picture, standard deviation.
    polarity : int
        1 where lines are lighter than the floor, -1 where darker.
    """

    grey: np.ndarray
    camera: Camera
    court: Court
    blur_px: float
    polarity: int

    def shift(self, line, ends_m, origin_m, reach_px):
        """Return how far a stretch of a painted line is off.

        Parameters
        ----------
        line : int
            Row of the court's `lines_m`.
        ends_m : (2, 3) float
            Of the stretch, on the line's middle.
        origin_m : (3,) float
            On the same straight line: where the shift is wanted.
        reach_px : float
            How far off the line may be.

        Returns
        -------
        shift : line_shift.Shift or None
            None where it is not seen.
        """
        _, half = line_edges.middle_line(self.court, line)
        paint = line_edges.paint(self.camera, self.court)
        seen = line_profiles.look(
            self.grey, self.camera, ends_m, origin_m, half, paint, reach_px, self.blur_px
        )
        if seen is None:
            return None
        return line_shift.shift(seen, polarity=self.polarity, blur_px=self.blur_px)


@dataclass(frozen=True, eq=False)
class Ray:
    """A straight edge or axis as it was seen in the picture.

    Attributes
    ----------
    start : (2,) float
        On it, px, where it is needed.
    direction : (2,) float
        Unit length.
    sigma_px : float
        Standard deviation across it at `start`.
    share : float
        Of what was expected near `start` that is seen, 0..1.
    """

    start: np.ndarray
    direction: np.ndarray
    sigma_px: float
    share: float
