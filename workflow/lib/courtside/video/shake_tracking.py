"""Movement of a fixed camera's picture in every frame of a take, relative to its static picture."""

from collections.abc import Iterable

import cv2
import numpy as np
import pandas as pd
from numpy.typing import NDArray

from courtside.video import camera_movement
from courtside.video.camera_movement import LENS_MEAN, Movement

# ASSUME: the values up to SMALLER and SPARSE have no source but the development sessions.
WIDEST_PX = 2048  # larger pictures are reduced: a camera's movement needs no more
N_CORNERS = 300
APART = 0.02  # least distance of corners, picture widths
SURROUNDINGS = 0.012  # picture widths: the mean over this is removed, against changes of light
LEVELS, STOP = 4, (20, 0.01)  # of `camera_movement.flow`
SMALLER = 4  # reduction of the pictures that find a large movement
# Errors outside the fit (video coding, lens, interpolation): on virtual pictures with known
# rotations, errors were 0.02 to 0.05 px where the corners' scatter alone predicted 0.005 to 0.015.
FLOOR_PX, FLOOR_SHARE = 0.03, 0.002  # the second is a share of the shift
SPARSE = 32  # frames: the longest pause between two searches for a lost picture
NAMES = ("shift_x_px", "shift_y_px", "rotation_deg", "zoom_percent", "n_matches", "sigma_px")


class Tracker:
    """Track the background of a fixed camera, given its static picture (H, W, 3) uint8, BGR.

    The static picture should be as free of people as possible.

    Corners of the static picture are tracked in each frame (Lucas & Kanade 1981, pyramidal),
    starting from the last frame's places but always against the static picture, so that no error
    accumulates. The rotation of a camera moves its picture's edges more than its centre, by an
    amount that depends on the lens: two numbers describe it, estimated in each frame beside shift,
    rotation and zoom, with usual lenses as prior. People are outliers: RANSAC starts the fit,
    Tukey's weights refine it.
    """

    def __init__(self, static: NDArray) -> None:
        height, width = static.shape[:2]
        self.size = width, height
        self.shrink = -(-width // WIDEST_PX)
        grey = self._even(static)
        corners = cv2.goodFeaturesToTrack(grey, N_CORNERS, 0.01, APART * grey.shape[1])
        self._corners = np.empty((0, 2)) if corners is None else corners[:, 0].astype(float)
        self._grey = grey
        self._half = max(grey.shape) / 2
        self._places = (self._corners - (np.array(grey.shape[::-1]) - 1) / 2) / self._half
        self._static, self._last = static, np.r_[np.zeros(4), LENS_MEAN]
        self._lost, self._next_search = 0, 0

    def measure(self, frame: NDArray) -> Movement:
        """Measure the place of the static picture in the next frame (H, W, 3) uint8, BGR.

        Raise ValueError if it differs in size from the static picture.
        """
        if frame.shape != self._static.shape:
            raise ValueError(f"pictures of two sizes: {self._static.shape} and {frame.shape}")
        grey = self._even(frame)
        found = self._follow(grey, self._last)
        if not found.known:
            found = self._search(grey, frame)
        if not found.known:
            return camera_movement.unknown(found.n_matches)
        self._lost = self._next_search = 0
        self._last = model = found.model
        linear, unit_px = complex(1 + model[2], model[3]), self._half * self.shrink
        shift_px = model[:2] * unit_px
        floor_px = np.hypot(FLOOR_PX, FLOOR_SHARE * np.hypot(*shift_px))
        return Movement(
            shift_px=shift_px,
            zoom=abs(linear),
            rotation_deg=float(np.degrees(np.angle(linear))),
            n_matches=found.n_matches,
            sigma_px=float(np.hypot(found.sigma * unit_px, floor_px)),
        )

    def _search(self, grey: NDArray, frame: NDArray) -> camera_movement.Fit:
        """Find a lost picture from rest, by correlation, or by features (slow, so not always)."""
        for shift_px in (np.zeros(2), self._correlate(grey)):
            found = self._follow(grey, np.r_[shift_px / self._half, 0, 0, LENS_MEAN])
            if found.known:
                return found
        self._lost += 1
        if self._lost <= self._next_search:
            return found
        self._next_search = self._lost + min(self._lost, SPARSE)
        rough = camera_movement.movement(self._static, frame)
        if not rough.known:
            return found
        linear = rough.zoom * np.exp(1j * np.radians(rough.rotation_deg))
        shift = rough.shift_px / self.shrink / self._half
        return self._follow(grey, np.r_[shift, linear.real - 1, linear.imag, LENS_MEAN])

    def _correlate(self, grey: NDArray) -> NDArray:
        """Return the shift (2,) px, of any size, that correlates best."""
        size = tuple(length // SMALLER for length in grey.shape[::-1])
        static, frame = (
            cv2.resize(image, size, interpolation=cv2.INTER_AREA).astype(np.float32)
            for image in (self._grey, grey)
        )
        window = cv2.createHanningWindow(size, cv2.CV_32F)
        return SMALLER * np.array(cv2.phaseCorrelate(static, frame, window)[0])

    def _follow(self, grey: NDArray, start: NDArray) -> camera_movement.Fit:
        """Track the corners from a predicted movement."""
        guess = self._corners + self._half * camera_movement.moved(self._places, start)
        inside = ((guess >= 0) & (guess <= np.array(grey.shape[::-1]) - 1)).all(axis=1)
        if inside.sum() < camera_movement.MIN_MATCHES:
            return camera_movement.unknown_turn()
        places, corners = self._places[inside], self._corners[inside].astype(np.float32)
        guess = guess[inside].astype(np.float32)
        moved, good = camera_movement.flow(
            self._grey, grey, corners, guess, levels=LEVELS, stop=STOP
        )
        return camera_movement.fit_turn(
            places[good], (moved - corners)[good], grey.shape, inside.sum()
        )

    def _even(self, image: NDArray) -> NDArray:
        """Return grey values, reduced, minus their local mean."""
        grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
        if self.shrink > 1:
            size = tuple(length // self.shrink for length in self.size)
            grey = cv2.resize(grey, size, interpolation=cv2.INTER_AREA)
        side = 2 * round(SURROUNDINGS * grey.shape[1] / 2) + 1
        grey = cv2.GaussianBlur(grey, (3, 3), 0)
        return cv2.addWeighted(grey, 1.0, cv2.blur(grey, (side, side)), -1.0, 128.0)


def measure_take(
    static: NDArray, frames: Iterable[tuple[float, NDArray]], first: int = 0
) -> pd.DataFrame:
    """Return the `records.cameras.shake_table` of a fixed camera over a take.

    Its static picture is (H, W, 3) uint8, BGR; `frames` are the take's times and pictures in order,
    such as from `reader.frames`, the first of which has the index `first` in the file.
    """
    tracker, rows = Tracker(static), []
    for frame_idx, (time_s, image) in enumerate(frames, start=first):
        found = tracker.measure(image)
        values = *found.shift_px, found.rotation_deg, 100 * (found.zoom - 1)
        rows.append((frame_idx, time_s, *values, found.n_matches, found.sigma_px))
    return pd.DataFrame(rows, columns=["frame_idx", "time_s", *NAMES])
