"""The painted lines of a court measured in a picture, stretch by stretch."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.calibration.click_proposals import line_profiles, proposals
from courtside.calibration.click_proposals.view import View
from courtside.calibration.court import line_edges
from courtside.calibration.court.court import Court
from courtside.geometry.camera import Camera, project

# ASSUME: both tuned on development sessions.
STRETCH_M = 0.8  # of line that is measured at once
REACH_PX = 2.5  # of the search across a line, once the camera is moved


@dataclass(frozen=True, eq=False)
class Edges:
    """M stretches of painted lines in one picture, measured only across the line."""

    line: NDArray  # (M,) int: row of the court's `lines_m`
    xyz: NDArray  # (M, 3): the stretch's middle by the court's file, m
    across: NDArray  # (M, 3): unit, on the floor, towards the edge of the higher coordinate
    xy: NDArray  # (M, 2): where the line is seen, px; along the line it says nothing
    normal: NDArray  # (M, 2): unit, across the line in the picture
    sigma_px: NDArray  # (M,): across, of the fit of its profile alone


def measure(
    camera: Camera, image: NDArray, court: Court, *, search_px: float, lines: str = "light"
) -> tuple[Edges | None, str]:
    """Measure a court's lines in the picture (H, W, 3) uint8 of a camera known roughly.

    As in `click_proposals.proposals.propose`, lines may be up to `search_px` from their predicted
    positions. The camera is adjusted to them, and its new predictions are used for a second search.
    If too few lines are found, the reason is returned in place of edges.
    """
    view = View.of(image, camera, court, lines)
    moved = proposals.register(view, search_px)
    if moved.reason:
        return None, moved.reason
    view = moved.view
    rows = []
    for line, ends in zip(*line_edges.stretches(court, STRETCH_M), strict=True):
        middle, half = ends.mean(axis=0), line_edges.middle_line(court, line)[1]
        shift = view.shift(line, ends, middle, REACH_PX)
        if shift is None or not proposals.is_reliable(shift):
            continue
        along = ends[1] - ends[0]
        _, (normal,) = line_profiles.tangent_and_normal(view.camera, middle[None], along, half)
        xy = project(view.camera, middle) + (shift.low_px + shift.high_px) / 2 * normal
        rows.append((line, middle, half / np.linalg.norm(half), xy, normal, shift.sigma_px))
    if not rows:
        return None, "no painted line is seen where it is expected"
    return Edges(*(np.array(column) for column in zip(*rows, strict=True))), ""
