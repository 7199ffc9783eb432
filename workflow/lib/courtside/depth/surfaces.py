"""Surfaces that a depth camera sees at the 2D joints of one frame, nearest first."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import camera, depth_registration, rotations
from courtside.geometry.camera import Camera

# ASSUME: this block has no source but the development takes (CONTRIBUTING.md).
N_SURFACES = 3  # of a joint: the limb, one in front, one behind
COARSE_PX = 6.0  # half a window while the size of the body in the picture is unknown
REACH_M = (0.5, 12.0)  # distances that a cut-out of the depth picture must hold: a gymnasium
GROWTHS = (1.0, 1.5, 2.0)  # relative sizes of windows, if the first lies in a hole
ROUNDS = 3  # of the robust plane
LEAST_WINDOW_PX = 2.0  # depth pixels: half a window


class DepthRig(Protocol):
    """A depth camera beside a colour camera, such as `devices.depth_recording.DepthRecording`."""

    @property
    def colour(self) -> Camera: ...  # noqa: D102
    @property
    def depth(self) -> Camera: ...  # noqa: D102
    @property
    def colour_from_depth(self) -> NDArray: ...  # noqa: D102
    @property
    def depth_unit_m(self) -> float: ...  # noqa: D102


@dataclass(frozen=True)
class Sampling:
    """Parameters of depth sampling."""

    window: float = 0.7  # half the side of the window about a joint, in radii of the limb there
    min_pixels: int = 4  # depth pixels that a surface needs
    min_share: float = 0.2  # of the window's pixels that a surface needs
    bandwidth_m: float = 0.02  # depth of one surface; twice the noise is added
    edge_m: float = 0.06  # a pixel that differs by more from a neighbour mixes two surfaces
    # Standard deviation of the disparity: the noise is `z**2 * disparity_px / (focal_px *
    # baseline_m)`. ASSUME: as makers of stereo depth cameras state for textured surfaces ("RMS
    # subpixel").
    disparity_px: float = 0.1


class Sampler:
    """Samples the frames of one recording.

    `radius_m` (J,) is that of the limb at each joint; joints with `is_trunk` (J,) tell how far the
    body is.
    """

    def __init__(
        self,
        rig: DepthRig,
        radius_m: NDArray,
        is_trunk: NDArray,
        baseline_m: float,
        sampling: Sampling,
    ) -> None:
        self.rig, self.sampling = rig, sampling
        self.radius_m, self.is_trunk = np.asarray(radius_m), np.asarray(is_trunk)
        self.rays = depth_registration.rays(rig.depth)
        self.noise_per_m2 = sampling.disparity_px / (rig.depth.K[0, 0] * baseline_m)
        self.pixel = rig.colour.K[0, 0] / rig.depth.K[0, 0]  # colour px to one depth px

    def sigma_z(self, z: NDArray | float) -> NDArray:
        """Return the standard deviation of one pixel's depth at a depth along the axis, metres."""
        return self.noise_per_m2 * z**2

    def surfaces(self, xy: NDArray, depth: NDArray) -> tuple[NDArray, float]:
        """Find the surfaces at the joints of one frame.

        Joints `xy` (J, 2) are px of the colour picture, NaN where missing; `depth` (h, w) uint16 is
        in steps of the recording. Return the depths (J, 3) along the colour camera's axis, metres,
        nearest first, NaN beyond those found; and that of the trunk, NaN if there is no depth at
        any joint.
        """
        found = np.full((len(xy), N_SURFACES), np.nan)
        part = self._cut_out(xy)
        if part is None:
            return found, np.nan
        depth_m = depth[part] * self.rig.depth_unit_m
        places, z = depth_registration.points_in_colour(
            depth_m, self.rays[part], self.rig.colour, self.rig.colour_from_depth
        )
        keep = np.isfinite(z) & np.isfinite(places[..., 0]) & ~self._edges(depth_m, z)
        x, y, z = places[keep, 0], places[keep, 1], z[keep]
        z_body = self._body(xy, x, y, z)
        if np.isnan(z_body):
            return found, z_body
        half_px = self.sampling.window * self.radius_m * self.rig.colour.K[0, 0] / z_body
        half_px = np.maximum(half_px, LEAST_WINDOW_PX * self.pixel)
        for joint in np.flatnonzero(np.isfinite(xy).all(axis=-1)):
            found[joint] = self._at(xy[joint], half_px[joint], self.radius_m[joint], (x, y, z))
        return found, z_body

    def _cut_out(self, xy: NDArray) -> tuple[slice, slice] | None:
        """Return the part of the depth picture that holds the joints."""
        known = xy[np.isfinite(xy).all(axis=-1)]
        if not len(known):
            return None
        margin = 0.1 * np.ptp(known, axis=0).max() + 4 * COARSE_PX
        low, high = known.min(axis=0) - margin, known.max(axis=0) + margin
        low, high = (np.clip(c, 0, np.subtract(self.rig.colour.size, 1)) for c in (low, high))
        corners = np.array([[x, y] for x in (low[0], high[0]) for y in (low[1], high[1])])
        ahead = np.column_stack([camera.undistort(self.rig.colour, corners), np.ones(4)])
        xyz = np.concatenate([ahead * distance for distance in REACH_M])
        back = rotations.invert(np.asarray(self.rig.colour_from_depth))
        seen = camera.project(self.rig.depth, xyz @ back[:, :3].T + back[:, 3])
        if not np.isfinite(seen).any():
            return None
        first = np.maximum(np.floor(np.nanmin(seen, axis=0)).astype(int) - 2, 0)
        last = np.maximum(np.ceil(np.nanmax(seen, axis=0)).astype(int) + 3, 0)
        return slice(first[1], last[1]), slice(first[0], last[0])

    def _edges(self, depth_m: NDArray, z: NDArray) -> NDArray:
        """Return which pixels mix two surfaces: they differ from a neighbour that has depth."""
        limit = self.sampling.edge_m + 3 * self.sigma_z(np.nan_to_num(z))
        depth_m = np.where(depth_m > 0, depth_m, np.nan)
        edge = np.zeros(depth_m.shape, dtype=bool)
        for axis in (0, 1):
            step = np.abs(np.diff(depth_m, axis=axis))
            low = tuple(slice(None, -1) if k == axis else slice(None) for k in (0, 1))
            high = tuple(slice(1, None) if k == axis else slice(None) for k in (0, 1))
            edge[low] |= step > limit[low]
            edge[high] |= step > limit[high]
        return edge

    def _body(self, xy, x, y, z) -> float:
        wanted = np.isfinite(xy).all(axis=-1)
        if (wanted & self.is_trunk).any():
            wanted &= self.is_trunk
        near = [
            z[(np.abs(x - u) <= COARSE_PX) & (np.abs(y - v) <= COARSE_PX)] for u, v in xy[wanted]
        ]
        medians = [np.median(values) for values in near if len(values)]
        return float(np.median(medians)) if medians else np.nan

    def _at(self, centre, half_px, radius_m, pixels) -> NDArray:
        """Return the surfaces (3,) at one joint."""
        found = np.full(N_SURFACES, np.nan)
        x, y, z = pixels
        for growth in GROWTHS:
            reach = growth * half_px
            inside = (np.abs(x - centre[0]) <= reach) & (np.abs(y - centre[1]) <= reach)
            if np.count_nonzero(inside) >= self.sampling.min_pixels:
                break
        else:
            return found
        x, y, z = x[inside] - centre[0], y[inside] - centre[1], z[inside]
        modes = modes_of(z, self._width(np.median(z)), self.sampling)
        for k, mode in enumerate(modes):
            near = np.abs(z - mode) <= radius_m + self._width(mode)
            found[k] = plane_at_origin(x[near], y[near], z[near], mode, self._width(mode))
        return found

    def _width(self, z: NDArray | float) -> NDArray:
        return self.sampling.bandwidth_m + 2 * self.sigma_z(z)


def modes_of(z: NDArray, width_m: float | NDArray, sampling: Sampling) -> list[float]:
    """Return the depths that most pixels share, nearest first, of depths `z` (N,) in metres.

    Pixels within `width_m` count together. At most three, more than twice the width apart.
    """
    z = np.sort(z)
    count = np.searchsorted(z, z + width_m, side="right") - np.searchsorted(z, z - width_m)
    least = max(sampling.min_pixels, sampling.min_share * len(z))
    modes: list[float] = []
    while len(modes) < N_SURFACES and len(z) and count.max() >= least:
        best = count == count.max()
        best &= np.abs(z - z[count.argmax()]) <= 2 * width_m  # of one surface, where two tie
        modes.append(float(np.median(z[best])))
        apart = np.abs(z - modes[-1]) > 2 * width_m
        z, count = z[apart], count[apart]
    return sorted(modes)


def plane_at_origin(
    x: NDArray, y: NDArray, z: NDArray, mode: float, width_m: float | NDArray
) -> float:
    """Return the depth at (0, 0) of the plane through a limb's pixels, robust to other surfaces.

    Pixels are at `x`, `y` (N,) px from the joint with depths `z` (N,) m; `mode` is the start depth
    and `width_m` the scale of the surface's depths. The result is within the range of the pixels
    that count. Iterated weighted least squares (Tukey's biweight), so that a slanting limb is not
    read at its nearest end.
    """
    level = np.full(len(z), mode)
    basis = np.column_stack([np.ones(len(z)), x, y])
    for _ in range(ROUNDS):
        weight = np.clip(1 - ((z - level) / (3 * width_m)) ** 2, 0, None) ** 2
        # A weak prior against slopes: a few pixels in a row determine none across it.
        normal = basis.T @ (basis * weight[:, np.newaxis]) + np.diag([0, 1e-3, 1e-3]) * len(z)
        if not weight.sum() > 0 or np.linalg.cond(normal) > 1e12:
            return mode
        plane = np.linalg.solve(normal, basis.T @ (weight * z))
        level = basis @ plane
    counted = z[weight > 0]
    return float(np.clip(plane[0], counted.min(), counted.max()))
