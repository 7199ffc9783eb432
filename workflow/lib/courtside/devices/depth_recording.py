"""A recording of a colour and depth camera, independent of its file format."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import camera_fields
from courtside.geometry.camera import Camera
from courtside.records.cameras.frame_times import FrameTimes

DEFAULT_UNIT_M = 0.001  # one step of a D400's depth unless its option says otherwise
STANDING_STILL = np.eye(3, 4)  # pose of both cameras
APART_M = 1.0  # ASSUME: of the cameras of one device
Frames = Callable[[], Iterator[tuple[float, NDArray]]]


@dataclass(frozen=True, eq=False)
class DepthRecording:
    """Colour and depth of one device, on its own clock.

    Cameras have x right, y down, z forward; the `cam_from_world` of each is the identity. Raise
    ValueError if `colour_from_depth` or `depth_unit_m` is impossible.
    """

    name: str  # of the device in the study
    colour: Camera
    depth: Camera
    # (3, 4): from the depth camera's axes to the colour camera's, metres
    colour_from_depth: NDArray
    depth_unit_m: float  # metres of one step of the depth pictures; 0 in them is a hole
    colour_frames: Frames  # a new iterator of (time_s, (H, W, 3) uint8 BGR), in order of time
    depth_frames: Frames  # a new iterator of (time_s, (h, w) uint16), in order of time
    colour_index: Callable[[], FrameTimes]  # of the colour frames, without decoding a picture
    baseline_m: float = math.nan  # between the imagers of depth; NaN where nothing says it
    remarks: tuple[str, ...] = ()  # what was assumed where the recording says nothing, a line each

    def __post_init__(self) -> None:
        moved = np.array(self.colour_from_depth, dtype=float)
        if moved.shape != (3, 4) or not np.isfinite(moved).all():
            raise ValueError(
                "expected colour_from_depth as (3, 4) finite numbers, found "
                f"{camera_fields.short(moved)}"
            )
        rotation = moved[:, :3]
        if np.abs(rotation @ rotation.T - np.eye(3)).max() > 1e-4 or np.linalg.det(rotation) < 0:
            raise ValueError("expected colour_from_depth with a right-handed rotation, found none")
        apart_m = float(np.linalg.norm(moved[:, 3]))
        if apart_m > APART_M:
            raise ValueError(
                f"expected cameras of colour and depth at most {APART_M:g} m apart, found "
                f"{apart_m:.3g} m"
            )
        if not 1e-6 <= self.depth_unit_m <= 0.1:  # ASSUME: a micrometre to 10 cm covers any sensor
            raise ValueError(
                f"expected a depth unit of 0.000001 to 0.1 m a step, found {self.depth_unit_m}"
            )
        moved.setflags(write=False)
        object.__setattr__(self, "colour_from_depth", moved)
